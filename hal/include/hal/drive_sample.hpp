// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// What the machine reports to the controller, once per sample. Plain data: a driver fills it, the tick reads it.
/// Nothing here depends on a bus, a chip or an operating system.

namespace millforce::hal {

inline constexpr std::size_t axis_count = 3;

/// Which quantities of a sample are present. A quantity that is not present, or not finite, is "no measurement".
enum class Present : std::uint8_t {
    spindle_count = 1U << 0U,
    spindle_current = 1U << 1U,
    x_axis = 1U << 2U,
    y_axis = 1U << 3U,
    z_axis = 1U << 4U,
    force_sensor = 1U << 5U,  ///< force_N, and the velocities of x and y with or without their currents
};

constexpr std::uint8_t mask(Present quantity) {
    return static_cast<std::uint8_t>(quantity);
}
constexpr std::uint8_t axis_mask(std::size_t axis) {
    return static_cast<std::uint8_t>(mask(Present::x_axis) << axis);
}
inline constexpr std::uint8_t all_present = 0x1F;  ///< all that drives give

struct DriveSample {
    std::uint32_t time_us = 0;  ///< wraps after 71.6 minutes; only differences are used

    std::uint32_t spindle_count = 0;        ///< encoder count, wraps; increases in the cutting direction (M3)
    std::uint32_t spindle_index_count = 0;  ///< the count latched at the last index pulse
    std::uint8_t spindle_index_number = 0;  ///< increases by one at each index pulse, wraps; constant: no index wired

    std::uint8_t present = 0;  ///< mask of Present
    std::uint8_t part = 0;     ///< axes of which the current alone (bits 0…2) or the velocity alone (3…5) is known

    float spindle_current_A = 0.0F;
    std::array<float, axis_count> axis_current_A{};
    std::array<float, axis_count> axis_velocity_mm_s{};  ///< velocity of the tool relative to the workpiece
    std::array<float, 2> force_N{};  ///< readings of a force sensor: on the workpiece, along machine x and y
};

constexpr void set_present(DriveSample& sample, Present quantity) {
    sample.present = static_cast<std::uint8_t>(sample.present | mask(quantity));
}

[[nodiscard]] constexpr bool knows_current(const DriveSample& sample, std::size_t axis) {
    return (sample.present & axis_mask(axis)) != 0 || (sample.part & (1U << axis)) != 0;
}
[[nodiscard]] constexpr bool knows_velocity(const DriveSample& sample, std::size_t axis) {
    return (sample.present & axis_mask(axis)) != 0 || (sample.part & (1U << (axis_count + axis))) != 0;
}
/// An axis is present where both are known.
constexpr void set_known(DriveSample& sample, std::size_t axis, bool has_current, bool has_velocity) {
    const bool is_whole = has_current && has_velocity;
    const unsigned current = 1U << axis;
    const unsigned velocity = 1U << (axis_count + axis);
    const unsigned of_part = is_whole ? 0U : (has_current ? current : 0U) | (has_velocity ? velocity : 0U);
    sample.part = static_cast<std::uint8_t>((sample.part & ~(current | velocity)) | of_part);
    sample.present = static_cast<std::uint8_t>((sample.present & ~axis_mask(axis)) | (is_whole ? axis_mask(axis) : 0U));
}

/// Slower than any feed of a cut; faster than that is no noise of a velocity.
inline constexpr float at_rest_mm_s = 0.5F;

/// Whether no axis moves. A velocity that is not a number does not rest.
[[nodiscard]] constexpr bool axes_rest(const std::array<float, axis_count>& velocity_mm_s) {
    for (const float velocity : velocity_mm_s) {
        if (!(velocity < at_rest_mm_s && velocity > -at_rest_mm_s)) {
            return false;
        }
    }
    return true;
}

/// Puts what another source knows of the same moment into a sample. The sample's time stays.
constexpr void add(DriveSample& sample, const DriveSample& other) {
    if ((other.present & mask(Present::spindle_count)) != 0) {
        sample.spindle_count = other.spindle_count;
        sample.spindle_index_count = other.spindle_index_count;
        sample.spindle_index_number = other.spindle_index_number;
        set_present(sample, Present::spindle_count);
    }
    if ((other.present & mask(Present::spindle_current)) != 0) {
        sample.spindle_current_A = other.spindle_current_A;
        set_present(sample, Present::spindle_current);
    }
    if ((other.present & mask(Present::force_sensor)) != 0) {
        sample.force_N = other.force_N;
        set_present(sample, Present::force_sensor);
    }
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
        const bool has_current = knows_current(other, axis);
        const bool has_velocity = knows_velocity(other, axis);
        sample.axis_current_A[axis] = has_current ? other.axis_current_A[axis] : sample.axis_current_A[axis];
        sample.axis_velocity_mm_s[axis] =
            has_velocity ? other.axis_velocity_mm_s[axis] : sample.axis_velocity_mm_s[axis];
        set_known(sample, axis, has_current || knows_current(sample, axis),
                  has_velocity || knows_velocity(sample, axis));
    }
}

/// What the CNC and the operator report, whenever it changes.
struct ProgramStatus {
    float programmed_feed_mm_s = 0.0F;   ///< F of the current block; 0: not known
    float operator_override = 1.0F;      ///< the operator's override; it always wins downwards
    bool rapid = false;                  ///< a G0 block is active
    bool feed_hold = false;              ///< the operator or the CNC holds the feed
    std::uint32_t line = 0;              ///< number of the program line of the block in work; 0: not known
    float distance_to_go_mm = 0.0F;      ///< way to that block's end, along its path
    float commanded_speed_rad_s = 0.0F;  ///< what the spindle's drive is told, the operator's share in it; 0: not known
};

}  // namespace millforce::hal
