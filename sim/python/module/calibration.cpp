// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "calibration/cutting_calibration.hpp"
#include "calibration/friction_calibration.hpp"
#include "calibration/spindle_calibration.hpp"
#include "calibration/standard_cut_calibration.hpp"
#include "files/input_error.hpp"
#include "module/bindings.hpp"

namespace millforce::python {

namespace {

using Files = std::vector<std::filesystem::path>;
using estimation::CutSide;
using estimation::CuttingLawForm;

/// The report of a calibration, and whether its stated bound holds.
template <typename Options>
std::pair<std::string, bool> reported(int (*calibration)(const Options&, std::ostream&), const Options& options) {
    py::gil_scoped_release free;
    std::ostringstream report;
    const bool holds = calibration(options, report) == 0;
    return {report.str(), holds};
}

template <typename Value>
Value choice(const char* name, const std::string& word, const std::vector<std::pair<const char*, Value>>& choices) {
    std::vector<std::string> words;
    for (const auto& [known, value] : choices) {
        if (word == known) {
            return value;
        }
        words.emplace_back(known);
    }
    throw host::InputError(fmt::format("{}: '{}'; expected one of {}", name, word, fmt::join(words, ", ")));
}

CutSide side_of(const std::string& word) {
    return choice<CutSide>("side", word, {{"down", CutSide::down}, {"up", CutSide::up}, {"unknown", CutSide::unknown}});
}

auto friction(const Files& data, const std::filesystem::path& output, std::optional<std::string> axis,
              std::optional<double> low_pass_hz, std::optional<double> minimum_speed_mm_s) {
    host::FrictionCalibrationOptions options;
    options.data = data;
    options.output = output;
    options.axis = choice<std::string>("axis", axis.value_or(options.axis), {{"x", "x"}, {"y", "y"}, {"z", "z"}});
    options.low_pass_hz = low_pass_hz.value_or(options.low_pass_hz);
    options.minimum_speed_mm_s = minimum_speed_mm_s.value_or(options.minimum_speed_mm_s);
    return reported(host::calibrate_friction, options);
}

auto spindle(const Files& data, const std::filesystem::path& output, std::optional<double> low_pass_hz) {
    host::SpindleCalibrationOptions options;
    options.data = data;
    options.output = output;
    options.low_pass_hz = low_pass_hz.value_or(options.low_pass_hz);
    return reported(host::calibrate_spindle, options);
}

auto standard_cut(const Files& data, const std::filesystem::path& output, const std::filesystem::path& cuts,
                  const std::filesystem::path& machine, const std::string& database, const std::string& entry,
                  const std::string& side) {
    host::StandardCutOptions options;
    options.data = data;
    options.output = output;
    options.cuts = cuts;
    options.machine = machine;
    options.database = database;
    options.entry = entry;
    options.side = side_of(side);
    return reported(host::calibrate_standard_cut, options);
}

auto cutting(const Files& data, const std::filesystem::path& output, const std::string& side,
             const std::optional<std::string>& law, const std::filesystem::path& cuts,
             const std::filesystem::path& machine) {
    host::CuttingCalibrationOptions options;
    options.data = data;
    options.output = output;
    options.cuts = cuts;
    options.machine = machine;
    options.side = side_of(side);
    if (law) {
        options.asked_form = choice<CuttingLawForm>("law", *law,
                                                    {{"linear_edge", CuttingLawForm::linear_edge},
                                                     {"power", CuttingLawForm::power},
                                                     {"combined", CuttingLawForm::combined}});
    }
    return reported(host::calibrate_cutting, options);
}

}  // namespace

void bind_calibration(py::module_& module) {
    module.def("calibrate_friction", &friction, py::arg("data"), py::arg("output"), py::arg("axis"),
               py::arg("low_pass_hz"), py::arg("minimum_speed_mm_s"));
    module.def("calibrate_spindle", &spindle, py::arg("data"), py::arg("output"), py::arg("low_pass_hz"));
    module.def("calibrate_standard_cut", &standard_cut, py::arg("data"), py::arg("output"), py::arg("cuts"),
               py::arg("machine"), py::arg("database"), py::arg("entry"), py::arg("side"));
    module.def("calibrate_cutting", &cutting, py::arg("data"), py::arg("output"), py::arg("side"), py::arg("law"),
               py::arg("cuts"), py::arg("machine"));
}

}  // namespace millforce::python
