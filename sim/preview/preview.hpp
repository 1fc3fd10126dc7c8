// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

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

/// The same, and `visit` sees each place but the end as it is written down, with the engagement as the plant has it.
using PreviewVisit = std::function<void(const host::MapPlace& place, const EngagementMap& engagement)>;
[[nodiscard]] host::PartMap preview(const Scenario& scenario, double step_mm, const PreviewVisit& visit);

}  // namespace millforce::sim
