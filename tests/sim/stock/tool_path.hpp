// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include "cutting/cutter.hpp"
#include "stock/engagement.hpp"
#include "stock/height_map.hpp"

namespace millforce::sim {

/// A tool that cuts its way through a block in steps of a third of a cell, as the loop moves it.
class CuttingTool {
  public:
    CuttingTool(HeightMap& map, const Cutter& cutter)
        : map_(map), cutter_(cutter), look_ahead_(cutter, map.cell_mm()) {}

    using Observer = std::function<void(double path_mm, const TrueEngagement& truth)>;

    void place(const Eigen::Vector3d& tip_mm) { tip_mm_ = tip_mm; }

    /// Cuts on a straight line; the observer sees the engagement after each step.
    void line_to(const Eigen::Vector3d& end_mm, const Observer& observer = nullptr) {
        const Eigen::Vector3d start_mm = tip_mm_;
        const double length = (end_mm - start_mm).norm();
        const Eigen::Vector3d direction = (end_mm - start_mm) / length;
        const int steps = static_cast<int>(std::ceil(length / (0.36 * map_.cell_mm())));
        for (int k = 1; k <= steps; ++k) {
            const double path_mm = length * k / steps;
            step_to(start_mm + direction * path_mm, direction, path_mm, observer);
        }
    }

    /// Cuts on an arc about a point, counter-clockwise for a positive sweep.
    void arc(const Eigen::Vector2d& centre_mm, double sweep_rad, const Observer& observer = nullptr) {
        const Eigen::Vector2d from = tip_mm_.head<2>() - centre_mm;
        const double radius = from.norm();
        const double start_rad = std::atan2(from.y(), from.x());
        const double z_mm = tip_mm_.z();
        const int steps = static_cast<int>(std::ceil(std::abs(sweep_rad) * radius / (0.36 * map_.cell_mm())));
        for (int k = 1; k <= steps; ++k) {
            const double angle = start_rad + sweep_rad * k / steps;
            const Eigen::Vector3d tangent(-std::sin(angle), std::cos(angle), 0.0);
            step_to({centre_mm.x() + radius * std::cos(angle), centre_mm.y() + radius * std::sin(angle), z_mm},
                    std::copysign(1.0, sweep_rad) * tangent, std::abs(sweep_rad) * radius * k / steps, observer);
        }
    }

  private:
    void step_to(const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction, double path_mm,
                 const Observer& observer) {
        map_.remove(cutter_, tip_mm_, tip_mm);
        tip_mm_ = tip_mm;
        if (observer) {
            observer(path_mm, summarise(look_ahead_.engagement(map_, tip_mm, direction)));
        }
    }

    HeightMap& map_;
    Cutter cutter_;
    LookAhead look_ahead_;
    Eigen::Vector3d tip_mm_ = Eigen::Vector3d::Zero();
};

inline Cutter end_mill(double diameter_mm = 10.0) {
    Cutter cutter;
    cutter.diameter_mm = diameter_mm;
    cutter.flute_length_mm = 30.0;
    return cutter;
}

}  // namespace millforce::sim
