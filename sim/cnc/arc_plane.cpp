// SPDX-License-Identifier: Apache-2.0
#include "cnc/arc_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace millforce::sim {

namespace {

constexpr double chord_tolerance_mm = 0.001;

/// How many lines keep within the tolerance of the arc.
int lines_of(const Move& arc) {
    const double radius_mm = arc_radius_mm(arc);
    const double widest_rad = 2.0 * std::acos(std::max(0.0, 1.0 - chord_tolerance_mm / radius_mm));
    return std::max(1, static_cast<int>(std::ceil(arc_sweep_rad(arc) / widest_rad)));
}

}  // namespace

Eigen::Vector3d in_plane(const Eigen::Vector3d& p, ArcPlane plane) {
    switch (plane) {
        case ArcPlane::zx:
            return {p.z(), p.x(), p.y()};
        case ArcPlane::yz:
            return {p.y(), p.z(), p.x()};
        case ArcPlane::xy:
            break;
    }
    return p;
}

/// Both upright planes turn the order of the axes, in opposite directions: one undoes the other.
Eigen::Vector3d from_plane(const Eigen::Vector3d& p, ArcPlane plane) {
    constexpr std::array<ArcPlane, 3> opposite{ArcPlane::xy, ArcPlane::yz, ArcPlane::zx};
    return in_plane(p, opposite[static_cast<std::size_t>(plane)]);
}

std::vector<Move> moves_from_plane(const Move& move, ArcPlane plane) {
    if (plane == ArcPlane::xy) {
        return {move};
    }
    Move line = move;
    line.end_mm = from_plane(move.start_mm, plane);
    line.kind = is_arc(move) ? MoveKind::feed_line : move.kind;
    const int count = is_arc(move) ? lines_of(move) : 1;
    std::vector<Move> lines;
    for (int k = 1; k <= count; ++k) {
        const Eigen::Vector3d end_mm = k < count ? position_at(move, length_mm(move) * k / count) : move.end_mm;
        line.start_mm = line.end_mm;
        line.end_mm = from_plane(end_mm, plane);
        lines.push_back(line);
    }
    return lines;
}

}  // namespace millforce::sim
