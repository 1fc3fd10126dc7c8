// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "estimation/number/circle.hpp"
#include "hal/drive_sample.hpp"

namespace millforce::host {

/// Time and spindle angle of samples, whose own counters wrap at 2³²: these go on. Samples must be less than 2³¹ µs and
/// 2³¹ counts apart. No heap; one thread.
class ContinuousCounts {
  public:
    explicit ContinuousCounts(std::uint32_t encoder_counts_per_rev)
        : counts_per_rev_(static_cast<double>(encoder_counts_per_rev)) {}

    void follow(const hal::DriveSample& sample) {
        time_us_ += static_cast<std::int32_t>(sample.time_us - last_time_us_);
        last_time_us_ = sample.time_us;
        if (has_count(sample)) {
            count_ += static_cast<std::int32_t>(sample.spindle_count - last_count_);
            last_count_ = sample.spindle_count;
        }
    }

    [[nodiscard]] double time_s() const { return static_cast<double>(time_us_) / 1e6; }
    [[nodiscard]] double angle_rad() const { return angle_rad(count_); }
    /// Where the last index pulse of the sample came that was followed last.
    [[nodiscard]] double index_angle_rad(const hal::DriveSample& sample) const {
        return angle_rad(count_ + static_cast<std::int32_t>(sample.spindle_index_count - sample.spindle_count));
    }

    [[nodiscard]] static bool has_count(const hal::DriveSample& sample) {
        return (sample.present & hal::mask(hal::Present::spindle_count)) != 0;
    }
    [[nodiscard]] static bool has_index(const hal::DriveSample& sample) {
        return has_count(sample) && sample.spindle_index_number != 0;
    }

  private:
    [[nodiscard]] double angle_rad(std::int64_t count) const {
        return static_cast<double>(count) / counts_per_rev_ * estimation::turn_rad<double>;
    }

    double counts_per_rev_;
    std::int64_t time_us_ = 0;
    std::int64_t count_ = 0;
    std::uint32_t last_time_us_ = 0;
    std::uint32_t last_count_ = 0;
};

}  // namespace millforce::host
