// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "drives_on_vcan.hpp"

#include <CppUTest/TestHarness.h>

/// Claims about samples of the drives that run_drives() plays.

namespace millforce::vcan {

inline bool has_count(const hal::DriveSample& sample) {
    return (sample.present & hal::mask(hal::Present::spindle_count)) != 0;
}

inline int samples_with_everything(const std::vector<hal::DriveSample>& samples) {
    return static_cast<int>(std::count_if(samples.begin(), samples.end(), [](const hal::DriveSample& sample) {
        return sample.present == hal::all_present;
    }));
}

/// Every count is one that the drive had, and none is older than the one before.
inline void check_counts(const std::vector<hal::DriveSample>& samples) {
    std::uint32_t last = 0;
    for (const hal::DriveSample& sample : samples) {
        if (has_count(sample)) {
            UNSIGNED_LONGS_EQUAL(0, sample.spindle_count % counts_per_sync);
            CHECK(sample.spindle_count >= last);
            last = sample.spindle_count;
            DOUBLES_EQUAL(6.0, sample.spindle_current_A, 1e-5);
        }
    }
}

}  // namespace millforce::vcan
