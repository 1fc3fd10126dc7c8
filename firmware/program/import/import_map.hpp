// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/quantity.hpp"

namespace millforce::host {

enum class SourceFormat : std::uint8_t {
    detected,    ///< by the file's first characters; halsampler where the map has names
    csv,         ///< a table with a line of column names, or by column numbers
    odrive,      ///< the same; a column may be named by the end of its property path
    sinumerik,   ///< XML that the trace of SINUMERIK Operate saves
    halsampler,  ///< LinuxCNC
    candump,     ///< log of candump -L, with a DBC file
};

/// Something of the source that is asked for.
struct SourceName {
    std::string name;             ///< column, pin, signal; empty: by number
    std::size_t number = 0;       ///< from 1 on; 0: by name
    bool may_be_missing = false;  ///< without a map: columns that exist are taken
    [[nodiscard]] std::string shown() const;
};

enum class Derivation : std::uint8_t {
    none,
    position,  ///< a velocity: slope of a position
    speed,     ///< the spindle's angle: integral of its speed
    index,     ///< the spindle's angle: whole turns between index pulses
};

/// How one column of the recording is made.
struct ColumnMap {
    RecordingColumn column{};
    SourceName source;
    std::string unit;     ///< as in the map
    double factor = 1.0;  ///< sign × scale × unit
    double offset = 0.0;  ///< added last, in the unit of the recording
    double wrap = 0.0;    ///< the source begins again at this value, in its own unit; 0: never
    Derivation derived_from = Derivation::none;
    double smoothing_s = 0.0;        ///< a velocity is the slope over this time
    double threshold = 0.5;          ///< a pulse, or a state that is 1, is above it
    std::optional<double> equals{};  ///< instead: a state is 1 where the source is this
};

/// The file that says how a source becomes a recording.
struct ImportMap {
    std::string file;  ///< empty: made by map_by_names()
    SourceFormat format = SourceFormat::detected;
    std::vector<std::string> names;  ///< names of a halsampler's pins, in their order
    std::string dbc;                 ///< path of the DBC file
    std::string interface;           ///< interface in a candump log; empty: its only one
    std::optional<ColumnMap> time;   ///< nothing: the source has its own time, or `sample_rate_hz`
    double sample_rate_hz = 0.0;     ///< time is the number of the sample by this
    std::vector<ColumnMap> columns;  ///< but the time
};

/// Reads a map. InputError: an unknown key with the nearest known one, a value, a unit that lacks what it needs.
///
///     [source]                        # all optional
///     format = "csv"                  # csv, odrive, sinumerik, halsampler, candump; else detected
///     names = ["angle", "current"]    # halsampler: the pins in their order
///     dbc = "mill.dbc"                # candump: beside this file
///     interface = "can0"              # candump: if the log has several
///
///     [time_s]                        # a table for each column of the recording
///     source = "Time"                 # or source_number = 1; or neither: the samples are counted
///     unit = "ms"                     # s, ms, us, ns, samples
///     rate_hz = 1000                  # with samples, or where they are counted
///
///     [spindle_angle_rad]
///     source = "Spindle"
///     unit = "counts"                 # rad, deg, rev, counts
///     counts_per_rev = 4096
///     wrap = 65536                    # begins again at this value of the source
///     sign = -1                       # or 1
///     scale = 1.0                     # times this
///     offset = 0.0                    # plus this, in the unit of the recording
///     derived_from = "speed"          # rpm, rad/s, rev/s, deg/s are integrated; or "index": pulses, above `threshold`
///
///     [x_velocity_mm_s]
///     source = "X"
///     derived_from = "position"       # mm, um, m, in, rev, counts
///     smoothing_s = 0.01              # slope over this time
///     screw_pitch_mm = 10             # for rev, rpm, counts
///
///     [x_current_A]
///     source = "X load"
///     unit = "%"                      # A, mA, %, permille, rated
///     rated_A = 11.5
///
///     [rapid]
///     source = "motion type"
///     equals = 1                      # or 1 where it is above `threshold`
[[nodiscard]] ImportMap read_import_map(const std::string& file);

/// For a table whose columns have the recording's names and units already: those that exist are taken.
[[nodiscard]] ImportMap map_by_names();

}  // namespace millforce::host
