// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <ctime>

namespace millforce::socketcan {

/// The kernel's stamps (CLOCK_REALTIME) on CLOCK_MONOTONIC, by a constant offset: the times between stamps stay exactly
/// as the kernel, and every other listener, has them. If the clock was set, by 5 ms or more, the offset changes by as
/// much, so that this time goes on.
class StampClock {
  public:
    /// Often, before stamps are read: finds out whether the clock was set.
    void look();
    /// `now_us`: a recent monotonic time, to detect whether the clock was set. If it was, or the program has paused
    /// since, the time is read again.
    [[nodiscard]] std::uint64_t monotonic_from(const timespec& stamp, std::uint64_t now_us);
    /// Offset from this clock to the time since 1970.
    [[nodiscard]] std::int64_t unix_offset_us();

  private:
    struct Offset {
        std::int64_t offset_us;
        std::int64_t uncertain_us;
    };
    static Offset measured_once();
    static Offset measured();
    [[nodiscard]] bool is_far_from(const Offset& measured);
    void follow_setting();

    bool has_offset_ = false;
    std::int64_t offset_us_ = 0;
};

}  // namespace millforce::socketcan
