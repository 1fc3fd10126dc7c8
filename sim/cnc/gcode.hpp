// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "cnc/move.hpp"

namespace millforce::sim {

/// Part programs in plain G-code (RS-274, the common subset), read as if hostile.
///
/// | words                    | meaning                                                                          |
/// |--------------------------|----------------------------------------------------------------------------------|
/// | G0 G1                    | rapid, straight feed; modal                                                      |
/// | G2 G3                    | arc clockwise, counter-clockwise in xy, with linear z (helix); modal. Either I, J  |
/// |                          | (centre relative to the start) or R (positive: up to half a turn, negative: more)|
/// | G4 P                     | dwell of P seconds                                                               |
/// | G17                      | xy plane; G18, G19 are rejected                                                  |
/// | G20 G21                  | inch, mm (initial); act on the whole block that contains them                    |
/// | G90 G91                  | absolute (initial), relative                                                     |
/// | G40 G49 G54 G80 G94      | accepted, without effect                                                         |
/// | G61 G64, G64 P           | accepted, without effect: the tolerance is in CncSettings                         |
/// | M52 P1, M52              | accepted: the override always acts                                               |
/// | F S                      | feed in mm/min or inch/min, spindle speed in rev/min; modal                      |
/// | M3 M5                    | spindle on clockwise, off. M4 is rejected: the plant's cutters are right-handed  |
/// | M2 M30 or a second %     | end of the program; what follows is not read                                     |
/// | N, / , ( ), ;, %         | block number, block delete (on), comments, begin and end                         |
///
/// Within a block F, S, M3 and M5 act before the motion, whatever the order of the words. Words may be in lower case
/// and need no blanks between them. Lines end with LF or CRLF; a UTF-8 byte order mark is skipped.
///
/// Everything else throws InputError "file:line:column: found '…', expected …", among it: unknown words and codes, two
/// words of one modal group, a letter without a number, a feed move without F or with the spindle stopped, an axis word
/// without a motion mode, an arc whose radii at start and end differ by more than 5 µm or whose radius is not above
/// 5 µm, coordinates beyond 100 m, and a program without M2, M30 or closing % (a truncated file). Moves without length
/// are checked and then left out.
struct GcodeSettings {
    /// Position of the tip before the first move.
    Eigen::Vector3d start_mm = Eigen::Vector3d(0.0, 0.0, 50.0);
    std::size_t max_moves = 4'000'000;
};

/// The moves of a program, each beginning where the one before ends. `file_name` is used for messages only.
std::vector<Move> parse_gcode(std::string_view text, std::string_view file_name, const GcodeSettings& settings = {});

/// The same from a stream (at most 256 MiB).
std::vector<Move> parse_gcode(std::istream& stream, std::string_view file_name, const GcodeSettings& settings = {});

}  // namespace millforce::sim
