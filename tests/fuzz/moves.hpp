// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "cnc/cnc.hpp"
#include "cnc/gcode.hpp"
#include "cnc/path_limits.hpp"
#include "fuzz/hostile_bytes.hpp"

namespace millforce::fuzz {

inline constexpr std::size_t most_moves = 20'000;

/// Moves that a machine can run, each beginning where the one before ends.
inline void require_sound(const sim::GcodeProgram& program, const sim::GcodeSettings& settings) {
    for (const std::string& note : program.notes) {
        require_printable(note);
    }
    require(program.moves.size() <= settings.max_moves, "no more moves than asked for");
    Eigen::Vector3d position_mm = settings.start_mm;
    for (const sim::Move& move : program.moves) {
        require((move.start_mm - position_mm).norm() < 1e-6, "a move begins where the last one ends");
        position_mm = move.end_mm;
        require(move.end_mm.cwiseAbs().maxCoeff() <= sim::largest_coordinate_mm, "positions within 100 m");
        const bool is_feed = move.kind == sim::MoveKind::feed_line || sim::is_arc(move);
        require(!is_feed || (move.feed_mm_s > 0.0 && std::isfinite(move.feed_mm_s)), "a feed above 0");
        require(!is_feed || (move.spindle_speed_rad_s > 0.0 && std::isfinite(move.spindle_speed_rad_s)),
                "a feed move with a turning spindle");
        require(move.dwell_s >= 0.0 && move.dwell_s <= 86'400.0, "a dwell of at most a day");
        require(std::isfinite(sim::length_mm(move)), "a length");
    }
    if (!program.moves.empty()) {
        const sim::PathLimits limits(sim::CncSettings{}, program.moves);
        require(std::isfinite(limits.total_mm()), "a path of finite length");
    }
}

}  // namespace millforce::fuzz
