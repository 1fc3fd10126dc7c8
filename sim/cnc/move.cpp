// SPDX-License-Identifier: Apache-2.0
#include "cnc/move.hpp"

#include <algorithm>
#include <cmath>

#include "cutting/angle_units.hpp"

namespace millforce::sim {

namespace {

/// An arc in polar form about its centre; angle_rad is measured from +x, counter-clockwise.
struct PolarArc {
    double start_angle_rad;
    double signed_sweep_rad;
    double start_radius_mm;
    double radius_change_mm;
    double rise_mm;
    double length_mm;
};

PolarArc polar_arc(const Move& move) {
    const Eigen::Vector3d from = move.start_mm - move.centre_mm;
    const Eigen::Vector3d to = move.end_mm - move.centre_mm;
    PolarArc arc{};
    arc.start_angle_rad = std::atan2(from.y(), from.x());
    arc.start_radius_mm = std::hypot(from.x(), from.y());
    arc.radius_change_mm = std::hypot(to.x(), to.y()) - arc.start_radius_mm;
    arc.rise_mm = move.end_mm.z() - move.start_mm.z();
    const double sense = move.kind == MoveKind::arc_ccw ? 1.0 : -1.0;
    double sweep = turn;
    if (move.start_mm.x() != move.end_mm.x() || move.start_mm.y() != move.end_mm.y()) {
        sweep = sense * (std::atan2(to.y(), to.x()) - arc.start_angle_rad);
        sweep = sweep <= 0.0 ? sweep + turn : sweep;
        sweep = sweep > turn ? sweep - turn : sweep;
    }
    arc.signed_sweep_rad = sense * sweep;
    const double mean_radius_mm = arc.start_radius_mm + 0.5 * arc.radius_change_mm;
    arc.length_mm = std::hypot(mean_radius_mm * sweep, arc.radius_change_mm, arc.rise_mm);
    return arc;
}

}  // namespace

bool is_arc(const Move& move) {
    return move.kind == MoveKind::arc_cw || move.kind == MoveKind::arc_ccw;
}

double arc_sweep_rad(const Move& move) {
    return is_arc(move) ? std::abs(polar_arc(move).signed_sweep_rad) : 0.0;
}

double arc_radius_mm(const Move& move) {
    if (!is_arc(move)) {
        return 0.0;
    }
    const PolarArc arc = polar_arc(move);
    return arc.start_radius_mm + 0.5 * arc.radius_change_mm;
}

double length_mm(const Move& move) {
    if (move.kind == MoveKind::dwell) {
        return 0.0;
    }
    return is_arc(move) ? polar_arc(move).length_mm : (move.end_mm - move.start_mm).norm();
}

Eigen::Vector3d position_at(const Move& move, double s_mm) {
    if (!is_arc(move)) {
        const double length = length_mm(move);
        const double share = length > 0.0 ? std::clamp(s_mm / length, 0.0, 1.0) : 1.0;
        return share < 1.0 ? move.start_mm + share * (move.end_mm - move.start_mm) : move.end_mm;
    }
    const PolarArc arc = polar_arc(move);
    const double share = arc.length_mm > 0.0 ? std::clamp(s_mm / arc.length_mm, 0.0, 1.0) : 1.0;
    if (share == 1.0) {
        return move.end_mm;
    }
    const double angle = arc.start_angle_rad + share * arc.signed_sweep_rad;
    const double radius = arc.start_radius_mm + share * arc.radius_change_mm;
    return {move.centre_mm.x() + radius * std::cos(angle), move.centre_mm.y() + radius * std::sin(angle),
            move.start_mm.z() + share * arc.rise_mm};
}

Eigen::Vector3d direction_at(const Move& move, double s_mm) {
    const double length = length_mm(move);
    if (length <= 0.0) {
        return Eigen::Vector3d::Zero();
    }
    if (!is_arc(move)) {
        return (move.end_mm - move.start_mm) / length;
    }
    const PolarArc arc = polar_arc(move);
    const double share = std::clamp(s_mm / length, 0.0, 1.0);
    const double angle = arc.start_angle_rad + share * arc.signed_sweep_rad;
    const double radius = arc.start_radius_mm + share * arc.radius_change_mm;
    const double tangential = radius * arc.signed_sweep_rad;
    const Eigen::Vector3d derivative(arc.radius_change_mm * std::cos(angle) - tangential * std::sin(angle),
                                     arc.radius_change_mm * std::sin(angle) + tangential * std::cos(angle),
                                     arc.rise_mm);
    return derivative.normalized();
}

}  // namespace millforce::sim
