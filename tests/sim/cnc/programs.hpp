// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "../cutting/random_numbers.hpp"
#include "cnc/cnc.hpp"
#include "cnc/move.hpp"

namespace millforce::sim {

/// Tool paths for tests, built piece by piece from where the last one ended.
class PathBuilder {
  public:
    explicit PathBuilder(double feed_mm_s = 20.0) { move_.feed_mm_s = feed_mm_s; }

    PathBuilder& feed(double feed_mm_s) {
        move_.feed_mm_s = feed_mm_s;
        return *this;
    }
    PathBuilder& spindle(double speed_rad_s) {
        move_.spindle_speed_rad_s = speed_rad_s;
        return *this;
    }
    PathBuilder& line(double dx_mm, double dy_mm, double dz_mm = 0.0) {
        return add(MoveKind::feed_line, move_.end_mm + Eigen::Vector3d(dx_mm, dy_mm, dz_mm));
    }
    PathBuilder& rapid(double dx_mm, double dy_mm, double dz_mm = 0.0) {
        return add(MoveKind::rapid, move_.end_mm + Eigen::Vector3d(dx_mm, dy_mm, dz_mm));
    }
    /// Counter-clockwise for a positive sweep, about the centre relative to the start.
    PathBuilder& arc(double centre_dx_mm, double centre_dy_mm, double sweep_rad, double dz_mm = 0.0) {
        const Eigen::Vector3d centre = move_.end_mm + Eigen::Vector3d(centre_dx_mm, centre_dy_mm, 0.0);
        const double radius = std::hypot(centre_dx_mm, centre_dy_mm);
        const double angle = std::atan2(-centre_dy_mm, -centre_dx_mm) + sweep_rad;
        move_.centre_mm = centre;
        return add(
            sweep_rad > 0.0 ? MoveKind::arc_ccw : MoveKind::arc_cw,
            {centre.x() + radius * std::cos(angle), centre.y() + radius * std::sin(angle), move_.end_mm.z() + dz_mm});
    }
    PathBuilder& dwell(double time_s) {
        move_.dwell_s = time_s;
        add(MoveKind::dwell, move_.end_mm);
        move_.dwell_s = 0.0;
        return *this;
    }
    [[nodiscard]] const std::vector<Move>& moves() const { return moves_; }

  private:
    PathBuilder& add(MoveKind kind, const Eigen::Vector3d& end_mm) {
        Move move = move_;
        move.kind = kind;
        move.start_mm = move_.end_mm;
        move.end_mm = end_mm;
        move.line = moves_.size() + 1;
        if (kind == MoveKind::rapid || kind == MoveKind::dwell) {
            move.feed_mm_s = 0.0;
        }
        moves_.push_back(move);
        move_.end_mm = end_mm;
        return *this;
    }

    Move move_{};
    std::vector<Move> moves_;
};

/// A program of any kind of move, with lengths from 2 µm to 30 mm and feeds from 0.5 to 120 mm/s.
inline std::vector<Move> random_program(RandomNumbers& random) {
    PathBuilder path(random.between(0.5, 120.0));
    path.spindle(400.0);
    const std::size_t count = random.whole(1, 40);
    for (std::size_t k = 0; k < count; ++k) {
        const double length = 30.0 * std::pow(random.between(0.0, 1.0), 4.0) + 0.002;
        const double angle = random.between(0.0, 2.0 * std::numbers::pi);
        const double x = length * std::cos(angle);
        const double y = length * std::sin(angle);
        switch (random.whole(0, 9)) {
            case 0:
                path.rapid(x, y, random.between(-5.0, 5.0));
                break;
            case 1:
                path.arc(x, y, random.between(-2.0 * std::numbers::pi, -0.01));
                break;
            case 2:
                path.arc(x, y, random.between(0.01, 2.0 * std::numbers::pi), random.between(-3.0, 3.0));
                break;
            case 3:
                path.feed(random.between(0.5, 120.0)).line(x, y);
                break;
            case 4:
                path.dwell(random.between(0.0, 0.02));
                break;
            case 5:
                path.spindle(random.between(100.0, 800.0)).line(x, y);
                break;
            default:
                path.line(x, y, random.between(-0.1, 0.1));
        }
    }
    return path.moves();
}

/// The largest speed that the geometry of a program allows at each place, from the geometry alone: the speed through a
/// corner after its equation in cnc/path_limits.hpp, written with the deflection angle instead.
inline double corner_speed_mm_s(double deflection_rad, const CncSettings& settings) {
    const double sine = std::cos(0.5 * deflection_rad);
    return std::sqrt(settings.acceleration_mm_s2 * settings.junction_deviation_mm * sine / (1.0 - sine));
}

}  // namespace millforce::sim
