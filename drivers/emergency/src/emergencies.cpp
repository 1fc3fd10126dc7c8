// SPDX-License-Identifier: Apache-2.0
#include "emergency/emergencies.hpp"

namespace millforce::emergency {

std::uint16_t error_code(Reason reason) {
    constexpr std::array<std::uint16_t, reason_count> codes{
        0x0000,  // no error
        0x6100,  // internal software
        0x6300,  // data set
        0x3200,  // voltage inside the device
        0x5000,  // device hardware
        0xFF00,  // device-specific
        0x8140,  // recovered from bus-off
        0xFF01,  // device-specific
    };
    return codes[static_cast<std::size_t>(reason)];
}

void Emergencies::set(Reason reason, bool is_there, std::uint32_t detail) {
    if (is_there == has(reason)) {
        return;
    }
    there_ ^= bit(reason);
    report(reason, is_there ? error_code(reason) : std::uint16_t{0}, detail);
}

void Emergencies::follow(Reason reason, bool is_there, std::uint32_t detail) {
    if (is_there && has(reason) && detail != entries_[static_cast<std::size_t>(reason)].detail) {
        report(reason, error_code(reason), detail);
    }
    set(reason, is_there, detail);
}

void Emergencies::report(Reason reason, std::uint16_t code, std::uint32_t detail) {
    entries_[static_cast<std::size_t>(reason)] = {code, detail};
    unreported_ |= bit(reason);
}

void Emergencies::report_start(hal::ResetCause cause) {
    constexpr std::uint16_t watchdog_reset = 0x6010;
    constexpr std::uint16_t generic_error = 0x1000;
    std::uint16_t code = 0;
    if (cause == hal::ResetCause::watchdog) {
        code = watchdog_reset;
    } else if (cause == hal::ResetCause::brown_out) {
        code = error_code(Reason::supply_low);
    } else if (cause == hal::ResetCause::unknown) {
        code = generic_error;
    }
    report(Reason::started, code, static_cast<std::uint32_t>(cause));
}

bool Emergencies::take_frame(hal::CanFrame& frame) {
    for (std::size_t k = 0; k < reason_count; ++k) {
        const auto reason = static_cast<Reason>(k);
        if ((unreported_ & bit(reason)) != 0) {
            unreported_ &= ~bit(reason);
            frame = frame_of(reason, entries_[k].code, entries_[k].detail);
            return true;
        }
    }
    return false;
}

hal::CanFrame Emergencies::frame_of(Reason reason, std::uint16_t code, std::uint32_t detail) const {
    constexpr std::uint32_t emergency_id = 0x80;
    hal::CanFrame frame;
    frame.id = emergency_id + node_id_;
    frame.length = hal::largest_can_length;
    frame.data[0] = static_cast<std::uint8_t>(code);
    frame.data[1] = static_cast<std::uint8_t>(code >> 8U);
    frame.data[2] = there_ != 0 || code != 0 ? 1U : 0U;
    frame.data[3] = static_cast<std::uint8_t>(reason);
    for (unsigned k = 0; k < 4U; ++k) {
        frame.data[4U + k] = static_cast<std::uint8_t>(detail >> (8U * k));
    }
    return frame;
}

}  // namespace millforce::emergency
