// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/feed_override.hpp"
#include "hal/finite.hpp"

namespace millforce::hal {

/// Whether an output must stop the feed: hold, any fault, or a ratio that is not a finite number above 0.
[[nodiscard]] constexpr bool demands_stop(const FeedOverride& feed_override) {
    return feed_override.hold || feed_override.fault != 0 || !(feed_override.ratio > 0.0F) ||
           !is_finite(feed_override.ratio);
}

/// Whether a tick may feed a watchdog, once its heartbeat has advanced.
[[nodiscard]] constexpr bool is_within_limits(const FeedOverride& feed_override, float largest_ratio) {
    return feed_override.ratio >= 0.0F && feed_override.ratio <= largest_ratio;
}

/// Without a tick for so long the controller is dead: outputs stop the feed, receivers expect no more of it.
inline constexpr std::uint32_t default_tick_timeout_us = 20'000;

/// Distinguishes a controller that ticks from one that has stopped: by its heartbeat, not by being called.
class TickWatch {
  public:
    explicit TickWatch(std::uint32_t timeout_us) : timeout_us_(timeout_us) {}

    /// True if this tick was not seen before.
    bool update(std::uint32_t heartbeat, std::uint64_t time_us) {
        if (has_heartbeat_ && heartbeat == heartbeat_) {
            return false;
        }
        has_heartbeat_ = true;
        heartbeat_ = heartbeat;
        tick_us_ = time_us;
        return true;
    }
    [[nodiscard]] bool ticks(std::uint64_t time_us) const {
        return has_heartbeat_ && time_us <= tick_us_ + timeout_us_;
    }

  private:
    std::uint32_t timeout_us_;
    std::uint32_t heartbeat_ = 0;
    std::uint64_t tick_us_ = 0;
    bool has_heartbeat_ = false;
};

}  // namespace millforce::hal
