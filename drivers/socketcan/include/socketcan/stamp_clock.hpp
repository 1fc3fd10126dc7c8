// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <ctime>

namespace millforce::socketcan {

/// The kernel's stamps (CLOCK_REALTIME) on CLOCK_MONOTONIC, by a constant offset: the times between stamps stay exactly
/// as the kernel, and every other listener, has them. The offset is measured again if the clock was set.
class StampClock {
  public:
    /// `now_us`: a recent monotonic time, to detect whether the clock was set. If it was, or the program has paused
    /// since, the time is read again.
    [[nodiscard]] std::uint64_t monotonic_from(const timespec& stamp, std::uint64_t now_us);
    /// Offset from this clock to the time since 1970.
    [[nodiscard]] std::int64_t unix_offset_us();

  private:
    void measure();

    bool has_offset_ = false;
    std::int64_t offset_us_ = 0;
};

}  // namespace millforce::socketcan
