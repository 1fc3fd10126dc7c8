// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <numbers>

#include "estimation/number/elementary.hpp"
#include "firmware/parameters.hpp"
#include "hal/drive_sample.hpp"
#include "machine_and_tool.hpp"

/// The cut whose ticks are counted, and whose estimates are compared between processors: down milling in steel along +x
/// after some revolutions of air, with the tooth's ripple on the currents. Everything is worked out in float, so that
/// the samples are the same bits everywhere.

namespace millforce::instructions {

using bench::encoder_counts_per_rev;
using bench::teeth;

inline constexpr float sample_interval_s = 0.001F;
inline constexpr std::uint32_t sample_interval_us = 1000;

inline constexpr int air_samples = 100;
inline constexpr int settling_samples = 100;  // from contact until each window lies wholly in the cut
inline constexpr int counted_samples = 300;

using bench::machine_and_tool;

struct Cut {
    float spindle_speed_rad_s;
    float feed_mm_s;  // 0.075 mm per tooth
    bool widens;      // from start to end, so that no revolution is like the one before
    int air_samples = instructions::air_samples;
    int settling_samples = instructions::settling_samples;

    [[nodiscard]] constexpr int samples() const { return air_samples + settling_samples + counted_samples; }
};
inline constexpr Cut fast_widening_cut{418.879F, 20.0F, true};  // 4000 rpm: 15 samples a revolution

/// Sample `index` of a cut, which begins after its `air_samples`.
inline hal::DriveSample sample_of(int index, const firmware::Parameters<float>& parameters,
                                  const Cut& cut = fast_widening_cut) {
    constexpr float tangential_N = 250.0F;
    constexpr float narrow_ratio = -0.75F;  // F_ax/F_at
    constexpr float wide_ratio = -0.2F;
    constexpr float ripple_share = 0.3F;
    const float time_s = static_cast<float>(index) * sample_interval_s;
    const float turned_rev = time_s * cut.spindle_speed_rad_s / (2.0F * std::numbers::pi_v<float>);
    const float tooth_phase_rad = 2.0F * std::numbers::pi_v<float> * teeth * turned_rev;
    const float load =
        index < cut.air_samples ? 0.0F : 1.0F + ripple_share * estimation::elementary::sin(tooth_phase_rad);
    const float torque_Nm = load * tangential_N * parameters.tool.diameter_mm * 0.0005F;

    hal::DriveSample sample;
    sample.time_us = static_cast<std::uint32_t>(index) * sample_interval_us;
    sample.spindle_count = static_cast<std::uint32_t>(turned_rev * static_cast<float>(encoder_counts_per_rev));
    sample.present = hal::all_present;
    sample.spindle_current_A =
        (torque_Nm - parameters.machine.spindle.K_t2_Nm) / parameters.machine.spindle.K_t1_Nm_per_A;
    const float progress = cut.widens ? static_cast<float>(index) / static_cast<float>(cut.samples()) : 0.5F;
    const float feed_N = tangential_N * (narrow_ratio + (wide_ratio - narrow_ratio) * progress);
    const auto& x = parameters.machine.axes[0];
    const float friction_A = x.positive.at(cut.feed_mm_s * 0.06F) + x.K_x3_A;
    sample.axis_current_A[0] = friction_A + load * feed_N / x.K_x4_N_per_A;
    sample.axis_velocity_mm_s[0] = cut.feed_mm_s;
    return sample;
}

/// The air ahead of the cut is a rapid: it teaches the spindle's idle torque and the axis' friction.
inline hal::ProgramStatus program_at(int index, const Cut& cut = fast_widening_cut) {
    hal::ProgramStatus program;
    program.programmed_feed_mm_s = cut.feed_mm_s;
    program.rapid = index < cut.air_samples;
    return program;
}

}  // namespace millforce::instructions
