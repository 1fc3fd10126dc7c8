// SPDX-License-Identifier: Apache-2.0
#include "cia402/sdo_client.hpp"

#include "cia402/objects.hpp"

namespace millforce::cia402 {

namespace {

constexpr std::uint8_t command_read = 0x40;
constexpr std::uint8_t command_write_expedited = 0x23;  // size indicated; unused bytes in bits 2, 3
constexpr std::uint8_t command_abort = 0x80;
constexpr std::uint8_t answer_written = 0x60;

void put_value(hal::CanFrame& frame, std::uint32_t value) {
    for (std::size_t k = 0; k < 4; ++k) {
        frame.data[4 + k] = static_cast<std::uint8_t>(value >> (8U * k));
    }
}

std::uint32_t value_of(const hal::CanFrame& frame) {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;) {
        value = (value << 8U) | frame.data[4 + k];
    }
    return value;
}

}  // namespace

void SdoClient::ask(const SdoRequest& request, std::uint64_t time_us) {
    request_ = request;
    state_ = SdoState::pending;
    sends_left_ = repetitions;
    to_send_ = true;
    deadline_us_ = time_us + answer_timeout_us;
}

void SdoClient::poll(std::uint64_t time_us) {
    if (state_ != SdoState::pending || time_us < deadline_us_) {
        return;
    }
    if (sends_left_ == 0) {
        state_ = SdoState::silent;
        return;
    }
    --sends_left_;
    to_send_ = true;
    deadline_us_ = time_us + answer_timeout_us;
}

bool SdoClient::take_frame(hal::CanFrame& frame) {
    if (!to_send_ && !abort_to_send_) {
        return false;
    }
    frame = {};
    frame.id = cob_id::sdo_request + node_id_;
    frame.length = 8;
    frame.data[1] = static_cast<std::uint8_t>(request_.index);
    frame.data[2] = static_cast<std::uint8_t>(request_.index >> 8U);
    frame.data[3] = request_.subindex;
    if (abort_to_send_) {
        abort_to_send_ = false;
        frame.data[0] = command_abort;
        put_value(frame, abort_command_unknown);
        return true;
    }
    to_send_ = false;
    frame.data[0] = command_read;
    if (request_.bytes != 0) {
        frame.data[0] = static_cast<std::uint8_t>(command_write_expedited | ((4U - request_.bytes) << 2U));
        put_value(frame, request_.value);
    }
    return true;
}

bool SdoClient::is_about_request(const hal::CanFrame& frame) const {
    return frame.data[1] == (request_.index & 0xFFU) && frame.data[2] == (request_.index >> 8U) &&
           frame.data[3] == request_.subindex;
}

void SdoClient::on_frame(const hal::CanFrame& frame, RejectCounters& rejects) {
    if (frame.length != 8) {
        rejects.add(Reject::sdo_malformed);
        return;
    }
    if (state_ != SdoState::pending || !is_about_request(frame)) {
        rejects.add(Reject::sdo_unexpected);
        return;
    }
    const bool is_write = request_.bytes != 0;
    if (frame.data[0] == command_abort) {
        abort_code_ = value_of(frame);
        state_ = SdoState::aborted;
    } else if (is_write && frame.data[0] == answer_written) {
        state_ = SdoState::done;
    } else if (!is_write && (frame.data[0] & 0xE0U) == 0x40U) {
        take_upload(frame, rejects);
    } else {
        rejects.add(Reject::sdo_malformed);
    }
}

void SdoClient::take_upload(const hal::CanFrame& frame, RejectCounters& rejects) {
    const bool expedited = (frame.data[0] & 0x02U) != 0;
    if (!expedited) {
        rejects.add(Reject::sdo_malformed);
        abort_code_ = abort_command_unknown;
        abort_to_send_ = true;
        state_ = SdoState::aborted;
        return;
    }
    const bool size_indicated = (frame.data[0] & 0x01U) != 0;
    const unsigned bytes = size_indicated ? 4U - ((frame.data[0] >> 2U) & 0x03U) : 4U;
    value_ = value_of(frame);
    if (bytes < 4) {
        value_ &= (1U << (8U * bytes)) - 1U;
    }
    state_ = SdoState::done;
}

}  // namespace millforce::cia402
