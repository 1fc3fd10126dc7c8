// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench_control/parts.hpp"
#include "loop/scenario.hpp"

/// A part's blank and program, made of its few numbers.

namespace millforce::sim {

struct PartProgram {
    StockSettings stock;
    std::string gcode;
};

/// Throws std::logic_error for a shape that no function draws.
[[nodiscard]] PartProgram program_of_part(const BenchPart& part);

}  // namespace millforce::sim
