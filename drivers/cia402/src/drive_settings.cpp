// SPDX-License-Identifier: Apache-2.0
#include "cia402/drive_settings.hpp"

#include <span>

#include "cia402/signal_table.hpp"
#include "hal/finite.hpp"

namespace millforce::cia402 {

namespace {

bool is_positive(float value) {
    return hal::is_finite(value) && value > 0.0F;
}
bool is_rated(float value, bool can_ask) {
    return hal::is_finite(value) && (can_ask ? value >= 0.0F : value > 0.0F);
}

SettingsError check_pdos(const DriveSettings& drive) {
    for (const PdoMapping& pdo : drive.pdos) {
        if (pdo.is_used() && check(pdo) != MappingError::none) {
            return SettingsError::pdo_mapping;
        }
    }
    const SignalTable signals(drive);
    for (std::size_t k = 0; k < signal_count; ++k) {
        if (signals.bits(static_cast<Signal>(k)) > 32) {
            return SettingsError::object_width;
        }
    }
    return SettingsError::none;
}

SettingsError check_current(const DriveSettings& drive, const SignalTable& signals, bool can_ask) {
    if (!drive.gives_current) {
        return SettingsError::none;
    }
    const bool by_torque = drive.current_source == CurrentSource::torque;
    if (!signals.is_mapped(by_torque ? Signal::torque : Signal::current)) {
        return SettingsError::object_missing;
    }
    if (by_torque) {
        if (!is_positive(drive.torque_constant_Nm_per_A)) {
            return SettingsError::torque_constant;
        }
        return is_rated(drive.rated_torque_Nm, can_ask) ? SettingsError::none : SettingsError::rated_value;
    }
    return is_rated(drive.rated_current_A, can_ask) ? SettingsError::none : SettingsError::rated_value;
}

SettingsError check_spindle(const DriveSettings& drive, const SignalTable& signals) {
    if (!signals.is_mapped(Signal::count) ||
        (drive.index_count_object.index != 0) != signals.is_mapped(Signal::index_count) ||
        (drive.index_number_object.index != 0) != signals.is_mapped(Signal::index_number)) {
        return SettingsError::object_missing;
    }
    if (drive.index_count_object.index != 0 && drive.index_number_object.index == 0) {
        return SettingsError::object_missing;
    }
    const unsigned bits = signals.bits(Signal::count);
    const std::uint64_t width = std::uint64_t{1} << (bits < 32 ? bits : 32U);
    const std::uint64_t modulus = drive.count_modulus != 0 ? drive.count_modulus : width;
    const bool ok =
        modulus > 1 && modulus <= width && drive.largest_count_step > 0 && drive.largest_count_step <= modulus / 2;
    return ok ? SettingsError::none : SettingsError::limit;
}

SettingsError check_axis(const DriveSettings& drive, const SignalTable& signals) {
    const bool by_position = drive.velocity_source == VelocitySource::position;
    if (!signals.is_mapped(by_position ? Signal::position : Signal::velocity)) {
        return SettingsError::object_missing;
    }
    const float unit = by_position ? drive.position_mm_per_unit : drive.velocity_mm_s_per_unit;
    if (!hal::is_finite(unit) || unit == 0.0F || !hal::is_finite(drive.position_mm_per_unit)) {
        return SettingsError::unit;
    }
    return is_positive(drive.largest_velocity_mm_s) ? SettingsError::none : SettingsError::limit;
}

SettingsError check_drive(const DriveSettings& drive, bool is_spindle, bool can_ask) {
    if (drive.node_id > largest_node_id) {
        return SettingsError::node_id;
    }
    if (const SettingsError error = check_pdos(drive); error != SettingsError::none) {
        return error;
    }
    const SignalTable signals(drive);
    if (const SettingsError error = check_current(drive, signals, can_ask); error != SettingsError::none) {
        return error;
    }
    if (!is_positive(drive.largest_share_of_rated)) {
        return SettingsError::limit;
    }
    const std::uint64_t heartbeat_us = std::uint64_t{drive.heartbeat_period_ms} * 1000;
    if (drive.heartbeat_timeout_us != 0 && drive.heartbeat_timeout_us <= heartbeat_us) {
        return SettingsError::heartbeat;
    }
    if (!drive.gives_motion) {
        return SettingsError::none;
    }
    return is_spindle ? check_spindle(drive, signals) : check_axis(drive, signals);
}

SettingsError check_ids(const BusSettings& settings) {
    std::array<std::uint32_t, 1 + drive_capacity * largest_pdo_count> used{settings.sync_id};
    std::size_t count = 1;
    for (const DriveSettings& drive : settings.drives) {
        for (const PdoMapping& pdo : drive.pdos) {
            if (drive.node_id == 0 || !pdo.is_used()) {
                continue;
            }
            for (const std::uint32_t id : std::span(used).first(count)) {
                if (id == pdo.id) {
                    return SettingsError::id_used_twice;
                }
            }
            used[count++] = pdo.id;
        }
    }
    return SettingsError::none;
}

SettingsError check_nodes(const BusSettings& settings) {
    bool any = settings.beside_bus != 0;
    for (std::size_t k = 0; k < drive_capacity; ++k) {
        const DriveSettings& drive = settings.drives[k];
        if (drive.node_id == 0) {
            continue;
        }
        any = true;
        for (std::size_t other = 0; other < k; ++other) {
            if (settings.drives[other].node_id == drive.node_id) {
                return SettingsError::node_id;
            }
        }
        if (const SettingsError error = check_drive(drive, k == 0, settings.is_master); error != SettingsError::none) {
            return error;
        }
    }
    return any ? SettingsError::none : SettingsError::no_drive;
}

}  // namespace

SettingsError check(const BusSettings& settings) {
    constexpr std::uint32_t longest_period_us = 1'000'000;
    if (settings.sync_id == 0 || settings.sync_id > hal::largest_standard_can_id || settings.sync_period_us == 0 ||
        settings.sync_period_us > longest_period_us || settings.collect_us == 0 ||
        settings.collect_us > settings.sync_period_us) {
        return SettingsError::sync;
    }
    if (const SettingsError error = check_nodes(settings); error != SettingsError::none) {
        return error;
    }
    return check_ids(settings);
}

}  // namespace millforce::cia402
