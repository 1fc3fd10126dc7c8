// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/can_frame.hpp"
#include "hal/feed_override.hpp"
#include "hal/override_output.hpp"
#include "hal/tick_watch.hpp"
#include "override_frame/override_frame.hpp"

namespace millforce::override_frame {

/// The firmware's parameters have the defaults of what is 0 here (parameters.hpp).
struct OverrideSenderSettings {
    std::uint8_t node_id = 0;
    std::uint32_t id = 0;
    /// Between two frames; 0: one with every tick. A change of hold or fault goes out at once.
    std::uint32_t period_us = 0;
    std::uint32_t heartbeat_period_us = 0;  ///< between two heartbeats
    /// Without a tick for so long the heartbeat says `stopped`.
    std::uint32_t tick_timeout_us = hal::default_tick_timeout_us;
};

/// Whether a frame is the boot-up of this controller (CiA 301): its node's heartbeat with the state 0.
[[nodiscard]] bool is_boot_up(const hal::CanFrame& frame, std::uint8_t node_id);

/// The controller's side. update() with each tick's output, poll() at least every period, then fetch what is to be
/// sent, after both. If no ticks come it keeps sending with an unchanged counter: only the receiver can judge whether
/// that is too long. A frame that could not be sent is dropped; the next one is newer. One thread.
class OverrideSender final : public hal::OverrideOutput {
  public:
    explicit OverrideSender(const OverrideSenderSettings& settings) : settings_(settings) {}

    void update(const hal::FeedOverride& feed_override, std::uint64_t time_us) override;
    void poll(std::uint64_t time_us) override;
    /// Ready always: whether frames leave is the bus driver's to say.
    [[nodiscard]] hal::OutputHealth health() const override { return {true, ticks_, 0, 0}; }
    /// True once for each frame that is to be sent.
    [[nodiscard]] bool take_frame(hal::CanFrame& frame);
    /// The next heartbeat is the boot-up again.
    void boot_up_again() {
        booted_ = false;
        heartbeat_due_ = true;
    }

  private:
    [[nodiscard]] std::uint8_t nmt_state() const;

    OverrideSenderSettings settings_;
    hal::FeedOverride newest_{};
    bool has_override_ = false;
    bool ticks_ = false;
    bool booted_ = false;
    bool override_due_ = false;
    bool heartbeat_due_ = false;
    std::uint64_t tick_us_ = 0;
    std::uint64_t next_override_us_ = 0;
    std::uint64_t next_heartbeat_us_ = 0;
};

}  // namespace millforce::override_frame
