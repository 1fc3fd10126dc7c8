// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>

#include "telemetry/telemetry_hub.hpp"

namespace millforce::host {

/// Thrown where a playback is stopped before its end.
struct PlaybackStopped {};

/// Shows a replay to who watches, at the pace of its recording; to nobody, as fast as it can.
class Playback {
  public:
    /// `speed`: times that of the recording. `stop` ends it.
    Playback(std::unique_ptr<TelemetryHub> hub, double speed, const std::atomic<bool>& stop)
        : hub_(std::move(hub)), speed_(speed), stop_(stop) {}

    [[nodiscard]] bool is_watched() const { return hub_->feed() != nullptr; }
    /// With each tick; waits until it is due. `sample`'s times are not used. Throws PlaybackStopped.
    void show(double time_s, TelemetrySample sample);
    /// The watchers end.
    void finish() { hub_->finish(); }

  private:
    using Clock = std::chrono::steady_clock;

    void wait_until_due(double time_s);

    std::unique_ptr<TelemetryHub> hub_;
    double speed_;
    const std::atomic<bool>& stop_;
    std::optional<Clock::time_point> begin_{};
    double begin_s_ = 0.0;
    double last_s_ = 0.0;
};

}  // namespace millforce::host
