// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "files/toml_reader.hpp"
#include "firmware_can/bus_settings.hpp"
#include "parameters/machine_bus.hpp"

namespace millforce::host {

using firmware::BusObjects;
using firmware::DriveObjects;

/// Throws InputError, which names the element that is no object.
DriveObjects read_drive_objects(TomlFile::Table& table);

/// The settings of the bus; nothing where no drive has a node id. Throws InputError where they do not fit together.
std::optional<MachineBus> machine_bus(const std::string& file, const firmware::MachineParameters<float>& machine,
                                      const BusObjects& objects, const LocalIoKeys& local);

}  // namespace millforce::host
