// SPDX-License-Identifier: Apache-2.0
#include "gpio/feed_hold_line.hpp"

namespace millforce::gpio {

FeedHoldLine::~FeedHoldLine() {
    if (health_.is_ready) {
        (void)port_.set(levels_ & ~release_line);
    }
}

void FeedHoldLine::update(const hal::FeedOverride& feed_override, std::uint64_t time_us) {
    const bool is_new_tick = watch_.update(feed_override.heartbeat, time_us);
    health_.ticks = watch_.ticks(time_us);
    std::uint32_t levels = levels_ & pulse_line;
    if (is_new_tick && time_us >= pulse_us_ + settings_.pulse_half_period_us) {
        levels ^= pulse_line;
        pulse_us_ = time_us;
    }
    if (health_.ticks && !hal::demands_stop(feed_override)) {
        levels |= release_line;
    }
    put(levels, time_us);
}

void FeedHoldLine::poll(std::uint64_t time_us) {
    health_.ticks = watch_.ticks(time_us);
    put(health_.ticks ? levels_ : levels_ & ~release_line, time_us);
}

void FeedHoldLine::put(std::uint32_t levels, std::uint64_t time_us) {
    if (health_.is_ready) {
        if (levels == levels_) {
            return;
        }
        levels_ = levels;
        health_.is_ready = port_.set(levels);
    } else {
        levels_ = levels;
        if (time_us < next_try_us_) {
            return;
        }
        next_try_us_ = time_us + settings_.retry_us;
        health_.is_ready = port_.open(levels);
    }
    if (!health_.is_ready) {
        fail();
    }
}

void FeedHoldLine::fail() {
    health_.last_error = port_.last_error();
    health_.failures += health_.failures < UINT32_MAX ? 1U : 0U;
}

}  // namespace millforce::gpio
