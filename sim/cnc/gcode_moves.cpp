// SPDX-License-Identifier: Apache-2.0
// Lines, arcs, dwell and retreat.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cnc/arc_plane.hpp"
#include "cnc/gcode_interpreter.hpp"

namespace millforce::sim::gcode {

namespace {

constexpr double arc_tolerance_mm = 0.005;
constexpr double coincident_mm = 1e-7;

/// The words of an arc's centre in a plane, and the one that has no meaning there.
struct CentreWords {
    std::string_view of_plane;
    std::string_view of_axis;
    std::string_view names;
};

CentreWords centre_words(ArcPlane plane) {
    constexpr std::array<CentreWords, 3> words{{{"IJ", "K", "I, J"}, {"IK", "J", "I, K"}, {"JK", "I", "J, K"}}};
    return words[static_cast<std::size_t>(plane)];
}

}  // namespace

Move Interpreter::next_move(MoveKind kind, const Eigen::Vector3d& target_mm) const {
    Move move;
    move.kind = kind;
    move.start_mm = position_mm_;
    move.end_mm = target_mm;
    move.spindle_speed_rad_s = spindle_on_ ? spindle_speed_rad_s_ : 0.0;
    move.line = line_;
    move.tool = static_cast<std::uint32_t>(tool_);
    return move;
}

Eigen::Vector3d Interpreter::target(const SortedBlock& block) const {
    Eigen::Vector3d result = position_mm_;
    constexpr std::string_view axes = "XYZ";
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        if (const GcodeWord* word = block.address(axes[axis])) {
            double& coordinate = result[static_cast<Eigen::Index>(axis)];
            coordinate = word->value * mm_per_unit_ + (relative_ ? coordinate : 0.0);
            if (!(std::abs(coordinate) <= largest_coordinate_mm)) {
                fail(*word, "a position within 100000 mm of the origin");
            }
        }
    }
    return result;
}

double Interpreter::offset_mm(const GcodeWord* word) const {
    if (word == nullptr) {
        return 0.0;
    }
    const double value = word->value * mm_per_unit_;
    if (!(std::abs(value) <= largest_coordinate_mm)) {
        fail(*word, "an arc's centre or radius within 100000 mm");
    }
    return value;
}

void Interpreter::append(const Move& move, const GcodeWord& subject) {
    if (moves_.size() >= max_moves_) {
        fail(subject, fmt::format("a program of at most {} moves", max_moves_));
    }
    if (!is_within_reach(move.end_mm)) {
        fail(subject, "a way within 100000 mm of the origin");
    }
    moves_.push_back(move);
}

void Interpreter::require_cutting_conditions(const GcodeWord& subject) const {
    if (feed_mm_s_ <= 0.0) {
        fail(subject, "a feed F before the first feed move");
    }
    if (!spindle_on_ || spindle_speed_rad_s_ <= 0.0) {
        fail(subject, "a turning spindle (M3 and S above 0) before a feed move");
    }
}

void Interpreter::run_motion(const SortedBlock& block) {
    const GcodeWord* word = block.first_of("XYZIJKR");
    if (word == nullptr) {
        return;
    }
    if (!motion_.has_value()) {
        fail(*word, "G0, G1, G2 or G3 before it");
    }
    const GcodeWord& subject = block.code(motion) != nullptr ? *block.code(motion) : *word;
    const Eigen::Vector3d target_mm = target(block);
    Move move = next_move(*motion_, target_mm);
    const ArcPlane plane = is_arc(move) ? plane_ : ArcPlane::xy;
    if (is_arc(move)) {
        move.start_mm = in_plane(move.start_mm, plane);
        move.end_mm = in_plane(move.end_mm, plane);
        set_centre(move, block, subject);
    } else if (const GcodeWord* stray = block.first_of("IJKR")) {
        fail(*stray, "I, J, K and R with an arc (G2, G3) only");
    }
    if (move.kind != MoveKind::rapid) {
        require_cutting_conditions(subject);
        move.feed_mm_s = feed_mm_s_;
        has_cut_ = true;
    }
    position_mm_ = from_plane(move.end_mm, plane);
    if (length_mm(move) > 0.0) {
        for (const Move& part : moves_from_plane(move, plane)) {
            append(part, subject);
        }
    }
}

/// Of an arc in the plane's axes.
void Interpreter::set_centre(Move& move, const SortedBlock& block, const GcodeWord& subject) const {
    const CentreWords words = centre_words(plane_);
    const GcodeWord* radius = block.address('R');
    const GcodeWord* centre = block.first_of(words.of_plane);
    if (const GcodeWord* stray = block.first_of(words.of_axis)) {
        fail(*stray, fmt::format("a centre in {}, the arc's plane", words.names));
    }
    if (radius != nullptr && centre != nullptr) {
        fail(*radius, fmt::format("either a radius R or a centre {}, not both ('{}')", words.names, centre->text));
    }
    if (radius == nullptr && centre == nullptr) {
        fail(subject, fmt::format("an arc with a centre ({}) or a radius (R) in the same block", words.names));
    }
    if (radius != nullptr) {
        set_centre_from_radius(move, *radius);
        return;
    }
    const Eigen::Vector3d offsets_mm(offset_mm(block.address('I')), offset_mm(block.address('J')),
                                     offset_mm(block.address('K')));
    move.centre_mm = move.start_mm + in_plane(offsets_mm, plane_);
    if ((move.end_mm - move.start_mm).head<2>().norm() < coincident_mm) {
        move.end_mm.head<2>() = move.start_mm.head<2>();  // a full circle, whatever relative sums round to
    }
    const double start_radius_mm = (move.start_mm - move.centre_mm).head<2>().norm();
    const double end_radius_mm = (move.end_mm - move.centre_mm).head<2>().norm();
    if (!(start_radius_mm > arc_tolerance_mm)) {
        fail(*centre, "an arc radius above 0.005 mm");
    }
    if (!(std::abs(start_radius_mm - end_radius_mm) <= arc_tolerance_mm)) {
        fail(*centre, fmt::format("the same radius at the arc's start ({:.4f} mm) and end ({:.4f} mm) within 0.005 mm",
                                  start_radius_mm, end_radius_mm));
    }
}

void Interpreter::set_centre_from_radius(Move& move, const GcodeWord& word) const {
    const double signed_radius_mm = offset_mm(&word);
    const double radius_mm = std::abs(signed_radius_mm);
    const Eigen::Vector2d chord = (move.end_mm - move.start_mm).head<2>();
    const double chord_mm = chord.norm();
    if (!(radius_mm > arc_tolerance_mm)) {
        fail(word, "an arc radius above 0.005 mm");
    }
    if (!(chord_mm > 0.0)) {
        fail(word, fmt::format("an end away from the start: a full circle needs its centre as {}",
                               centre_words(plane_).names));
    }
    if (!(0.5 * chord_mm <= radius_mm + arc_tolerance_mm)) {
        fail(word,
             fmt::format("an arc radius of at least half the distance from start to end ({:.4f} mm)", 0.5 * chord_mm));
    }
    const double height_mm = std::sqrt(std::max(0.0, (radius_mm - 0.5 * chord_mm) * (radius_mm + 0.5 * chord_mm)));
    const bool centre_on_left = (move.kind == MoveKind::arc_ccw) == (signed_radius_mm > 0.0);
    const Eigen::Vector2d left = Eigen::Vector2d(-chord.y(), chord.x()) / chord_mm;
    move.centre_mm = move.start_mm;
    move.centre_mm.head<2>() += 0.5 * chord + (centre_on_left ? height_mm : -height_mm) * left;
}

/// G64 P, the path's tolerance, and M52 P1, the override acts: both are so here anyway.
void Interpreter::check_other_use_of_p(const SortedBlock& block) const {
    const GcodeWord* value = block.address('P');
    const GcodeWord* switched = block.code(adaptive_feed);
    const bool blends = block.code(path_mode) != nullptr && tenths(*block.code(path_mode)) == 640;
    if (cycle_.has_value()) {
        return;  // it is the cycle's
    }
    if (value != nullptr && switched == nullptr && !blends) {
        fail(*value, "P in a block with G4, G64 or M52 only");
    }
    if (value != nullptr && switched != nullptr && value->value != 1.0) {
        fail(*value, "M52 P1: the override always acts here");
    }
    if (value != nullptr && switched == nullptr && !(value->value >= 0.0)) {
        fail(*value, "a tolerance of 0 or more");
    }
}

void Interpreter::run_dwell(const SortedBlock& block) {
    const GcodeWord* code = block.code(dwell);
    const GcodeWord* time = block.address('P');
    if (code == nullptr) {
        check_other_use_of_p(block);
        return;
    }
    if (time == nullptr) {
        fail(*code, "G4 with P, the dwell in seconds");
    }
    if (!(time->value >= 0.0 && time->value <= longest_dwell_s)) {
        fail(*time, "a dwell from 0 to 3600 s");
    }
    if (const GcodeWord* word = block.first_of("XYZIJKR")) {
        fail(*word, "no motion in a block with G4");
    }
    if (time->value > 0.0) {
        Move move = next_move(MoveKind::dwell, position_mm_);
        move.dwell_s = time->value;
        append(move, *code);
    }
}

/// The machine's own positions are not known here: what matters is that the tool leaves the part.
void Interpreter::run_retreat(const SortedBlock& block) {
    const GcodeWord& code = *block.code(retreat);
    note("G28, G30, G53: a rapid straight up to the height of the start; the machine's own positions are not known");
    if (const GcodeWord* word = block.first_of("IJKR")) {
        fail(*word, "no arc with G28, G30 or G53");
    }
    if (motion_.has_value() && *motion_ != MoveKind::rapid && tenths(code) == 530) {
        fail(code, "G53 with G0 only");
    }
    if (position_mm_.z() < start_height_mm_) {
        Move move = next_move(MoveKind::rapid, {position_mm_.x(), position_mm_.y(), start_height_mm_});
        position_mm_ = move.end_mm;
        append(move, code);
    }
}

}  // namespace millforce::sim::gcode
