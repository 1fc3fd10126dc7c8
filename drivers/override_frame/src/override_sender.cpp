// SPDX-License-Identifier: Apache-2.0
#include "override_frame/override_sender.hpp"

#include "hal/cia301.hpp"

namespace millforce::override_frame {

namespace cob_id = hal::cia301::cob_id;
using hal::cia301::NmtState;

bool is_boot_up(const hal::CanFrame& frame, std::uint8_t node_id) {
    return frame.id == cob_id::heartbeat + node_id && !frame.extended && !frame.remote && frame.length == 1 &&
           frame.data[0] == byte_of(NmtState::boot_up);
}

void OverrideSender::update(const hal::FeedOverride& feed_override, std::uint64_t time_us) {
    const bool is_urgent = !has_override_ || feed_override.hold != newest_.hold || feed_override.fault != newest_.fault;
    const bool is_new_tick = !has_override_ || feed_override.heartbeat != newest_.heartbeat;
    newest_ = feed_override;
    has_override_ = true;
    override_due_ = override_due_ || is_urgent || (is_new_tick && settings_.period_us == 0);
    if (is_new_tick) {
        tick_us_ = time_us;
        ticks_ = true;
    }
}

void OverrideSender::poll(std::uint64_t time_us) {
    const bool ticks = has_override_ && time_us <= tick_us_ + settings_.tick_timeout_us;
    heartbeat_due_ = heartbeat_due_ || ticks != ticks_ || time_us >= next_heartbeat_us_;
    ticks_ = ticks;
    if (time_us >= next_heartbeat_us_) {
        next_heartbeat_us_ = time_us + settings_.heartbeat_period_us;
    }
    if (has_override_ && settings_.period_us != 0 && time_us >= next_override_us_) {
        override_due_ = true;
        // In step with the clock where poll() comes in time, else from now on: no burst.
        const std::uint64_t in_step_us = next_override_us_ + settings_.period_us;
        next_override_us_ = in_step_us > time_us ? in_step_us : time_us + settings_.period_us;
    }
}

std::uint8_t OverrideSender::nmt_state() const {
    if (!has_override_) {
        return byte_of(NmtState::pre_operational);
    }
    return ticks_ ? byte_of(NmtState::operational) : byte_of(NmtState::stopped);
}

bool OverrideSender::take_frame(hal::CanFrame& frame) {
    if (override_due_) {
        override_due_ = false;
        frame = encode(newest_, settings_.id);
        return true;
    }
    if (!heartbeat_due_) {
        return false;
    }
    heartbeat_due_ = !booted_;  // the boot-up is followed by the state
    frame = {};
    frame.id = cob_id::heartbeat + settings_.node_id;
    frame.length = 1;
    frame.data[0] = booted_ ? nmt_state() : byte_of(NmtState::boot_up);
    booted_ = true;
    return true;
}

}  // namespace millforce::override_frame
