// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

namespace millforce::sim {

enum class MoveKind : std::uint8_t {
    rapid,      ///< G0: straight, at the machine's rapid feed.
    feed_line,  ///< G1: straight, at feed_mm_s.
    arc_cw,     ///< G2: circle or helix about the z axis, clockwise seen from above.
    arc_ccw,    ///< G3: the same, counter-clockwise.
    dwell,      ///< G4: no path, dwell_s of waiting.
};

/// One piece of a tool path: a straight line, an arc about an axis parallel to z with linear z (helix), or a wait.
/// Positions are those of the tool's tip in the work coordinate system, in mm.
///
/// An arc whose start and end coincide in x and y is a full circle. Where both radii differ by rounding of the part
/// program (at most 5 µm, see gcode.hpp), the radius changes linearly along the arc, so that it ends where it should.
struct Move {
    MoveKind kind = MoveKind::rapid;
    Eigen::Vector3d start_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d end_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();  ///< Arcs only; its z has no meaning.
    double feed_mm_s = 0.0;                               ///< Programmed feed along the path; 0 for rapid and dwell.
    double spindle_speed_rad_s = 0.0;                     ///< Clockwise (M3), 0: stopped.
    double dwell_s = 0.0;
    std::size_t line = 0;    ///< 1-based line of the part program.
    std::uint32_t tool = 0;  ///< Number of the last M6; 0: none yet.
};

bool is_arc(const Move& move);

/// Angle that an arc turns through, 0 < angle ≤ 2π; 0 for other kinds.
double arc_sweep_rad(const Move& move);

/// Mean of the radii at start and end of an arc; 0 for other kinds.
double arc_radius_mm(const Move& move);

/// Length along the path, helix included; 0 for a dwell.
double length_mm(const Move& move);

/// Position at the path length s from the move's start; s outside 0…length is clipped.
Eigen::Vector3d position_at(const Move& move, double s_mm);

/// Unit tangent at the path length s; zero where the move has no length.
Eigen::Vector3d direction_at(const Move& move, double s_mm);

}  // namespace millforce::sim
