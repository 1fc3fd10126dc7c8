// SPDX-License-Identifier: Apache-2.0
#include "program_status/program_status_receiver.hpp"

namespace millforce::program_status {

namespace {
constexpr std::uint16_t half_of_the_counter = 0x8000;
}

bool ProgramStatusReceiver::reject(ReceiveError error) {
    std::uint32_t& count = errors_[static_cast<std::size_t>(error)];
    count += count < UINT32_MAX ? 1U : 0U;
    return false;
}

bool ProgramStatusReceiver::on_frame(const hal::CanFrame& frame, std::uint64_t time_us) {
    ProgramStatusFrame status;
    switch (settings_.id == 0 ? FrameError::not_this_frame : decode(frame, settings_.id, status)) {
        case FrameError::none:
            break;
        case FrameError::not_this_frame:
            return false;
        case FrameError::length:
            return reject(ReceiveError::length);
        case FrameError::checksum:
            return reject(ReceiveError::checksum);
        case FrameError::reserved_bits:
            return reject(ReceiveError::reserved_bits);
    }
    const auto step = static_cast<std::uint16_t>(status.counter - newest_.counter);
    if (source(time_us) == ProgramSource::fresh && step == 0) {
        return reject(ReceiveError::counter_repeated);
    }
    // After a silence the CNC may have restarted.
    if (source(time_us) == ProgramSource::fresh && step >= half_of_the_counter) {
        return reject(ReceiveError::counter_backwards);
    }
    reset_asked_ = reset_asked_ || (status.reset_fault && was_heard_ && !newest_.reset_fault);
    newest_ = status;
    was_heard_ = true;
    fresh_us_ = time_us;
    return true;
}

ProgramSource ProgramStatusReceiver::source(std::uint64_t now_us) const {
    if (!was_heard_) {
        return ProgramSource::never_heard;
    }
    return now_us <= fresh_us_ + settings_.timeout_us ? ProgramSource::fresh : ProgramSource::silent;
}

hal::ProgramStatus ProgramStatusReceiver::program(std::uint64_t now_us) const {
    hal::ProgramStatus program = newest_.program;
    program.feed_hold = program.feed_hold || source(now_us) == ProgramSource::silent;
    return program;
}

bool ProgramStatusReceiver::take_reset() {
    const bool asked = reset_asked_;
    reset_asked_ = false;
    return asked;
}

}  // namespace millforce::program_status
