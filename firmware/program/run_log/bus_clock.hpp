// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/can_frame.hpp"
#include "hal/drive_wiring.hpp"

namespace millforce::host {

/// How time shall pass on a bus, as a user chooses it.
struct BusPace {
    std::uint32_t slow_motion = 1;
    bool lock_step = false;
};

/// How time passes on a bus.
struct BusTime {
    /// So many times slower than a clock: all periods and time-outs, drives and CNC too, for a computer that is busy.
    std::uint32_t slowness = 1;
    /// Lock-step: with each SYNC by one period and not otherwise, and the next SYNC waits until every drive has
    /// answered. A computer of any load loses nothing then; what cannot be seen so is a late frame.
    bool in_lock_step = false;
    std::uint32_t sync_id = hal::default_sync_id;
    std::uint32_t sync_period_us = 1'000;
};

inline constexpr std::uint32_t largest_slowness = 1000;

/// The time of a bus, in µs. The plant, the controller and a replay must be given the same BusTime: a recorded stamp,
/// or in lock-step the frames before it, then give the same time to all of them.
class BusClock {
  public:
    /// `unix_offset_us`: Unix time minus monotonic time, in us, now. It stays the same when the clock is set.
    explicit BusClock(const BusTime& time = {}, std::int64_t unix_offset_us = 0)
        : time_(time), offset_us_(unix_offset_us) {}

    /// With every frame in its order, before its time is asked for.
    void on_frame(const hal::CanFrame& frame) {
        const bool is_sync = frame.id == time_.sync_id && !frame.extended && !frame.remote;
        syncs_ += is_sync ? 1U : 0U;
    }
    /// A run begins with its boot-up: in lock-step its time is counted from there.
    void begin() { syncs_ = 0; }

    [[nodiscard]] std::uint64_t of_unix(std::uint64_t unix_us) const {
        constexpr std::uint64_t first_us = 1'000'000;
        return time_.in_lock_step ? first_us + syncs_ * time_.sync_period_us : unix_us / time_.slowness;
    }
    [[nodiscard]] std::uint64_t of_monotonic(std::uint64_t time_us) const { return of_unix(unix_us(time_us)); }
    /// In a recording: the clock as it would be if it had not been set during the run.
    [[nodiscard]] std::uint64_t unix_us(std::uint64_t monotonic_us) const {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(monotonic_us) + offset_us_);
    }
    /// How long that lasts on a clock.
    [[nodiscard]] std::uint64_t real_us(std::uint64_t duration_us) const { return duration_us * time_.slowness; }
    [[nodiscard]] const BusTime& time() const { return time_; }

  private:
    BusTime time_;
    std::int64_t offset_us_;
    std::uint64_t syncs_ = 0;
};

}  // namespace millforce::host
