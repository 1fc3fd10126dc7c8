// SPDX-License-Identifier: Apache-2.0
#include "stm32/can_controller.hpp"

namespace millforce::stm32 {

namespace {

// MCR, MSR
constexpr std::uint32_t setup_request = 1U << 0U;
constexpr std::uint32_t in_order_of_request = 1U << 2U;
constexpr std::uint32_t recovers_from_bus_off = 1U << 6U;
constexpr std::uint32_t setup_acknowledged = 1U << 0U;
// TSR
constexpr std::uint32_t abort_each = 1U << 7U | 1U << 15U | 1U << 23U;
constexpr std::uint32_t mailbox_empty = 1U << 26U;
// RF0R
constexpr std::uint32_t frames_waiting = 3U;
constexpr std::uint32_t queue_overrun = 1U << 4U;
constexpr std::uint32_t release_frame = 1U << 5U;
// ESR
constexpr std::uint32_t is_warning = 1U << 0U;
constexpr std::uint32_t is_passive = 1U << 1U;
constexpr std::uint32_t is_bus_off = 1U << 2U;
// mailboxes
constexpr std::uint32_t transmit_request = 1U << 0U;
constexpr std::uint32_t remote_frame = 1U << 1U;
constexpr std::uint32_t extended_id = 1U << 2U;
constexpr unsigned mailboxes = 3;

/// 42 MHz / (prescaler × 14 quanta)
std::uint32_t prescaler(CanBitRate rate) {
    constexpr std::uint8_t prescalers[] = {24, 12, 6, 3};
    return prescalers[static_cast<unsigned>(rate) & 3U];
}

/// 1 + 11 + 2 quanta, jumps of one.
std::uint32_t bit_timing(CanBitRate rate) {
    return (prescaler(rate) - 1U) | (11U - 1U) << 16U | (2U - 1U) << 20U;
}

/// One filter in the 16-bit mask mode: id and mask with RTR either way and IDE 0. RM0090 figure 388
std::uint32_t filter_word(const hal::CanFilter& filter) {
    constexpr std::uint32_t must_be_standard = 1U << 3U;
    const std::uint32_t id = (filter.id & hal::largest_standard_can_id) << 5U;
    const std::uint32_t mask = (filter.mask & hal::largest_standard_can_id) << 5U | must_be_standard;
    return mask << 16U | id;
}

std::uint32_t word_of(const hal::CanFrame& frame, std::size_t first) {
    std::uint32_t word = 0;
    for (unsigned k = 0; k < 4U; ++k) {
        word |= static_cast<std::uint32_t>(frame.data[first + k]) << (8U * k);
    }
    return word;
}

void take_word(hal::CanFrame& frame, std::size_t first, std::uint32_t word) {
    for (unsigned k = 0; k < 4U; ++k) {
        const bool is_data = !frame.remote && first + k < frame.length;
        frame.data[first + k] = is_data ? static_cast<std::uint8_t>(word >> (8U * k)) : std::uint8_t{0};
    }
}

void count(std::uint32_t& counter) {
    counter += counter < UINT32_MAX ? 1U : 0U;
}

}  // namespace

void CanController::start(CanBitRate rate, std::span<const hal::CanFilter> filters) {
    rate_ = rate;
    filters_ = filters;
    polls_ = 0;
    state_ = CanState::entering_setup;
    registers_.mcr = setup_request;  // and out of sleep
}

void CanController::poll(std::uint32_t patience) {
    if (state_ >= CanState::running) {
        watch_errors();
        return;
    }
    if (state_ == CanState::absent) {
        return;
    }
    const bool in_setup = has_bits(registers_.msr, setup_acknowledged);
    if (state_ == CanState::entering_setup && in_setup) {
        set_up();
    } else if (state_ == CanState::joining && !in_setup) {
        state_ = CanState::running;
        watch_errors();
    } else if (state_ == CanState::entering_setup && ++polls_ >= patience) {
        // A bus that is stuck dominant keeps a controller `joining`. Only a setup that is not acknowledged means that
        // there is no controller.
        state_ = CanState::absent;
    }
}

void CanController::set_up() {
    registers_.btr = bit_timing(rate_);
    write_filters();
    registers_.ier = 0;
    registers_.mcr = in_order_of_request | recovers_from_bus_off;
    state_ = CanState::joining;
}

void CanController::write_filters() {
    constexpr std::uint32_t filter_setup = 1U << 0U;
    const bool passes_all = filters_.empty() || filters_.size() > filter_capacity;
    const std::size_t banks = passes_all ? 1 : (filters_.size() + 1U) / 2U;
    const std::uint32_t bank_bits = (1U << banks) - 1U;
    set_bits(registers_.fmr, filter_setup);
    registers_.fa1r = 0;
    registers_.fm1r = 0;                           // masks
    registers_.fs1r = passes_all ? bank_bits : 0;  // 16 bits, but for the one that passes all
    registers_.ffa1r = 0;                          // queue 0
    for (std::size_t bank = 0; bank < banks; ++bank) {
        const std::size_t second = 2U * bank + 1U < filters_.size() ? 2U * bank + 1U : 2U * bank;
        registers_.filter[bank].r1 = passes_all ? 0U : filter_word(filters_[2U * bank]);
        registers_.filter[bank].r2 = passes_all ? 0U : filter_word(filters_[second]);
    }
    registers_.fa1r = bank_bits;
    clear_bits(registers_.fmr, filter_setup);
}

CanState CanController::error_state() const {
    const std::uint32_t errors = registers_.esr;
    if ((errors & is_bus_off) != 0) {
        return CanState::bus_off;
    }
    if ((errors & is_passive) != 0) {
        return CanState::error_passive;
    }
    return (errors & is_warning) != 0 ? CanState::error_warning : CanState::running;
}

void CanController::watch_errors() {
    const std::uint32_t errors = registers_.esr;
    health_.last_error = static_cast<std::uint8_t>(errors >> 4U & 7U);
    health_.transmit_errors = static_cast<std::uint8_t>(errors >> 16U);
    health_.receive_errors = static_cast<std::uint8_t>(errors >> 24U);
    const CanState now = error_state();
    if (now == CanState::bus_off && state_ != CanState::bus_off) {
        count(health_.bus_offs);
        abort_all();  // what is old by then must not be sent when the bus is back
    }
    state_ = now;
    if (has_bits(registers_.rf0r, queue_overrun)) {
        count(health_.overruns);
        registers_.rf0r = queue_overrun;  // cleared by a one; a zero at the release bit has no effect
    }
}

bool CanController::is_free(unsigned mailbox) const {
    return has_bits(registers_.tsr, mailbox_empty << mailbox) &&
           !has_bits(registers_.transmit[mailbox].identifier, transmit_request);
}

bool CanController::send(const hal::CanFrame& frame) {
    for (unsigned mailbox = 0; mailbox < mailboxes; ++mailbox) {
        if (!is_on_bus() || !is_free(mailbox)) {
            continue;
        }
        const std::uint32_t length = frame.length > hal::largest_can_length ? hal::largest_can_length : frame.length;
        const std::uint32_t identifier =
            (frame.extended ? frame.id << 3U | extended_id : (frame.id & hal::largest_standard_can_id) << 21U) |
            (frame.remote ? remote_frame : 0U);
        CanMailboxRegisters& box = registers_.transmit[mailbox];
        box.length = length;
        box.low = word_of(frame, 0);
        box.high = word_of(frame, 4);
        box.identifier = identifier | transmit_request;
        return true;
    }
    count(health_.unsent);
    return false;
}

bool CanController::receive(hal::CanFrame& frame) {
    // After a release the queue needs a moment to show the next frame.
    if (state_ < CanState::running || (registers_.rf0r & frames_waiting) == 0 ||
        has_bits(registers_.rf0r, release_frame)) {
        return false;
    }
    const CanMailboxRegisters& box = registers_.receive[0];
    const std::uint32_t identifier = box.identifier;
    const std::uint32_t length = box.length & 0xFU;
    frame = {};
    frame.extended = (identifier & extended_id) != 0;
    frame.remote = (identifier & remote_frame) != 0;
    frame.id = frame.extended ? identifier >> 3U : identifier >> 21U;
    frame.length = static_cast<std::uint8_t>(length > hal::largest_can_length ? hal::largest_can_length : length);
    take_word(frame, 0, box.low);
    take_word(frame, 4, box.high);
    registers_.rf0r = release_frame;
    return true;
}

bool CanController::is_all_sent() const {
    return is_free(0) && is_free(1) && is_free(2);
}

bool CanController::has_room() const {
    return is_on_bus() && (is_free(0) || is_free(1) || is_free(2));
}

void CanController::leave_bus() {
    registers_.mcr = setup_request;
    state_ = CanState::absent;
}

void CanController::abort_all() {
    registers_.tsr = abort_each;
}

}  // namespace millforce::stm32
