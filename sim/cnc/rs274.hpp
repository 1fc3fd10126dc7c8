// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cnc/gcode.hpp"

namespace millforce::sim {

/// LinuxCNC's own interpreter, `rs274` of its package, is on the path.
[[nodiscard]] bool has_rs274();

/// A part program as LinuxCNC reads it: O-words, variables, offsets and all. `rs274` runs as a process beside this one
/// (no shell, no input, 60 s and 256 MiB of output at most); its canonical commands become the moves. Moves have no
/// line. Tools 1 to 999 are known, without offsets: coordinates are those of the tip. Lengths are rounded to four
/// decimals of the program's unit. Throws InputError: rs274 is not there, refuses the program (with its own words),
/// takes too long, or asks for what the plant does not have (cutter radius compensation, another tool after a cut, a
/// spindle that turns the other way).
GcodeProgram read_by_rs274(const std::string& file, const GcodeSettings& settings = {});

/// The moves of canonical commands, one a line: "12 N..... STRAIGHT_FEED(7.0, 0.0, 5.0, 0.0, 0.0, 0.0)".
GcodeProgram moves_of_canonical(std::string_view text, const std::string& file, const GcodeSettings& settings = {});

}  // namespace millforce::sim
