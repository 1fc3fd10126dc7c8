// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/parameters.hpp"

#include <cstdint>

/// The machine and the tool whose costs are counted and timed.

namespace millforce::bench {

inline constexpr std::uint32_t encoder_counts_per_rev = 8192;
inline constexpr std::uint8_t teeth = 4;

inline firmware::Parameters<float> machine_and_tool() {
    firmware::Parameters<float> parameters;
    parameters.machine.spindle.K_t1_Nm_per_A = 0.7F;
    parameters.machine.spindle.K_t2_Nm = -0.953F;
    parameters.machine.spindle.inertia_kg_m2 = 0.004F;
    parameters.machine.encoder_counts_per_rev = encoder_counts_per_rev;
    for (auto& axis : parameters.machine.axes) {
        axis.positive.K_x2_A_min_per_m = 0.65F;
        axis.negative.K_x2_A_min_per_m = 0.65F;
        axis.K_x3_A = 1.6F;
        axis.K_x4_N_per_A = 120.0F;
        axis.mass_kg = 250.0F;
        axis.velocity_floor_mm_s = 2.0F;
    }
    parameters.tool.teeth = teeth;
    parameters.tool.side = estimation::CutSide::down;
    parameters.tool.tooth_force_limit_N = 700.0F;
    parameters.tool.law = estimation::linear_edge_law(1650.0F, 22.0F, 620.0F, 28.0F);
    parameters.tool.law.K_s_relative_sd = 0.15F;
    parameters.tool.law.r_1_relative_sd = 0.05F;
    return parameters;
}

}  // namespace millforce::bench
