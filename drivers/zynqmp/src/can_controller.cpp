// SPDX-License-Identifier: Apache-2.0
#include "zynqmp/can_controller.hpp"

namespace millforce::zynqmp {

namespace {

// SRR
constexpr std::uint32_t reset_controller = 1U << 0U;
constexpr std::uint32_t enable_controller = 1U << 1U;
// SR
constexpr std::uint32_t in_setup = 1U << 0U;
constexpr std::uint32_t is_normal = 1U << 3U;
constexpr std::uint32_t is_warning = 1U << 6U;
constexpr std::uint32_t is_passive = 3U << 7U;
constexpr std::uint32_t transmit_full = 1U << 10U;
// ISR, ICR
constexpr std::uint32_t receive_overflow = 1U << 6U;
constexpr std::uint32_t frame_waits = 1U << 7U;
constexpr std::uint32_t went_bus_off = 1U << 9U;
constexpr std::uint32_t all_events = 0x7FFFU;
// frames
constexpr std::uint32_t standard_remote = 1U << 20U;
constexpr std::uint32_t extended_id = 1U << 19U;
constexpr std::uint32_t extended_remote = 1U << 0U;
constexpr unsigned extended_low_bits = 18;

bool has_bits(std::uint32_t value, std::uint32_t bits) {
    return (value & bits) == bits;
}

/// The upper 11 bits of an extended id are in the place of a standard id; SRR is then recessive.
std::uint32_t identifier_word(const hal::CanFrame& frame) {
    if (!frame.extended) {
        return (frame.id & hal::largest_standard_can_id) << 21U | (frame.remote ? standard_remote : 0U);
    }
    const std::uint32_t high = frame.id >> extended_low_bits & hal::largest_standard_can_id;
    const std::uint32_t low = frame.id & ((1U << extended_low_bits) - 1U);
    return high << 21U | standard_remote | extended_id | low << 1U | (frame.remote ? extended_remote : 0U);
}

void take_identifier(hal::CanFrame& frame, std::uint32_t word) {
    frame.extended = has_bits(word, extended_id);
    frame.remote = has_bits(word, frame.extended ? extended_remote : standard_remote);
    const std::uint32_t low = word >> 1U & ((1U << extended_low_bits) - 1U);
    frame.id = frame.extended ? (word >> 21U) << extended_low_bits | low : word >> 21U;
}

/// Byte 0 is the most significant.
std::uint32_t word_of(const hal::CanFrame& frame, std::size_t first) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 4U; ++k) {
        word = word << 8U | frame.data[first + k];
    }
    return word;
}

void take_word(hal::CanFrame& frame, std::size_t first, std::uint32_t word) {
    for (unsigned k = 0; k < 4U; ++k) {
        const bool is_data = !frame.remote && first + k < frame.length;
        frame.data[first + k] = is_data ? static_cast<std::uint8_t>(word >> (24U - 8U * k)) : std::uint8_t{0};
    }
}

void count(std::uint32_t& counter) {
    counter += counter < UINT32_MAX ? 1U : 0U;
}

std::uint32_t bit_timing(const CanBitTiming& timing) {
    return (timing.largest_jump - 1U) << 7U | (timing.second_segment - 1U) << 4U | (timing.first_segment - 1U);
}

}  // namespace

void CanController::start(const CanBitTiming& timing) {
    registers_.srr = reset_controller;
    if (!has_bits(registers_.sr, in_setup)) {
        state_ = CanState::absent;
        return;
    }
    registers_.msr = 0;  // neither asleep, nor looped back, nor listening only
    registers_.brpr = timing.prescaler - 1U;
    registers_.btr = bit_timing(timing);
    registers_.ier = 0;
    registers_.afr = 0;  // no filter: all frames pass
    registers_.icr = all_events;
    registers_.srr = enable_controller;
    state_ = CanState::joining;
}

void CanController::poll() {
    if (state_ == CanState::joining && has_bits(registers_.sr, is_normal)) {
        state_ = CanState::running;
    }
    if (is_on_bus()) {
        watch_errors();
    }
}

CanState CanController::error_state() const {
    const std::uint32_t status = registers_.sr;
    if (has_bits(status, is_passive)) {
        return CanState::error_passive;
    }
    return has_bits(status, is_warning) ? CanState::error_warning : CanState::running;
}

void CanController::watch_errors() {
    const std::uint32_t events = registers_.isr;
    const std::uint32_t counters = registers_.ecr;
    health_.transmit_errors = static_cast<std::uint8_t>(counters);
    health_.receive_errors = static_cast<std::uint8_t>(counters >> 8U);
    if (const std::uint32_t errors = registers_.esr; errors != 0) {
        health_.last_errors = static_cast<std::uint8_t>(errors);
        registers_.esr = errors;  // cleared by ones
    }
    if (has_bits(events, receive_overflow)) {
        count(health_.overruns);
        registers_.icr = receive_overflow;
    }
    if (has_bits(events, went_bus_off)) {
        count(health_.bus_offs);
        registers_.srr = reset_controller;  // what is old by then must not be sent when the bus is back
        state_ = CanState::bus_off;
        return;
    }
    state_ = error_state();
}

bool CanController::has_room() const {
    return is_on_bus() && !has_bits(registers_.sr, transmit_full);
}

bool CanController::send(const hal::CanFrame& frame) {
    if (!has_room()) {
        count(health_.unsent);
        return false;
    }
    const std::uint32_t length = frame.length > hal::largest_can_length ? hal::largest_can_length : frame.length;
    registers_.transmit.identifier = identifier_word(frame);
    registers_.transmit.length = length << 28U;
    registers_.transmit.data1 = word_of(frame, 0);
    registers_.transmit.data2 = word_of(frame, 4);  // the last of the four queues the frame
    return true;
}

bool CanController::receive(hal::CanFrame& frame) {
    if (!is_on_bus() || !has_bits(registers_.isr, frame_waits)) {
        return false;
    }
    frame = {};
    take_identifier(frame, registers_.receive.identifier);
    const std::uint32_t length = registers_.receive.length >> 28U;
    frame.length = static_cast<std::uint8_t>(length > hal::largest_can_length ? hal::largest_can_length : length);
    const std::uint32_t data1 = registers_.receive.data1;
    const std::uint32_t data2 = registers_.receive.data2;  // all four are read, or the queue does not go on
    take_word(frame, 0, data1);
    take_word(frame, 4, data2);
    registers_.icr = frame_waits;  // comes back at once where another frame waits
    return true;
}

}  // namespace millforce::zynqmp
