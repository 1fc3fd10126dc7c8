// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cia402/objects.hpp"
#include "cia402/pdo_mapping.hpp"
#include "hal/drive_sample.hpp"
#include "hal/drive_wiring.hpp"

/// How the drives of a machine are wired to the bus, mapped and scaled. Plain data; check() before use. The firmware's
/// parameters have the defaults (parameters.hpp); here what must be given is 0, and refused until it is set.

namespace millforce::cia402 {

/// One drive per role, and its place in arrays.
enum class DriveRole : std::uint8_t { spindle, x_axis, y_axis, z_axis };
inline constexpr std::size_t drive_capacity = 1 + hal::axis_count;

using hal::CurrentBasis;
using hal::CurrentSource;
using hal::VelocitySource;

struct ObjectAddress {
    std::uint16_t index = 0;  ///< 0: none
    std::uint8_t subindex = 0;
};

struct DriveSettings {
    std::uint8_t node_id = 0;  ///< 1…127; 0: this role has no drive on the bus
    /// TPDO 1…4 of the drive, by place.
    std::array<PdoMapping, largest_pdo_count> pdos{};

    /// False: another source (hal::DriveSource) gives the current, or the count or velocity, and no PDO carries it.
    bool gives_current = true;
    bool gives_motion = true;

    CurrentSource current_source = CurrentSource::current;
    CurrentBasis current_basis = CurrentBasis::rms;
    bool current_reversed = false;
    float rated_current_A = 0.0F;           ///< in the terms of `current_basis`; 0: read from 0x6075 (mA)
    float rated_torque_Nm = 0.0F;           ///< 0: read from 0x6076 (mN·m); only with torque_actual
    float torque_constant_Nm_per_A = 0.0F;  ///< N·m per A of `current_basis`; only with torque_actual
    float largest_share_of_rated = 0.0F;    ///< limit of current or torque; beyond it the value is rejected

    /// Axes. The units of a drive are what its gear and factor objects make of them: calibrate, or read its manual.
    VelocitySource velocity_source = VelocitySource::velocity;
    float velocity_mm_s_per_unit = 0.0F;  ///< unit of 0x606C; negative: the drive counts against the machine axis
    float position_mm_per_unit =
        0.0F;  ///< unit of 0x6064; with 0x606C too, the two are compared (Reject::units_disagree)
    float largest_velocity_mm_s = 0.0F;

    /// Spindle: the object that carries the encoder count, and what latches it at the index pulse, if anything does.
    ObjectAddress count_object{};
    ObjectAddress index_count_object{};    ///< the count at the last index pulse, e.g. 0x60BA (touch probe value)
    ObjectAddress index_number_object{};   ///< increases at each index pulse, e.g. 0x60D5 (touch probe edge counter)
    std::uint32_t count_modulus = 0;       ///< counts after which the object starts again at 0; 0: the object's width
    std::uint32_t largest_count_step = 0;  ///< per SYNC period
    bool count_reversed = false;           ///< the count decreases in the cutting direction (M3)

    std::uint32_t heartbeat_timeout_us = 0;  ///< 0: the heartbeat is not watched
    std::uint16_t heartbeat_period_ms = 0;   ///< written to 0x1017 at start; 0: left as it is
    bool write_mapping = false;              ///< write `pdos` to the drive at start; else it is mapped so already
    std::uint32_t stale_us = 0;              ///< age up to which a PDO that does not come at every SYNC is used
};

struct BusSettings {
    std::array<DriveSettings, drive_capacity> drives{};  ///< by DriveRole

    /// Master: reads and writes objects at start (SDO) and starts the nodes (NMT). Else a listener that sends nothing
    /// of the two: the CNC is the master, and all rated values are given.
    bool is_master = false;
    std::uint32_t sync_id = 0;
    std::uint32_t sync_period_us = 0;
    /// A sample is handed over when all PDOs of its SYNC have arrived, at the latest after this time.
    std::uint32_t collect_us = 0;
    /// Mask of hal::Present: what another source gives beside the bus, wholly or in part. A sample waits for it as for
    /// a PDO; without any drive on the bus it is all of the sample.
    std::uint8_t beside_bus = 0;
};

/// First thing that is wrong with the settings.
enum class SettingsError : std::uint8_t {
    none,
    no_drive,         ///< and nothing beside the bus
    node_id,          ///< above 127, or used twice
    pdo_mapping,      ///< see check(PdoMapping)
    id_used_twice,    ///< two PDOs, or a PDO and the SYNC, with one CAN id
    object_missing,   ///< no PDO carries the current or torque, or the count, or velocity or position
    object_width,     ///< an object that is read has more than 32 bits
    rated_value,      ///< negative, not finite; or 0 for a listener, who cannot ask
    torque_constant,  ///< torque_actual without a torque constant
    unit,             ///< velocity or position unit 0 or not finite
    limit,            ///< largest_… not above 0 or not finite; modulus of 1 or steps beyond half of it
    heartbeat,        ///< timeout not above the period
    sync,             ///< period 0 or above 1 s, collect_us 0 or above the period, or an id outside 1…0x7FF
};
[[nodiscard]] SettingsError check(const BusSettings& settings);

}  // namespace millforce::cia402
