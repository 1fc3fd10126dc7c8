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

/// The same, and `visit` sees each place but the end as it is written down, with the engagement as the plant has it.
using PreviewVisit = std::function<void(const host::MapPlace& place, const EngagementMap& engagement)>;
[[nodiscard]] host::PartMap preview(const Scenario& scenario, double step_mm, const PreviewVisit& visit);

}  // namespace millforce::sim
