// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "firmware/parameters.hpp"
#include "part_map/part_map.hpp"

namespace millforce::host {

/// A stretch of the path where geometry and run contradict each other beyond their doubt.
struct Contradiction {
    double begin_mm = 0.0;
    double end_mm = 0.0;
    std::size_t line = 0;
    std::string what;
};

struct JoinedMap {
    PartMap map;
    double hardness = 1.0;  ///< K_s relative to the tool's file, over the whole part
    double hardness_sd = 0.0;
    double compared_mm = 0.0;  ///< path in cuts that both know
    int contacts = 0;          ///< first contacts that both have
    double offset_mm = 0.0;    ///< of the run's behind those of geometry, mean along the path
    double offset_sd_mm = 0.0;
    std::vector<Contradiction> contradictions;
};

/// The map from geometry, corrected by that of a run of the same program:
///
/// - Arcs are those of geometry.
/// - The forces over those that geometry gives are the product of hardness and depth. Their middle over the part is the
///   hardness; what a place deviates from it is a correction of its depth, weighed with a geometry that is trusted to
///   5 %.
/// - Where a cut begins further than 0.75 mm from where geometry has it, the cuts of that block are shifted by it.
/// - Where a force, an arc or air contradict each other beyond their doubt, the place is marked, and not known: the
///   controller takes nothing from it.
///
/// Places that the run did not see remain as geometry has them. Blocks are matched by line and way to their end.
[[nodiscard]] JoinedMap joined(const PartMap& geometry, const PartMap& run,
                               const firmware::ToolParameters<float>& tool);

}  // namespace millforce::host
