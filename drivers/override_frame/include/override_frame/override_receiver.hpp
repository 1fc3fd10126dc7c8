// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/can_frame.hpp"
#include "hal/tick_watch.hpp"
#include "override_frame/override_frame.hpp"

namespace millforce::override_frame {

struct OverrideReceiverSettings {
    std::uint8_t node_id = default_node_id;
    std::uint32_t id = default_id;
    /// Without a fresh counter for so long the controller is dead.
    std::uint32_t timeout_us = hal::default_tick_timeout_us;
    std::uint16_t largest_counter_step = 50;  ///< ticks between two frames, lost frames included
    std::uint8_t frames_to_trust = 3;         ///< fresh frames in sequence before the override is used (again)
    float largest_ratio = 2.0F;               ///< beyond it the frame is rejected
    float fallback_ratio = 0.0F;              ///< override while the controller is dead
    bool fallback_hold = true;                ///< whether the feed stops while the controller is dead
};

enum class ReceiveError : std::uint8_t {
    length,
    checksum,
    reserved_bits,
    ratio_range,
    counter_repeated,  ///< the tick has stopped, or a frame was duplicated
    counter_jump,      ///< backwards or too far: frames out of order, or a restarted controller
    heartbeat_malformed,
};
inline constexpr std::size_t receive_errors = static_cast<std::size_t>(ReceiveError::heartbeat_malformed) + 1;

/// What the CNC may act on.
struct ReceivedOverride {
    float ratio = 0.0F;
    bool hold = true;
    bool is_alive = false;  ///< false: ratio and hold are the fallback
    std::uint8_t state = 0;
    std::uint8_t fault = 0;
};

/// The CNC's side, a pure state machine: frames and times in, an override out, the fallback whenever the frames are not
/// trusted. A heartbeat other than `operational` ends the trust at once; that heartbeats stay away does not, the
/// counter is the better witness. One thread.
class OverrideReceiver {
  public:
    explicit OverrideReceiver(const OverrideReceiverSettings& settings) : settings_(settings) {}

    void on_frame(const hal::CanFrame& frame, std::uint64_t time_us);
    [[nodiscard]] ReceivedOverride current(std::uint64_t now_us) const;
    [[nodiscard]] std::uint32_t errors(ReceiveError error) const { return errors_[static_cast<std::size_t>(error)]; }

  private:
    void on_heartbeat(const hal::CanFrame& frame);
    void on_override(const hal::FeedOverride& received, std::uint64_t time_us);
    void reject(ReceiveError error);

    OverrideReceiverSettings settings_;
    hal::FeedOverride newest_{};
    bool has_counter_ = false;
    std::uint16_t counter_ = 0;
    std::uint8_t trusted_frames_ = 0;
    std::uint64_t fresh_us_ = 0;
    std::array<std::uint32_t, receive_errors> errors_{};
};

}  // namespace millforce::override_frame
