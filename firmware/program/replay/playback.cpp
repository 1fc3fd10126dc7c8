// SPDX-License-Identifier: Apache-2.0
#include "replay/playback.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <thread>

namespace millforce::host {

void Playback::show(double time_s, TelemetrySample sample) {
    if (!is_watched()) {
        return;
    }
    wait_until_due(time_s);
    sample.monotonic_us = static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count());
    sample.tick.time_us = static_cast<std::uint64_t>(std::llround(1e6 * std::max(time_s, 0.0)));
    hub_->feed()->put(sample);
}

/// A log of several runs, whose time begins again, goes on at once.
void Playback::wait_until_due(double time_s) {
    if (!begin_ || time_s < last_s_) {
        begin_ = Clock::now();
        begin_s_ = time_s;
    }
    last_s_ = time_s;
    const std::chrono::duration<double> since((time_s - begin_s_) / speed_);
    const auto due = *begin_ + std::chrono::duration_cast<Clock::duration>(since);
    constexpr auto longest_sleep = std::chrono::milliseconds(50);
    while (!stop_.load() && Clock::now() < due) {
        std::this_thread::sleep_until(std::min(due, Clock::now() + longest_sleep));
    }
    if (stop_.load()) {
        throw PlaybackStopped();
    }
}

}  // namespace millforce::host
