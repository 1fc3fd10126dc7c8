// SPDX-License-Identifier: Apache-2.0
#include "iio/sample_join.hpp"

namespace millforce::iio {

hal::DriveSample join(const CurrentReading& currents, const MotionReading& motion) {
    hal::DriveSample sample;
    sample.time_us = static_cast<std::uint32_t>(currents.time_us);
    if (currents.has[0]) {
        sample.spindle_current_A = currents.current_A[0];
        hal::set_present(sample, hal::Present::spindle_current);
    }
    if (motion.has_count) {
        sample.spindle_count = motion.spindle_count;
        sample.spindle_index_count = motion.spindle_index_count;
        sample.spindle_index_number = motion.spindle_index_number;
        hal::set_present(sample, hal::Present::spindle_count);
    }
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        const bool has_current = currents.has[1 + axis];
        const bool has_velocity = motion.has_velocity[axis];
        sample.axis_current_A[axis] = has_current ? currents.current_A[1 + axis] : 0.0F;
        sample.axis_velocity_mm_s[axis] = has_velocity ? motion.velocity_mm_s[axis] : 0.0F;
        hal::set_known(sample, axis, has_current, has_velocity);
    }
    return sample;
}

}  // namespace millforce::iio
