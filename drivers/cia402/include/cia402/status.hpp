// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hal/can_frame.hpp"

/// What a drive says about itself: the statusword 0x6041 (CiA 402, power drive state machine) and emergency objects
/// (CiA 301, EMCY).

namespace millforce::cia402 {

enum class PowerState : std::uint8_t {
    unknown,  ///< never received, or a pattern that the standard does not define
    not_ready_to_switch_on,
    switch_on_disabled,
    ready_to_switch_on,
    switched_on,
    operation_enabled,
    quick_stop_active,
    fault_reaction_active,
    fault,
};

[[nodiscard]] constexpr PowerState power_state(std::uint16_t statusword) {
    switch (statusword & 0x4FU) {
        case 0x00:
            return PowerState::not_ready_to_switch_on;
        case 0x40:
            return PowerState::switch_on_disabled;
        case 0x0F:
            return PowerState::fault_reaction_active;
        case 0x08:
            return PowerState::fault;
        default:
            break;
    }
    switch (statusword & 0x6FU) {
        case 0x21:
            return PowerState::ready_to_switch_on;
        case 0x23:
            return PowerState::switched_on;
        case 0x27:
            return PowerState::operation_enabled;
        case 0x07:
            return PowerState::quick_stop_active;
        default:
            return PowerState::unknown;
    }
}

[[nodiscard]] constexpr bool is_faulted(PowerState state) {
    return state == PowerState::fault || state == PowerState::fault_reaction_active;
}

/// The first byte of an emergency error code, CiA 301 table "Emergency error code classes".
enum class EmergencyClass : std::uint8_t {
    error_reset,  ///< 00xx: all errors are gone
    generic,
    current,
    voltage,
    temperature,
    device_hardware,
    device_software,
    additional_modules,
    monitoring,     ///< 80xx
    communication,  ///< 81xx
    protocol,       ///< 82xx: PDO length and the like
    external,
    additional_functions,
    device_specific,
    unknown,
};

[[nodiscard]] EmergencyClass emergency_class(std::uint16_t error_code);

/// An emergency object: 8 bytes, little endian.
struct Emergency {
    std::uint16_t error_code = 0;     ///< bytes 0, 1; 0x00xx: error reset
    std::uint8_t error_register = 0;  ///< byte 2, object 0x1001
    std::array<std::uint8_t, 5> manufacturer{};
};

/// False where the frame is not eight bytes long; then nothing is written.
[[nodiscard]] bool decode_emergency(const hal::CanFrame& frame, Emergency& emergency);

}  // namespace millforce::cia402
