// SPDX-License-Identifier: Apache-2.0
#include "socketcan/error_frame.hpp"

#include <linux/can/error.h>

namespace millforce::socketcan {

namespace {

void take_controller_byte(std::uint8_t bits, ErrorReport& report) {
    report.receive_overflow = (bits & CAN_ERR_CRTL_RX_OVERFLOW) != 0;
    report.transmit_overflow = (bits & CAN_ERR_CRTL_TX_OVERFLOW) != 0;
    const auto take = [&](unsigned mask, ControllerState state) {
        if ((bits & mask) != 0) {
            report.has_state = true;
            report.state = state;
        }
    };
    take(CAN_ERR_CRTL_ACTIVE, ControllerState::error_active);
    take(CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING, ControllerState::error_warning);
    take(CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE, ControllerState::error_passive);
}

}  // namespace

ErrorReport decode_error_frame(std::uint32_t id, std::span<const std::uint8_t> data) {
    ErrorReport report;
    if ((id & CAN_ERR_CRTL) != 0 && data.size() > 1) {
        take_controller_byte(data[1], report);
    }
    report.not_acknowledged = (id & CAN_ERR_ACK) != 0;
    report.transmit_timeout = (id & CAN_ERR_TX_TIMEOUT) != 0;
    report.arbitration_lost = (id & CAN_ERR_LOSTARB) != 0;
    report.protocol_violation = (id & CAN_ERR_PROT) != 0;
    report.transceiver_fault = (id & CAN_ERR_TRX) != 0;
    report.restarted = (id & CAN_ERR_RESTARTED) != 0;
    if (report.restarted) {
        report.has_state = true;
        report.state = ControllerState::error_active;
    }
    if ((id & CAN_ERR_BUSOFF) != 0) {
        report.has_state = true;
        report.state = ControllerState::bus_off;
    }
    return report;
}

}  // namespace millforce::socketcan
