// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "files/input_error.hpp"
#include "loop/override_source.hpp"
#include "module/array_table.hpp"
#include "module/bindings.hpp"
#include "module/trace_arrays.hpp"
#include "recording/recording.hpp"

namespace millforce::python {

namespace {

/// The tick, as `millforce replay` runs it, on samples in arrays. Each call goes on where the last one ended.
class Tick {
  public:
    explicit Tick(const firmware::Parameters<float>& parameters) : parameters_(parameters), controller_(parameters) {}

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
            if (const std::string_view name = column.name;
                name == "limit" || name == "fault" || name == "tooth_force_N") {
                add_columns(out, made.points, std::span(&column, 1));
            }
        }
        out["hold"] = py::module_::import("numpy").attr("array")(made.holds, py::arg("dtype") = "bool");
        return out;
    }

  private:
    struct Estimates {
        std::vector<sim::TracePoint> points;
        std::vector<bool> holds;
    };

    void fill(const std::vector<std::string>& names, const std::vector<Column>& columns) {
        if (!samples_) {
            auto table = std::make_unique<ArrayTable>(names);
            table_ = table.get();
            samples_.emplace(std::move(table), parameters_.machine.encoder_counts_per_rev);
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
        while (samples_->next()) {
            const hal::FeedOverride output = controller_.step(samples_->sample(), samples_->program());
            sim::TracePoint point;
            controller_.describe(point);
            point.time_s = samples_->time_s();
            point.override_ratio = static_cast<double>(output.ratio);
            made.points.push_back(point);
            made.holds.push_back(output.hold);
        }
        return made;
    }

    firmware::Parameters<float> parameters_;
    sim::MillforceController controller_;
    std::optional<host::RecordingReader> samples_;
    ArrayTable* table_ = nullptr;  // of samples_
};

}  // namespace

void bind_tick(py::module_& module) {
    py::class_<Tick>(module, "Tick")
        .def(py::init<const firmware::Parameters<float>&>(), py::arg("parameters"))
        .def("step", &Tick::step, py::arg("names"), py::arg("columns"));
}

}  // namespace millforce::python
