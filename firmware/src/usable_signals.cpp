// SPDX-License-Identifier: Apache-2.0
#include "firmware/usable_signals.hpp"

#include "hal/finite.hpp"

namespace millforce::firmware {

/// No axis of a machine tool is faster.
static constexpr float fastest_mm_s = 10'000.0F;

static bool is_possible_velocity(float velocity_mm_s) {
    return hal::is_smaller(velocity_mm_s, fastest_mm_s);  // not so NaN
}

bool has_impossible_velocity(const hal::DriveSample& sample) {
    for (std::size_t k = 0; k < hal::axis_count; ++k) {
        if ((sample.present & hal::axis_mask(k)) != 0 && !is_possible_velocity(sample.axis_velocity_mm_s[k])) {
            return true;
        }
    }
    return false;
}

hal::DriveSample usable_drives_of(const hal::DriveSample& sample) {
    const auto is_present = [&](std::uint8_t mask) { return (sample.present & mask) != 0; };
    hal::DriveSample usable;
    if (is_present(hal::mask(hal::Present::spindle_current)) && hal::is_finite(sample.spindle_current_A)) {
        usable.present = hal::mask(hal::Present::spindle_current);
        usable.spindle_current_A = sample.spindle_current_A;
    }
    for (std::size_t k = 0; k < hal::axis_count; ++k) {
        if (is_present(hal::axis_mask(k)) && hal::is_finite(sample.axis_current_A[k]) &&
            is_possible_velocity(sample.axis_velocity_mm_s[k])) {
            usable.present = static_cast<std::uint8_t>(usable.present | hal::axis_mask(k));
            usable.axis_current_A[k] = sample.axis_current_A[k];
            usable.axis_velocity_mm_s[k] = sample.axis_velocity_mm_s[k];
        }
    }
    return usable;
}

}  // namespace millforce::firmware
