// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "cutting/cutting_force.hpp"

namespace millforce::sim {

/// One revolution of the spindle over a workpiece that does not change.
struct RevolutionLoad {
    double mean_fx_N = 0.0;
    double mean_fy_N = 0.0;
    double mean_fz_N = 0.0;
    double mean_torque_Nm = 0.0;
    double peak_total_N = 0.0;  ///< largest √(F_x² + F_y²) of all teeth together
    double peak_tooth_N = 0.0;  ///< largest √(F_x² + F_y²) of one tooth alone: what breaks it
    double peak_torque_Nm = 0.0;
    std::array<double, Cutter::max_teeth> tooth_peak_N{};  ///< peak of each tooth
};

/// Means and peaks over a revolution by numeric integration: the truth for the force threshold (the ratio
/// peak_total/peak_tooth says how far the total may exceed what one tooth may bear) and for averages.
///
/// The revolution is divided where any tooth's lower or upper end crosses an edge of the material, so that the jumps of
/// straight teeth fall between samples; within each part the midpoint rule with steps of at most `step_rad`, and peaks
/// looked for at both ends as well. A step of the material's height inside an engagement is resolved to one step. With
/// equal teeth one pitch represents all. Throws as `CuttingForce::load`, and InputError for a step outside 1e-4…0.1.
/// Cost: about 2π/step calls of load, N times fewer with equal teeth.
RevolutionLoad revolution_load(const CuttingForce& force, double feed_per_tooth_mm, const EngagementMap& map,
                               double step_rad = EngagementMap::bin_rad);

}  // namespace millforce::sim
