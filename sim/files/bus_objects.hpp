#pragma once

#include <array>
#include <optional>
#include <string>

#include "files/machine_bus.hpp"
#include "files/toml_reader.hpp"
#include "firmware/parameters.hpp"

namespace millforce::sim {

/// The objects that a drive's keys name: tpdo1 … tpdo4 and the spindle's three.
struct DriveObjects {
    std::array<cia402::PdoMapping, cia402::largest_pdo_count> pdos{};  ///< objects only
    cia402::ObjectAddress count{};
    cia402::ObjectAddress index_count{};
    cia402::ObjectAddress index_number{};
};
using BusObjects = std::array<DriveObjects, cia402::drive_capacity>;

/// Throws InputError, which names the element that is no object.
DriveObjects read_drive_objects(TomlFile::Table& table);

/// The settings of the bus; nothing where no drive has a node id. Throws InputError where they do not fit together.
std::optional<MachineBus> machine_bus(const std::string& file, const firmware::MachineParameters<float>& machine,
                                      const BusObjects& objects, const LocalIoKeys& local);

}  // namespace millforce::sim
