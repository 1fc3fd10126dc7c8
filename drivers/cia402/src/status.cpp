// SPDX-License-Identifier: Apache-2.0
#include "cia402/status.hpp"

#include <algorithm>

namespace millforce::cia402 {

EmergencyClass emergency_class(std::uint16_t error_code) {
    const unsigned high = error_code >> 8U;
    if (high == 0x81) {
        return EmergencyClass::communication;
    }
    if (high == 0x82) {
        return EmergencyClass::protocol;
    }
    if (high == 0xF0) {
        return EmergencyClass::additional_functions;
    }
    if (high == 0xFF) {
        return EmergencyClass::device_specific;
    }
    switch (high >> 4U) {
        case 0x0:
            return high == 0 ? EmergencyClass::error_reset : EmergencyClass::unknown;
        case 0x1:
            return EmergencyClass::generic;
        case 0x2:
            return EmergencyClass::current;
        case 0x3:
            return EmergencyClass::voltage;
        case 0x4:
            return EmergencyClass::temperature;
        case 0x5:
            return EmergencyClass::device_hardware;
        case 0x6:
            return EmergencyClass::device_software;
        case 0x7:
            return EmergencyClass::additional_modules;
        case 0x8:
            return EmergencyClass::monitoring;
        case 0x9:
            return EmergencyClass::external;
        default:
            return EmergencyClass::unknown;
    }
}

bool decode_emergency(const hal::CanFrame& frame, Emergency& emergency) {
    if (frame.length != hal::largest_can_length) {
        return false;
    }
    emergency.error_code = static_cast<std::uint16_t>(frame.data[0] | (frame.data[1] << 8U));
    emergency.error_register = frame.data[2];
    std::copy_n(frame.data.begin() + 3, emergency.manufacturer.size(), emergency.manufacturer.begin());
    return true;
}

}  // namespace millforce::cia402
