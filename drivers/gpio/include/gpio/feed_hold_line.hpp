// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gpio/line_port.hpp"
#include "hal/override_output.hpp"
#include "hal/tick_watch.hpp"

namespace millforce::gpio {

/// Feed release and proof of life on two lines of a port:
///
/// | line | level |
/// |---|---|
/// | 0, release | 1: the feed may run; 0: hold, any fault, no override yet, no ticks |
/// | 1, pulse | changes every `pulse_half_period_us` while ticks come, hold or not; constant otherwise |
///
/// The release alone is not a safe stop: when this program is killed, most GPIO chips keep the levels of their lines.
/// The pulse makes it safe: a watchdog relay or charge pump on it drops within its own time (e.g. three half-periods,
/// 15 ms) whatever died, program, kernel or processor, at either level. Put its contact in series with the release;
/// wire the release so that a broken wire is a hold.
struct FeedHoldSettings {
    std::uint32_t tick_timeout_us = hal::default_tick_timeout_us;
    std::uint32_t pulse_half_period_us = 5'000;  ///< rounded to steps of the tick's period
    std::uint32_t retry_us = 100'000;            ///< between tries to take the lines
};

class FeedHoldLine final : public hal::OverrideOutput {
  public:
    static constexpr std::uint32_t release_line = 1U << 0U;
    static constexpr std::uint32_t pulse_line = 1U << 1U;

    /// `port` outlives this object.
    FeedHoldLine(const FeedHoldSettings& settings, LinePort& port)
        : settings_(settings), watch_(settings.tick_timeout_us), port_(port) {}
    ~FeedHoldLine();
    FeedHoldLine(const FeedHoldLine&) = delete;
    FeedHoldLine& operator=(const FeedHoldLine&) = delete;

    void update(const hal::FeedOverride& feed_override, std::uint64_t time_us) override;
    void poll(std::uint64_t time_us) override;
    [[nodiscard]] hal::OutputHealth health() const override { return health_; }

  private:
    void put(std::uint32_t levels, std::uint64_t time_us);
    void fail();

    FeedHoldSettings settings_;
    hal::TickWatch watch_;
    LinePort& port_;
    hal::OutputHealth health_{};
    std::uint32_t levels_ = 0;
    std::uint64_t pulse_us_ = 0;
    std::uint64_t next_try_us_ = 0;
};

}  // namespace millforce::gpio
