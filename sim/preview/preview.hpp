// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "cutting/engagement_map.hpp"
#include "loop/scenario.hpp"
#include "part_map/part_map.hpp"

namespace millforce::sim {

/// The part map from geometry: the tool goes along the program's path through the stock, without forces and without
/// time, and what it meets is written down every step_mm. Arc and depth are those of loop/workpiece.hpp. Cost: some
/// 10 µs a step. Throws InputError.
[[nodiscard]] host::PartMap preview(const Scenario& scenario, double step_mm = 0.1);

/// The same for a blank that lies off by up to `stock_tolerance_mm` in x and in y: four more blanks are gone through,
/// each off towards one corner. Where the cut of one of them has less than 0.6 or more than 1.5 of the drawn one's
/// section, or an arc that ends 0.3 rad elsewhere, the place is known at most: its cut is the one with the largest
/// section of all, and its least share the smallest section over that. What differs less the controller takes for
/// another steel. A surface that the program has cut itself lies where the program says. A part without a stock has no
/// tolerance. Cost: five times that of one.
[[nodiscard]] host::PartMap preview_within(const Scenario& scenario, double stock_tolerance_mm, double step_mm = 0.1);

/// Of a tool by the number by which the program calls it.
struct MapOfTool {
    std::uint32_t number = 0;
    host::PartMap map{};
};

/// The same for a program that changes its tool: the map of each of scenario.numbered_cutters that it uses, by number.
/// Each is along the path that its tool goes, in the material that the others have left. What a tool that is not among
/// them removes is left standing. Throws InputError.
[[nodiscard]] std::vector<MapOfTool> preview_of_tools(const Scenario& scenario, double stock_tolerance_mm,
                                                      double step_mm = 0.1);

/// Throws InputError "FILE:LINE: …" at the first move at a feed of a tool that is not among them, unless it is one of
/// `left_standing`; 0: before the first M6.
void require_tools_of(const Scenario& scenario, const std::vector<std::uint32_t>& left_standing);

/// The same, and `visit` sees each place but the end as it is written down, with the engagement as the plant has it.
using PreviewVisit = std::function<void(const host::MapPlace& place, const EngagementMap& engagement)>;
[[nodiscard]] host::PartMap preview(const Scenario& scenario, double step_mm, const PreviewVisit& visit);

}  // namespace millforce::sim
