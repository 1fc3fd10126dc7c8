// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "firmware/tick.hpp"

/// A machine, a tool and a cut for tests of the tick.

namespace millforce::test {

using Parameters = firmware::Parameters<float>;

inline constexpr float feed_mm_s = 20.0F;

inline Parameters machine_and_tool() {
    Parameters p;
    p.machine.spindle.K_t1_Nm_per_A = 0.7F;
    p.machine.spindle.K_t2_Nm = -0.95F;
    p.machine.spindle.inertia_kg_m2 = 0.004F;
    for (auto& axis : p.machine.axes) {
        axis.positive.K_x2_A_min_per_m = 0.65F;
        axis.negative.K_x2_A_min_per_m = 0.65F;
        axis.K_x3_A = 1.6F;
        axis.K_x4_N_per_A = 120.0F;
        axis.mass_kg = 250.0F;
    }
    p.tool.side = estimation::CutSide::down;
    p.tool.tooth_force_limit_N = 700.0F;
    p.tool.law = estimation::linear_edge_law(1650.0F, 22.0F, 620.0F, 28.0F);
    return p;
}

/// So well known that one solution is like the next.
inline Parameters well_known_machine() {
    Parameters p = machine_and_tool();
    p.machine.spindle.current_sd_A = 0.02F;
    p.machine.spindle.inertia_kg_m2 = 0.0005F;
    for (auto& axis : p.machine.axes) {
        axis.friction_relative_sd = 0.01F;
        axis.friction_ripple_A = 0.01F;
        axis.current_sd_A = 0.02F;
        axis.gain_relative_sd = 0.01F;
    }
    return p;
}

/// A straight way along +x at 1 kHz and 4000 rpm: 0.2 s of air, then a cut with F_at = 250 N, F_ax = −150 N.
inline hal::DriveSample sample_of(int index, std::uint32_t first_time_us = 0) {
    const Parameters p = machine_and_tool();
    const float turned_rev = static_cast<float>(index) * 0.001F * 4000.0F / 60.0F;
    const float ripple = 1.0F + 0.3F * std::sin(8.0F * std::numbers::pi_v<float> * turned_rev);
    const float load = index < 200 ? 0.0F : ripple;
    hal::DriveSample sample;
    sample.time_us = first_time_us + static_cast<std::uint32_t>(index) * 1000U;
    sample.spindle_count = static_cast<std::uint32_t>(turned_rev * 4096.0F);
    sample.present = hal::all_present;
    sample.spindle_current_A = (load * 250.0F * 0.005F - p.machine.spindle.K_t2_Nm) / p.machine.spindle.K_t1_Nm_per_A;
    const auto& x = p.machine.axes[0];
    sample.axis_current_A[0] = x.positive.at(feed_mm_s * 0.06F) + x.K_x3_A - load * 150.0F / x.K_x4_N_per_A;
    sample.axis_velocity_mm_s[0] = feed_mm_s;
    return sample;
}

inline hal::ProgramStatus program() {
    hal::ProgramStatus status;
    status.programmed_feed_mm_s = feed_mm_s;
    return status;
}

/// A tick's tables take longer to build than a thousand samples, minutes on a slow emulator: the cases begin with
/// copies.
inline firmware::ForceControlTick<float> fresh_tick() {
    static const firmware::ForceControlTick<float> tick(machine_and_tool());
    return tick;
}

}  // namespace millforce::test
