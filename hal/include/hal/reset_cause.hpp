// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace millforce::hal {

/// Why the processor started. The numbers are sent on the bus: see emergency/emergencies.hpp.
enum class ResetCause : std::uint8_t {
    unknown = 0,
    power_on = 1,
    brown_out = 2,  ///< the supply fell below its limit and came back
    pin = 3,
    software = 4,
    watchdog = 5,
    low_power = 6,
};
constexpr const char* name(ResetCause cause) {
    constexpr const char* names[] = {"unknown",  "power on", "brown-out", "reset pin",
                                     "software", "watchdog", "low power"};
    return names[static_cast<unsigned>(cause) % 7U];
}

}  // namespace millforce::hal
