// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cia402/drive_settings.hpp"
#include "cia402/objects.hpp"

/// Settings of drives and bus that tests begin with: limits that no sound value meets, a SYNC each millisecond.

namespace millforce::test {

inline cia402::DriveSettings a_drive() {
    cia402::DriveSettings drive;
    drive.largest_share_of_rated = 4.0F;
    drive.largest_velocity_mm_s = 2000.0F;
    drive.count_object = {cia402::object::position_actual, 0};
    drive.largest_count_step = 1U << 20U;
    drive.stale_us = 20'000;
    return drive;
}

/// No drive has a node id.
inline cia402::BusSettings a_bus() {
    cia402::BusSettings settings;
    settings.drives.fill(a_drive());
    settings.sync_id = cia402::cob_id::sync;
    settings.sync_period_us = 1000;
    settings.collect_us = 800;
    return settings;
}

}  // namespace millforce::test
