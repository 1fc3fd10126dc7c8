// SPDX-License-Identifier: Apache-2.0
#include "firmware_can/bus_settings.hpp"

namespace millforce::firmware {

namespace {

/// Transmission type of a PDO that comes when something changes (CiA 301).
constexpr std::uint8_t event_driven = 254;

cia402::DriveSettings drive_settings(const BusDriveParameters<float>& p, float rated_current_A,
                                     const DriveObjects& objects) {
    cia402::DriveSettings drive;
    drive.node_id = p.node_id;
    drive.pdos = objects.pdos;
    for (std::size_t k = 0; k < drive.pdos.size(); ++k) {
        cia402::PdoMapping& pdo = drive.pdos[k];
        const auto usual_id = static_cast<std::uint32_t>(0x180U + 0x100U * k + drive.node_id);
        const std::uint32_t id = p.tpdo_id[k] != 0 ? p.tpdo_id[k] : usual_id;
        pdo.id = pdo.object_count > 0 ? id : 0;
        pdo.transmission_type = p.tpdo_every[k] != 0 ? p.tpdo_every[k] : event_driven;
    }
    drive.current_source = p.current_source;
    drive.current_basis = p.current_basis;
    drive.current_reversed = p.current_reversed;
    drive.rated_current_A = rated_current_A;
    drive.rated_torque_Nm = p.rated_torque_Nm;
    drive.torque_constant_Nm_per_A = p.torque_constant_Nm_per_A;
    drive.largest_share_of_rated = p.largest_share_of_rated;
    drive.velocity_source = p.velocity_source;
    drive.velocity_mm_s_per_unit = p.velocity_mm_s_per_unit;
    drive.position_mm_per_unit = p.position_mm_per_unit;
    drive.largest_velocity_mm_s = p.largest_velocity_mm_s;
    drive.count_object = objects.count;
    drive.index_count_object = objects.index_count;
    drive.index_number_object = objects.index_number;
    drive.count_modulus = p.count_modulus;
    drive.largest_count_step = p.largest_count_step;
    drive.count_reversed = p.count_reversed;
    drive.heartbeat_timeout_us = microseconds_of(p.heartbeat_timeout_ms);
    drive.heartbeat_period_ms = static_cast<std::uint16_t>(nearest_whole(p.heartbeat_period_ms));
    drive.write_mapping = p.write_mapping;
    drive.stale_us = microseconds_of(p.stale_ms);
    return drive;
}

}  // namespace

CanControllerSettings can_controller_settings(const MachineParameters<float>& machine, const BusObjects& objects) {
    const BusParameters<float>& p = machine.bus;
    CanControllerSettings settings;
    for (std::size_t k = 0; k < objects.size(); ++k) {
        const float rated_A = k == 0 ? machine.spindle_rated_current_A : machine.axis_rated_current_A[k - 1];
        settings.drives.drives[k] = drive_settings(p.drives[k], rated_A, objects[k]);
    }
    settings.drives.is_master = p.role == BusRole::master;
    settings.produces_sync = p.produces_sync;
    settings.drives.sync_id = p.sync_id;
    settings.drives.sync_period_us = microseconds_of(p.sync_period_ms);
    settings.drives.collect_us = microseconds_of(p.collect_time_ms);
    settings.feed_override = override_sender_settings(p);
    settings.program = program_status_settings(p);
    return settings;
}

}  // namespace millforce::firmware
