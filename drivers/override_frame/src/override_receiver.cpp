// SPDX-License-Identifier: Apache-2.0
#include "override_frame/override_receiver.hpp"

#include "hal/cia301.hpp"

namespace millforce::override_frame {

namespace cob_id = hal::cia301::cob_id;
using hal::cia301::NmtState;

void OverrideReceiver::reject(ReceiveError error) {
    std::uint32_t& count = errors_[static_cast<std::size_t>(error)];
    count += count < UINT32_MAX ? 1U : 0U;
}

void OverrideReceiver::on_frame(const hal::CanFrame& frame, std::uint64_t time_us) {
    if (frame.id == cob_id::heartbeat + settings_.node_id && !frame.extended && !frame.remote) {
        on_heartbeat(frame);
        return;
    }
    hal::FeedOverride received;
    switch (decode(frame, settings_.id, received)) {
        case FrameError::none:
            on_override(received, time_us);
            break;
        case FrameError::not_this_frame:
            break;
        case FrameError::length:
            reject(ReceiveError::length);
            break;
        case FrameError::checksum:
            reject(ReceiveError::checksum);
            break;
        case FrameError::reserved_bits:
            reject(ReceiveError::reserved_bits);
            break;
    }
}

void OverrideReceiver::on_heartbeat(const hal::CanFrame& frame) {
    if (frame.length != 1) {
        reject(ReceiveError::heartbeat_malformed);
        return;
    }
    if (frame.data[0] != byte_of(NmtState::operational)) {
        trusted_frames_ = 0;
    }
}

void OverrideReceiver::on_override(const hal::FeedOverride& received, std::uint64_t time_us) {
    if (!(received.ratio <= settings_.largest_ratio)) {
        reject(ReceiveError::ratio_range);
        return;
    }
    const auto counter = static_cast<std::uint16_t>(received.heartbeat);
    const auto step = static_cast<std::uint16_t>(counter - counter_);
    if (has_counter_ && step == 0) {
        reject(ReceiveError::counter_repeated);
        return;
    }
    const bool is_in_sequence = has_counter_ && step <= settings_.largest_counter_step;
    if (has_counter_ && !is_in_sequence) {
        reject(ReceiveError::counter_jump);
    }
    const bool was_silent = time_us > fresh_us_ + settings_.timeout_us;
    if (!is_in_sequence || was_silent) {
        trusted_frames_ = 0;
    }
    has_counter_ = true;
    counter_ = counter;
    fresh_us_ = time_us;
    newest_ = received;
    trusted_frames_ =
        static_cast<std::uint8_t>(trusted_frames_ < settings_.frames_to_trust ? trusted_frames_ + 1 : trusted_frames_);
}

ReceivedOverride OverrideReceiver::current(std::uint64_t now_us) const {
    const bool is_fresh = has_counter_ && now_us <= fresh_us_ + settings_.timeout_us;
    if (!is_fresh || trusted_frames_ < settings_.frames_to_trust) {
        return {settings_.fallback_ratio, settings_.fallback_hold, false, 0, 0};
    }
    return {newest_.ratio, newest_.hold, true, newest_.state, newest_.fault};
}

}  // namespace millforce::override_frame
