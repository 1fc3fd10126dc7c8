// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "files/input_error.hpp"
#include "firmware/tool_tick.hpp"
#include "loop/override_source.hpp"
#include "module/array_table.hpp"
#include "module/bindings.hpp"
#include "module/trace_arrays.hpp"
#include "parameters/tool_set.hpp"
#include "recording/recording.hpp"
#include "replay/wide_band_cells.hpp"

namespace millforce::python {

namespace {

using Parameters = firmware::Parameters<float>;
using ByNumber = std::map<std::uint32_t, Parameters>;

std::vector<host::NumberedTool> tools_of(const ByNumber& by_number) {
    std::vector<host::NumberedTool> tools;
    for (const auto& [number, parameters] : by_number) {
        if (number == 0) {
            throw host::InputError("parameters: tool 0; expected numbers from 1 on: 0 is no tool");
        }
        tools.push_back({number, parameters.tool});
    }
    return tools;
}

/// The tick, as `millforce replay` runs it, on samples in arrays. Each call goes on where the last one ended.
class Tick {
  public:
    explicit Tick(const Parameters& parameters)
        : parameters_(parameters), tick_(parameters), forces_{{0, firmware::total_force(parameters)}} {}
    explicit Tick(const ByNumber& by_number)
        : parameters_(by_number.begin()->second),
          prepared_(std::in_place, parameters_.machine, tools_of(by_number)),
          tick_(parameters_, &*prepared_) {
        for (const auto& [number, parameters] : by_number) {
            forces_.emplace(number, firmware::total_force(parameters));
        }
    }
    Tick(const Tick&) = delete;
    Tick& operator=(const Tick&) = delete;

    py::dict step(const std::vector<std::string>& names, const std::vector<Column>& columns) {
        fill(names, columns);
        Estimates made;
        {
            py::gil_scoped_release free;
            made = run();
        }
        py::dict out;
        add_columns(out, made.points, sim::estimate_columns());
        for (const sim::TraceColumn& column : sim::simulation_columns()) {
            if (const std::string_view name = column.name; name == "limit" || name == "fault" ||
                                                           name == "tooth_force_N" || name == "runout_um" ||
                                                           name == "cut_side" || name == "law_misfit") {
                add_columns(out, made.points, std::span(&column, 1));
            }
        }
        const py::object array = py::module_::import("numpy").attr("array");
        out["hold"] = array(made.holds, py::arg("dtype") = "bool");
        if (prepared_) {
            out["tool"] = array(made.tools, py::arg("dtype") = "uint32");
        }
        for (std::size_t k = 0; k < made.wide_band.size(); ++k) {
            out[host::wide_band_columns()[k].name] = array(made.wide_band[k], py::arg("dtype") = "float32");
        }
        return out;
    }

  private:
    struct Estimates {
        std::vector<sim::TracePoint> points;
        std::vector<bool> holds;
        std::vector<std::uint32_t> tools;
        std::vector<std::vector<float>> wide_band;  ///< by column; empty: there is none
    };

    void fill(const std::vector<std::string>& names, const std::vector<Column>& columns) {
        if (!samples_) {
            auto table = std::make_unique<ArrayTable>(names);
            table_ = table.get();
            samples_.emplace(std::move(table), parameters_.machine.encoder_counts_per_rev);
            if (prepared_ && !samples_->has_tool()) {
                throw host::InputError("samples: no column 'tool'; expected one with several tools");
            }
        }
        if (names != table_->column_names()) {
            throw host::InputError("samples: other columns than before; expected the same in the same order");
        }
        std::vector<const double*> starts;
        const auto rows = columns.empty() ? 0 : columns.front().size();
        for (std::size_t k = 0; k < columns.size(); ++k) {
            if (columns[k].ndim() != 1 || columns[k].size() != rows) {
                throw host::InputError(
                    fmt::format("samples: column '{}' has {} values in {} dimensions; expected {} in one, as in '{}'",
                                names[k], columns[k].size(), columns[k].ndim(), rows, names.front()));
            }
            starts.push_back(columns[k].data());
        }
        table_->fill(std::move(starts), static_cast<std::size_t>(rows));
    }

    Estimates run() {
        Estimates made;
        const bool has_wide_band = !prepared_ && host::has_wide_band(samples_->has_force_sensor(), parameters_.tool);
        made.wide_band.resize(has_wide_band ? host::wide_band_columns().size() : 0);
        while (samples_->next()) {
            tick_.follow_tool(samples_->tool(), hal::axes_rest(samples_->sample().axis_velocity_mm_s));
            const hal::FeedOverride output = firmware::step_and_work(tick_, samples_->sample(), samples_->program());
            made.points.push_back(point_of(output));
            made.holds.push_back(output.hold);
            made.tools.push_back(tick_.tool());
            for (std::size_t k = 0; k < made.wide_band.size(); ++k) {
                made.wide_band[k].push_back(
                    host::wide_band_columns()[k].value(tick_.of_tool().wide_band(), parameters_.tool));
            }
        }
        return made;
    }

    [[nodiscard]] sim::TracePoint point_of(const hal::FeedOverride& output) const {
        const firmware::TickRecord record = firmware::tick_record(tick_.of_tool(), output, 0);
        sim::TracePoint point;
        sim::describe(record, point);
        if (const auto force = forces_.find(tick_.tool()); force != forces_.end()) {
            const firmware::ShownForces shown = firmware::shown_forces(force->second, record);
            point.peak_force_N = static_cast<double>(shown.peak_N);
            point.force_limit_N = static_cast<double>(shown.limit_N);
        }
        point.time_s = samples_->time_s();
        point.override_ratio = static_cast<double>(output.ratio);
        return point;
    }

    Parameters parameters_;
    std::optional<host::PreparedTools> prepared_;
    firmware::ToolTick tick_;
    std::map<std::uint32_t, estimation::TotalForce<float>> forces_;
    std::optional<host::RecordingReader> samples_;
    ArrayTable* table_ = nullptr;  // of samples_
};

}  // namespace

void bind_tick(py::module_& module) {
    py::class_<Tick>(module, "Tick")
        .def(py::init<const Parameters&>(), py::arg("parameters"))
        .def(py::init<const ByNumber&>(), py::arg("parameters"))
        .def("step", &Tick::step, py::arg("names"), py::arg("columns"));
}

}  // namespace millforce::python
