// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace millforce::host {

/// What a source measures. The unit of ours is that of a recording's columns.
enum class Quantity : std::uint8_t {
    time,      ///< s
    angle,     ///< rad
    speed,     ///< speed of the spindle, rad/s: the commanded one, or becomes an angle
    pulse,     ///< level of an index pulse: becomes an angle
    current,   ///< A
    velocity,  ///< velocity of an axis, mm/s
    position,  ///< position of an axis, mm: becomes a velocity
    feed,      ///< along the path, mm/s
    force,     ///< N
    ratio,     ///< 1
    state,     ///< 0 or 1
};

/// What the unit alone leaves open. The map's keys of the same names; 0: not given.
struct UnitSettings {
    double rated_A = 0.0;         ///< current that 100 % stand for
    double counts_per_rev = 0.0;  ///< counts of the encoder, all edges counted
    double screw_pitch_mm = 0.0;  ///< travel per turn of the motor
    double rate_hz = 0.0;         ///< samples per second
};

enum class UnitNeed : std::uint8_t { rated_A = 1, counts_per_rev = 2, screw_pitch_mm = 4, rate_hz = 8 };

/// One unit of a quantity.
struct Unit {
    Quantity quantity;
    std::string_view name;
    double factor;       ///< to our unit, before what it needs
    std::uint8_t needs;  ///< UnitNeeds, added

    [[nodiscard]] bool needs_setting(UnitNeed need) const { return (needs & static_cast<std::uint8_t>(need)) != 0; }
    /// A value in this unit times this is one in ours. All that it needs must be given.
    [[nodiscard]] double to_ours(const UnitSettings& settings) const;
};

/// Names of a quantity's units, ours first.
[[nodiscard]] std::vector<std::string> unit_names(Quantity quantity);

/// Index is that of unit_names().
[[nodiscard]] const Unit& unit_of(Quantity quantity, std::size_t index);

/// A column of a recording.
struct RecordingColumn {
    std::string_view name;
    Quantity quantity;
};

/// All columns that can be imported, time_s first, in the order of a recording.
[[nodiscard]] std::span<const RecordingColumn> recording_columns();

}  // namespace millforce::host
