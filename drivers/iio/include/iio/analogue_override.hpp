// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/override_output.hpp"
#include "hal/tick_watch.hpp"
#include "iio/attribute.hpp"
#include "iio/scan_layout.hpp"

namespace millforce::iio {

/// The override as a voltage, through a digital-to-analogue converter of Linux IIO (out_voltage0_raw):
///
///     V = zero_V + ratio · V_per_ratio,    raw = V / scale − offset
///
/// clamped to lowest_V…highest_V and lowest_raw…highest_raw. The output is safe_V from the start, on hold, on any
/// fault, when the ratio is not finite, when no ticks come, and after this object's end.
/// A converter keeps its last value when this program is killed or its processor stops: a voltage proves nothing.
/// A CNC that follows it must also watch a sign of life: the pulse of gpio::FeedHoldLine, or the CAN heartbeat.
/// Defaults of what machine.toml gives are the program's (parameters/local_io.hpp).
struct AnalogueOverrideSettings {
    Path device{};          ///< folder in sysfs
    ChannelName channel{};  ///< `voltage0`
    float V_per_ratio = 0.0F;
    float zero_V = 0.0F;
    float lowest_V = 0.0F;
    float highest_V = 0.0F;
    float safe_V = 0.0F;  ///< at which the CNC stops the feed; not clamped to the range
    std::int32_t lowest_raw = 0;
    std::int32_t highest_raw = 0;
    std::uint32_t tick_timeout_us = 20'000;
    std::uint32_t refresh_us =
        100'000;  ///< an unchanged value is written again after so long, a missing device looked for
};

class AnalogueOverride final : public hal::OverrideOutput {
  public:
    explicit AnalogueOverride(const AnalogueOverrideSettings& settings);
    ~AnalogueOverride();
    AnalogueOverride(const AnalogueOverride&) = delete;
    AnalogueOverride& operator=(const AnalogueOverride&) = delete;

    void update(const hal::FeedOverride& feed_override, std::uint64_t time_us) override;
    void poll(std::uint64_t time_us) override;
    [[nodiscard]] hal::OutputHealth health() const override { return health_; }
    [[nodiscard]] const Fault& fault() const { return fault_; }

  private:
    [[nodiscard]] bool prepare();
    [[nodiscard]] std::int64_t raw_of(float V) const;
    void put(float V, std::uint64_t time_us);
    void write(std::int64_t raw, std::uint64_t time_us);
    void fail(const Fault& fault);

    AnalogueOverrideSettings settings_;
    hal::TickWatch watch_;
    hal::OutputHealth health_{};
    Fault fault_{};
    Path raw_file_{};
    bool is_prepared_ = false;
    bool is_tried_ = false;
    float scale_V_ = 1.0F;
    float offset_ = 0.0F;
    std::int64_t written_raw_ = 0;
    std::uint64_t tried_us_ = 0;
};

}  // namespace millforce::iio
