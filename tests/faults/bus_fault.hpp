// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "bus/loopback_bus.hpp"

/// What goes wrong on a CAN bus between drives, controller and CNC.

namespace millforce::faults {

enum class BusFault : std::uint8_t {
    spindle_silent,  ///< none of its drive's frames arrives
    x_silent,
    status_silent,   ///< the CNC's program status
    override_lost,   ///< the CNC hears nothing of the controller
    bus_dead,        ///< no frame arrives
    frames_lost,     ///< 30 %
    frames_late,     ///< each by 0 to 20 ms, so in any order
    frames_twice,    ///< each, and 1 ms late
    bytes_altered,   ///< in 5 % of the frames one byte, as behind a gateway
    babbling_drive,  ///< each of the x drive's frames comes five times
};
inline constexpr int bus_faults = static_cast<int>(BusFault::babbling_drive) + 1;

const char* name_of(BusFault fault);

/// For LoopbackBus::set_fault.
[[nodiscard]] sim::LoopbackBus::Fault on_bus(BusFault fault, std::uint64_t seed);

}  // namespace millforce::faults
