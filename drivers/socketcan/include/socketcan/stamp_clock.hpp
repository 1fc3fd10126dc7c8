// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <ctime>

namespace millforce::socketcan {

/// The kernel's stamps (CLOCK_REALTIME) on CLOCK_MONOTONIC, by an offset that is kept: the times between stamps stay
/// exactly as the kernel, and every other listener, has them. Taken anew where the clock was set.
class StampClock {
  public:
    /// `now_us`: a monotonic time not long ago; it tells whether the clock was set. Where the program has paused since,
    /// or the clock was set, the time is read anew.
    [[nodiscard]] std::uint64_t monotonic_from(const timespec& stamp, std::uint64_t now_us);
    /// What a time of this clock lacks to the time since 1970.
    [[nodiscard]] std::int64_t unix_offset_us();

  private:
    void measure();

    bool has_offset_ = false;
    std::int64_t offset_us_ = 0;
};

}  // namespace millforce::socketcan
