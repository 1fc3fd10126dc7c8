// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "module/bindings.hpp"
#include "report/trace_csv.hpp"

namespace millforce::python {

/// Puts columns of points into a dictionary: arrays of numbers, NaN for "no estimate", and of text.
void add_columns(py::dict& columns, const std::vector<sim::TracePoint>& points,
                 std::span<const sim::TraceColumn> wanted);

}  // namespace millforce::python
