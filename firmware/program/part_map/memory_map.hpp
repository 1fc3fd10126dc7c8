// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "firmware/parameters.hpp"
#include "part_map/part_map.hpp"
#include "part_map/run_memory.hpp"

namespace millforce::host {

/// The part map of what a run saw with one of its tools (map_learner.hpp says by which rules), by the law of that tool.
/// `tool`: as in the blocks. `stock_tolerance_mm`: by how much the next blank may lie off in x and in y. Cost: some 10
/// ms for each metre.
[[nodiscard]] PartMap map_of(const RunMemory& run, std::size_t tool, const firmware::Parameters<float>& parameters,
                             double stock_tolerance_mm);

}  // namespace millforce::host
