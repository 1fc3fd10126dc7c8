// SPDX-License-Identifier: Apache-2.0
#include "bus/plant_wiring.hpp"

#include <fmt/format.h>

#include <numbers>

#include "files/input_error.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::sim {

namespace {

double or_else(float value, double fallback) {
    return value != 0.0F ? static_cast<double>(value) : fallback;
}

DriveOnBus drive_on_bus(const cia402::DriveSettings& settings, double rated_current_A) {
    DriveOnBus drive;
    const bool is_peak = settings.current_basis == cia402::CurrentBasis::peak;
    drive.node_id = settings.node_id;
    drive.drive_A_per_A = (is_peak ? std::numbers::sqrt2 : 1.0) * (settings.current_reversed ? -1.0 : 1.0);
    drive.rated_current_A = or_else(settings.rated_current_A, rated_current_A * (is_peak ? std::numbers::sqrt2 : 1.0));
    drive.torque_Nm_per_A = static_cast<double>(settings.torque_constant_Nm_per_A);
    drive.rated_torque_Nm =
        or_else(settings.rated_torque_Nm, or_else(settings.torque_constant_Nm_per_A, 1.0) * drive.rated_current_A);
    drive.velocity_unit_mm_s = or_else(settings.velocity_mm_s_per_unit, drive.velocity_unit_mm_s);
    drive.position_unit_mm = or_else(settings.position_mm_per_unit, drive.position_unit_mm);
    drive.count_reversed = settings.count_reversed;
    return drive;
}

}  // namespace

MachineOnBusSettings drives_on_bus(const Scenario& scenario, const host::MachineBus& bus) {
    MachineOnBusSettings settings;
    settings.drives[0] = drive_on_bus(bus.drives.drives[0], scenario.machine.spindle.rated_current_A);
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        settings.drives[1 + axis] =
            drive_on_bus(bus.drives.drives[1 + axis], scenario.machine.axes[axis].rated_current_A);
    }
    settings.drives[0].encoder_counts_per_rev = scenario.parameters.machine.encoder_counts_per_rev;
    return settings;
}

CncOnBusSettings cnc_on_bus(const Scenario& scenario, const host::MachineBus& bus) {
    CncOnBusSettings settings;
    settings.feed_override.id = bus.feed_override.id;
    settings.feed_override.node_id = bus.feed_override.node_id;
    settings.feed_override.largest_ratio = scenario.parameters.machine.cnc.override_max + 0.001F;
    settings.program_status_id = bus.program.id;
    return settings;
}

PlantOnCanSettings plant_on_bus(const Scenario& scenario, const std::string& interface) {
    const auto bus = host::read_machine_bus(scenario.machine_file);
    if (!bus) {
        throw host::InputError(fmt::format("{}: no drive on the bus; expected the tables [bus] and [bus.spindle] …",
                                           scenario.machine_file));
    }
    PlantOnCanSettings settings;
    settings.interface = interface;
    settings.machine = drives_on_bus(scenario, *bus);
    settings.cnc = cnc_on_bus(scenario, *bus);
    settings.cnc.reports_position = true;
    settings.time.sync_id = bus->drives.sync_id;
    settings.time.sync_period_us = bus->drives.sync_period_us;
    return settings;
}

}  // namespace millforce::sim
