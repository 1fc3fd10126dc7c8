// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

/// What a CAN controller reports through SocketCAN error frames (linux/can/error.h).

namespace millforce::socketcan {

/// Fault confinement of ISO 11898-1.
enum class ControllerState : std::uint8_t {
    error_active,   ///< usual
    error_warning,  ///< an error counter reached 96
    error_passive,  ///< an error counter reached 128: the controller may not signal errors any more
    bus_off,        ///< the transmit error counter passed 255: the controller left the bus
};

struct ErrorReport {
    bool has_state = false;
    ControllerState state = ControllerState::error_active;
    bool restarted = false;         ///< after bus-off
    bool receive_overflow = false;  ///< the controller lost frames
    bool transmit_overflow = false;
    bool not_acknowledged = false;  ///< no other node is on the bus
    bool transmit_timeout = false;
    bool arbitration_lost = false;
    bool protocol_violation = false;  ///< bit, stuff, form or CRC error
    bool transceiver_fault = false;   ///< CANH or CANL
};

/// `id` as the kernel gives it, with or without its flags; missing bytes count as 0.
[[nodiscard]] ErrorReport decode_error_frame(std::uint32_t id, std::span<const std::uint8_t> data);

}  // namespace millforce::socketcan
