// SPDX-License-Identifier: Apache-2.0
#include "module/trace_arrays.hpp"

namespace millforce::python {

namespace {

py::object numbers(const std::vector<sim::TracePoint>& points, const sim::TraceColumn& column) {
    py::array_t<double> array(static_cast<py::ssize_t>(points.size()));
    double* const values = array.mutable_data();
    for (std::size_t k = 0; k < points.size(); ++k) {
        values[k] = column.number(points[k]);
    }
    return array;
}

py::object texts(const std::vector<sim::TracePoint>& points, const sim::TraceColumn& column) {
    py::list list(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        list[k] = py::str(column.text(points[k]));
    }
    return py::module_::import("numpy").attr("array")(list, py::arg("dtype") = "U");
}

}  // namespace

void add_columns(py::dict& columns, const std::vector<sim::TracePoint>& points,
                 std::span<const sim::TraceColumn> wanted) {
    for (const sim::TraceColumn& column : wanted) {
        columns[column.name] = column.number != nullptr ? numbers(points, column) : texts(points, column);
    }
}

}  // namespace millforce::python
