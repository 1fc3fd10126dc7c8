// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "cia402/drive_settings.hpp"
#include "cia402/objects.hpp"
#include "firmware/parameters.hpp"
#include "firmware_can/can_controller.hpp"

/// The settings of the bus from the parameter table, for a host and for a board alike.

namespace millforce::firmware {

/// The objects that a drive's keys name: tpdo1 … tpdo4 and the spindle's three. The table's numbers do not hold them.
struct DriveObjects {
    std::array<cia402::PdoMapping, cia402::largest_pdo_count> pdos{};  ///< objects only
    cia402::ObjectAddress count{cia402::object::position_actual, 0};
    cia402::ObjectAddress index_count{};
    cia402::ObjectAddress index_number{};
};
using BusObjects = std::array<DriveObjects, cia402::drive_capacity>;

/// The table's ranges keep the value positive.
constexpr std::uint32_t nearest_whole(float value) {
    const auto below = static_cast<std::uint32_t>(value);
    return value - static_cast<float>(below) < 0.5F ? below : below + 1U;
}
constexpr std::uint32_t microseconds_of(float milliseconds) {
    return nearest_whole(milliseconds * 1e3F);
}

[[nodiscard]] constexpr override_frame::OverrideSenderSettings override_sender_settings(const BusParameters<float>& p) {
    return {.node_id = p.override_node_id,
            .id = p.override_id,
            .period_us = microseconds_of(p.override_period_ms),
            .heartbeat_period_us = microseconds_of(p.override_heartbeat_ms)};
}
[[nodiscard]] constexpr program_status::ProgramStatusReceiverSettings program_status_settings(
    const BusParameters<float>& p) {
    return {.id = p.program_status_id, .timeout_us = microseconds_of(p.program_status_timeout_ms)};
}

/// Not checked: see cia402::check(settings.drives).
[[nodiscard]] CanControllerSettings can_controller_settings(const MachineParameters<float>& machine,
                                                            const BusObjects& objects);

}  // namespace millforce::firmware
