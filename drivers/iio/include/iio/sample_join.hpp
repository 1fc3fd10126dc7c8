// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/drive_sample.hpp"

namespace millforce::iio {

inline constexpr std::size_t drive_capacity = 1 + hal::axis_count;  ///< spindle, x, y, z

/// What the converter reported since the last call.
struct CurrentReading {
    std::uint64_t time_us = 0;  ///< time of the newest value
    std::array<bool, drive_capacity> has{};
    std::array<float, drive_capacity> current_A{};
};

/// What counters reported, or a bus that carries positions alone.
struct MotionReading {
    bool has_count = false;
    std::uint32_t spindle_count = 0;
    std::uint32_t spindle_index_count = 0;
    std::uint8_t spindle_index_number = 0;
    std::array<bool, hal::axis_count> has_velocity{};
    std::array<float, hal::axis_count> velocity_mm_s{};
};

/// One sample of both. An axis of which one of the two is known is there in part (DriveSample::part). The time is that
/// of the currents: read the counters right after them.
[[nodiscard]] hal::DriveSample join(const CurrentReading& currents, const MotionReading& motion);

}  // namespace millforce::iio
