// SPDX-License-Identifier: Apache-2.0
#include "iio/sample_join.hpp"

namespace millforce::iio {

hal::DriveSample join(const CurrentReading& currents, const MotionReading& motion) {
    hal::DriveSample sample;
    sample.time_us = static_cast<std::uint32_t>(currents.time_us);
    unsigned present = 0;
    if (currents.has[0]) {
        sample.spindle_current_A = currents.current_A[0];
        present |= hal::mask(hal::Present::spindle_current);
    }
    if (motion.has_count) {
        sample.spindle_count = motion.spindle_count;
        sample.spindle_index_count = motion.spindle_index_count;
        sample.spindle_index_number = motion.spindle_index_number;
        present |= hal::mask(hal::Present::spindle_count);
    }
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        if (currents.has[1 + axis] && motion.has_velocity[axis]) {
            sample.axis_current_A[axis] = currents.current_A[1 + axis];
            sample.axis_velocity_mm_s[axis] = motion.velocity_mm_s[axis];
            present |= hal::axis_mask(axis);
        }
    }
    sample.present = static_cast<std::uint8_t>(present);
    return sample;
}

}  // namespace millforce::iio
