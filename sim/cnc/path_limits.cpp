// SPDX-License-Identifier: Apache-2.0
#include "cnc/path_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cnc/cnc.hpp"
#include "files/input_error.hpp"

namespace millforce::sim {

namespace {

void validate(const Move& move) {
    const bool finite = move.start_mm.allFinite() && move.end_mm.allFinite() && move.centre_mm.allFinite() &&
                        std::isfinite(move.spindle_speed_rad_s);
    if (!finite) {
        throw host::InputError(
            fmt::format("part program:{}: found a position or spindle speed that is not finite, expected "
                        "finite ones",
                        move.line));
    }
    if (move.kind == MoveKind::dwell) {
        if (!(move.dwell_s >= 0.0 && move.dwell_s <= 86400.0)) {
            throw host::InputError(
                fmt::format("part program:{}: found a dwell of {} s, expected 0 to 86400", move.line, move.dwell_s));
        }
    } else if (move.kind != MoveKind::rapid && !(move.feed_mm_s > 0.0 && std::isfinite(move.feed_mm_s))) {
        throw host::InputError(
            fmt::format("part program:{}: found a feed of {} mm/s, expected one above 0", move.line, move.feed_mm_s));
    }
}

bool stops_between(const Move& before, const Move& after) {
    return before.kind == MoveKind::dwell || after.kind == MoveKind::dwell ||
           after.spindle_speed_rad_s != before.spindle_speed_rad_s;
}

bool same_feed(const Move& before, const Move& after) {
    return (before.kind == MoveKind::rapid) == (after.kind == MoveKind::rapid) && before.feed_mm_s == after.feed_mm_s;
}

double junction_speed_mm_s(const Move& before, const Move& after, double mean_length_mm, const CncSettings& settings) {
    const Eigen::Vector3d in = direction_at(before, length_mm(before));
    const Eigen::Vector3d out = direction_at(after, 0.0);
    // sin and cos of half the corner's angle from the sum and the difference: exact for straight and for reversed.
    const double sine_half = 0.5 * (in + out).norm();
    const double cosine_half = 0.5 * (out - in).norm();
    const double room = cosine_half * cosine_half / (1.0 + sine_half);  // 1 − sin(θ/2), without cancellation
    const double corner = settings.junction_deviation_mm * sine_half / room;
    const double curve = 0.5 * mean_length_mm * sine_half / cosine_half;
    return std::sqrt(settings.acceleration_mm_s2 * std::min(corner, curve));
}

}  // namespace

PathLimits::PathLimits(const CncSettings& settings, const std::vector<Move>& moves) : blocks_(moves.size()) {
    const std::size_t count = moves.size();
    double path_mm = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        validate(moves[k]);
        Block& block = blocks_[k];
        block.length_mm = length_mm(moves[k]);
        path_mm += block.length_mm;
        block.end_mm = path_mm;
        block.most_mm_s = settings.rapid_feed_mm_s;
        if (is_arc(moves[k])) {
            const double centripetal = std::sqrt(settings.acceleration_mm_s2 * arc_radius_mm(moves[k]));
            block.most_mm_s = std::min(block.most_mm_s, centripetal);
        }
    }
    blocks_.back().next_feed = count;
    for (std::size_t k = count - 1; k-- > 0;) {
        const Block& next = blocks_[k + 1];
        Block& block = blocks_[k];
        block.next_feed = same_feed(moves[k], moves[k + 1]) ? next.next_feed : k + 1;
        if (stops_between(moves[k], moves[k + 1])) {
            continue;
        }
        const double mean_length_mm = 0.5 * (block.length_mm + next.length_mm);
        const double ahead =
            std::sqrt(next.exit_mm_s * next.exit_mm_s + 2.0 * settings.acceleration_mm_s2 * next.length_mm);
        block.exit_mm_s = std::min({block.most_mm_s, next.most_mm_s, ahead,
                                    junction_speed_mm_s(moves[k], moves[k + 1], mean_length_mm, settings)});
    }
}

}  // namespace millforce::sim
