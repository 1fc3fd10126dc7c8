// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "cia402/drive_settings.hpp"
#include "firmware/parameters.hpp"
#include "firmware_can/can_controller.hpp"

/// The settings of the bus from the parameter table, for a host and for a board alike.

namespace millforce::firmware {

/// The objects that a drive's keys name: tpdo1 … tpdo4 and the spindle's three. The table's numbers do not hold them.
struct DriveObjects {
    std::array<cia402::PdoMapping, cia402::largest_pdo_count> pdos{};  ///< objects only
    cia402::ObjectAddress count{};
    cia402::ObjectAddress index_count{};
    cia402::ObjectAddress index_number{};
};
using BusObjects = std::array<DriveObjects, cia402::drive_capacity>;

/// Not checked: see cia402::check(settings.drives).
[[nodiscard]] CanControllerSettings can_controller_settings(const MachineParameters<float>& machine,
                                                            const BusObjects& objects);

}  // namespace millforce::firmware
