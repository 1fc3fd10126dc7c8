// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "hal/drive_sample.hpp"
#include "hal/finite.hpp"

namespace millforce::firmware {

/// Of the tool along its path; 0 where it is not known.
[[nodiscard]] inline float path_speed_mm_s(const hal::DriveSample& sample) {
    float sum = 0.0F;
    for (const float velocity_mm_s : sample.axis_velocity_mm_s) {
        sum += velocity_mm_s * velocity_mm_s;
    }
    return hal::is_finite(sum) ? std::sqrt(sum) : 0.0F;
}

}  // namespace millforce::firmware
