// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "cnc/move.hpp"

namespace millforce::sim {

inline constexpr double mm_per_inch = 25.4;
inline constexpr double largest_coordinate_mm = 1e5;  ///< largest in a part program
inline constexpr double largest_feed_mm_min = 1e7;    ///< programs that mean "as fast as it goes" write some millions
inline constexpr double largest_spindle_speed_rpm = 1e6;
inline constexpr double largest_tool = 4294967295.0;
inline constexpr double longest_dwell_s = 3600.0;

/// The way of an arc may lie further out than its ends: asked of each move's end.
[[nodiscard]] inline bool is_within_reach(const Eigen::Vector3d& place_mm) {
    return place_mm.cwiseAbs().maxCoeff() <= largest_coordinate_mm;
}

/// Part programs in plain G-code (RS-274, the common subset), read as if hostile. The codes, with what each does, is
/// ignored for or is refused with: sim/cnc/README.md.
///
/// Within a block F, S, M3 and M5 act before the motion, whatever the order of the words. Words may be in lower case
/// and need no blanks between them. Lines end with LF or CRLF; a UTF-8 byte order mark is skipped. Drilling cycles
/// become plunges (drilling_cycle.hpp).
///
/// Everything else throws InputError "file:line:column: found '…', expected …", among it: unknown words and codes, two
/// words of one modal group, a letter without a number, a feed move without F or with the spindle stopped, an axis word
/// without a motion mode, an arc whose radii at start and end differ by more than 5 µm or whose radius is not above
/// 5 µm, coordinates beyond 100 m, and a program that begins with % and ends without (a truncated file). Moves without
/// length are checked and then left out.
struct GcodeSettings {
    /// Position of the tip before the first move.
    Eigen::Vector3d start_mm = Eigen::Vector3d(0.0, 0.0, 50.0);
    std::size_t max_moves = 4'000'000;
    bool may_change_tool = false;  ///< else another tool after a cut is refused
};

/// The moves of a program, each beginning where the one before ends; and what was left out of it, in words.
struct GcodeProgram {
    std::vector<Move> moves;
    std::vector<std::string> notes;  ///< "file:line: M7, M8, M9: coolant is not simulated"; each once
};

/// `file_name` is used for messages only.
GcodeProgram read_gcode(std::string_view text, std::string_view file_name, const GcodeSettings& settings = {});

/// The same from a stream (at most 256 MiB).
GcodeProgram read_gcode(std::istream& stream, std::string_view file_name, const GcodeSettings& settings = {});

/// The moves alone.
std::vector<Move> parse_gcode(std::string_view text, std::string_view file_name, const GcodeSettings& settings = {});

}  // namespace millforce::sim
