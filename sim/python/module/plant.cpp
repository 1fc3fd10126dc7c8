// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <optional>
#include <string>

#include "loop/recorder.hpp"
#include "loop/simulation.hpp"
#include "module/bindings.hpp"
#include "module/trace_arrays.hpp"
#include "recording/recording.hpp"
#include "remote/controller_messages.hpp"
#include "remote/outside_controller.hpp"
#include "report/summary.hpp"

namespace millforce::python {

namespace {

sim::Scenario scenario_of(const std::string& path, std::optional<std::uint64_t> seed,
                          std::optional<double> cutting_force_scale, std::optional<double> friction_scale,
                          std::optional<double> current_noise_share) {
    sim::Scenario scenario = sim::read_scenario(path);
    scenario.seed = seed.value_or(scenario.seed);
    sim::PlantDeviation& deviation = scenario.deviation;
    deviation.cutting_force_scale = cutting_force_scale.value_or(deviation.cutting_force_scale);
    deviation.friction_scale = friction_scale.value_or(deviation.friction_scale);
    deviation.current_noise_share = current_noise_share.value_or(deviation.current_noise_share);
    return scenario;
}

/// The trace's columns, and the run's summary as text.
py::tuple results(const sim::RunResult& result) {
    py::dict trace;
    add_columns(trace, result.trace, sim::estimate_columns());
    add_columns(trace, result.trace, sim::simulation_columns());
    return py::make_tuple(trace, sim::summary_json({}, std::span(&result, 1)));
}

/// Ctrl-C ends a run that takes long, as it ends any Python.
bool go_on(double) {
    py::gil_scoped_acquire held;
    return PyErr_CheckSignals() == 0;
}

sim::RunResult run_to_file(const sim::Scenario& scenario, sim::OverrideSource& controller, const std::string& name,
                           const sim::SimulationSettings& settings, const std::filesystem::path& file) {
    host::RecordingWriter writer(file, scenario.machine.encoder_counts_per_rev,
                                 scenario.machine.force_sensor.is_there());
    sim::Recorder recorder(controller, [&writer](const host::RecordedStep& step) { writer.add(step); });
    sim::Simulated simulated = sim::simulate(scenario, recorder, name, settings);
    if (!simulated.interrupted) {
        writer.commit();
    }
    return std::move(simulated.result);
}

py::tuple simulate(const sim::Scenario& scenario, const std::string& controller_name, double constant_ratio,
                   const std::optional<std::filesystem::path>& recording) {
    sim::RunResult result;
    {
        py::gil_scoped_release free;
        const auto controller = sim::controller_named(controller_name, scenario.parameters, constant_ratio);
        sim::SimulationSettings settings;
        settings.progress = go_on;
        result = recording ? run_to_file(scenario, *controller, controller_name, settings, *recording)
                           : sim::simulate(scenario, *controller, controller_name, settings).result;
    }
    if (PyErr_Occurred() != nullptr) {
        throw py::error_already_set();
    }
    return results(result);
}

/// The plant, sample by sample, with a controller in Python. Messages are those of simulate --controller socket:PATH.
class Plant {
  public:
    explicit Plant(const sim::Scenario& scenario)
        : hello_(sim::hello_message(scenario)), simulation_(scenario), controller_(scenario) {
        ask();
    }

    [[nodiscard]] const std::string& hello() const { return hello_; }
    /// The message about the sample that waits for an answer; none at the end of the run.
    [[nodiscard]] const std::optional<std::string>& sample() const { return sample_; }
    void answer(const std::string& line) {
        simulation_.answer(controller_.take(line), controller_);
        ask();
    }
    [[nodiscard]] sim::RunResult result(const std::string& name) { return simulation_.result(name).result; }

  private:
    void ask() {
        sample_ = simulation_.next_sample()
                      ? std::optional(controller_.ask(simulation_.sample(), simulation_.program()))
                      : std::nullopt;
    }

    std::string hello_;
    sim::SteppedSimulation simulation_;
    sim::OutsideController controller_;
    std::optional<std::string> sample_;
};

}  // namespace

void bind_plant(py::module_& module) {
    py::class_<sim::Scenario>(module, "Scenario")
        .def(py::init(&scenario_of), py::arg("path"), py::arg("seed"), py::arg("cutting_force_scale"),
             py::arg("friction_scale"), py::arg("current_noise_share"))
        .def_readonly("parameters", &sim::Scenario::parameters);
    module.def("simulate", &simulate, py::arg("scenario"), py::arg("controller"), py::arg("constant_override"),
               py::arg("recording"));
    module.def("controller_names", &sim::controller_names);
    py::class_<Plant>(module, "Plant")
        .def(py::init<const sim::Scenario&>(), py::arg("scenario"))
        .def_property_readonly("hello", &Plant::hello)
        .def_property_readonly("sample", &Plant::sample)
        .def("answer", &Plant::answer, py::arg("line"), py::call_guard<py::gil_scoped_release>())
        .def("result", [](Plant& self, const std::string& name) { return results(self.result(name)); });
}

}  // namespace millforce::python
