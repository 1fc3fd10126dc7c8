// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "firmware/parameters.hpp"
#include "part_map/part_map.hpp"
#include "part_map/run_memory.hpp"

namespace millforce::host {

/// The part map of what a run saw with one of its tools, by the law of that tool.
///
/// A place where the force was that of air is air, as long as a cut that the noise may have hidden there would not load
/// a tooth up to its limit at the feed of air; else it is not known. Where immersion and depth were estimated they are
/// the cut, with their deviations. Where there was a force without them, as while the tool enters or leaves, the cut is
/// at most that of its neighbour, or a slot as deep where the force was higher than that; otherwise it is not known.
/// Nor are places that the run did not reach. A cut that seems less than 0.6 as deep as another one of its block within
/// two diameters is at most that one: the forces over a hole are those of a wide and shallow cut. So is air within
/// twice the stock's tolerance of a cut: where this blank had air, the next one may have stock.
///
/// Depth and K_s enter the forces as a product: the depth is the one that gives the measured force by the tool's law.
///
/// `tool`: as in the blocks. `stock_tolerance_mm`: by how much the next blank may lie off in x and in y. Cost: some 10
/// ms for each metre.
[[nodiscard]] PartMap map_of(const RunMemory& run, std::size_t tool, const firmware::Parameters<float>& parameters,
                             double stock_tolerance_mm);

}  // namespace millforce::host
