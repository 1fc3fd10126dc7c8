// SPDX-License-Identifier: Apache-2.0
#include "loop/workpiece.hpp"

#include <algorithm>
#include <cmath>

namespace millforce::sim {

void Workpiece::set(const EngagementMap& map) {
    map_ = map;
    bounds_ = bounds_of(map);
    truth_ = summarise(map);
}

StockWorkpiece::StockWorkpiece(const StockSettings& settings, const Cutter& cutter)
    : cutter_(cutter),
      map_(settings.block.min_x_mm, settings.block.min_y_mm, settings.block.max_x_mm, settings.block.max_y_mm,
           settings.cell_mm, settings.block.top_start_mm),
      look_ahead_(cutter, settings.cell_mm) {
    const auto set_box = [&](const StockBox& box) {
        map_.set_box(box.min_x_mm, box.min_y_mm, box.max_x_mm, box.max_y_mm, box.top_start_mm, box.top_end_mm);
    };
    set_box(settings.block);
    for (const StockBox& box : settings.boxes) {
        set_box(box);
    }
    for (const StockCylinder& hole : settings.drilled) {
        map_.set_cylinder(hole.x_mm, hole.y_mm, hole.diameter_mm, hole.top_mm);
    }
}

void StockWorkpiece::change_tool(const Cutter& cutter) {
    if (last_tip_mm_) {
        map_.remove(cutter_, removed_up_to_mm_, *last_tip_mm_);
    }
    last_tip_mm_.reset();
    cutter_ = cutter;
    look_ahead_ = LookAhead(cutter, map_.cell_mm());
}

bool StockWorkpiece::move_to(const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction, double) {
    const double engagement_step_mm = 0.35 * map_.cell_mm();
    if (last_tip_mm_ && (tip_mm - *last_tip_mm_).norm() < engagement_step_mm) {
        return false;
    }
    remove_up_to(tip_mm, direction);
    set(look_ahead_.engagement(map_, tip_mm, direction));
    last_tip_mm_ = tip_mm;
    return true;
}

/// In straight pieces: the look-ahead sees nothing of what the tool covers now, so that two cells may wait.
void StockWorkpiece::remove_up_to(const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction) {
    if (last_tip_mm_) {
        const bool turned = (direction - removal_direction_).squaredNorm() > 0.03;  // 10°
        if (!turned && (tip_mm - removed_up_to_mm_).norm() < 2.0 * map_.cell_mm()) {
            return;
        }
        map_.remove(cutter_, removed_up_to_mm_, tip_mm);
    }
    removed_up_to_mm_ = tip_mm;
    removal_direction_ = direction;
}

namespace {

/// The strip of material in front of the cutter, across the feed: from `low` to `high`, positive towards φ = 0.
struct Strip {
    double low_mm;
    double high_mm;
};

Strip strip_of(estimation::CutSide side, double width_mm, double radius_mm, double centre_offset_mm) {
    switch (side) {
        case estimation::CutSide::up:
            return {radius_mm - width_mm, radius_mm};
        case estimation::CutSide::centred:
            return {centre_offset_mm - 0.5 * width_mm, centre_offset_mm + 0.5 * width_mm};
        case estimation::CutSide::down:
        case estimation::CutSide::unknown:
            break;
    }
    return {-radius_mm, -radius_mm + width_mm};
}

/// A tooth is at y = R cos φ.
double angle_at(double y_mm, double radius_mm) {
    return std::acos(std::clamp(y_mm / radius_mm, -1.0, 1.0));
}

}  // namespace

ProfileWorkpiece::ProfileWorkpiece(const ProfileSettings& settings, const Cutter& cutter, estimation::CutSide side,
                                   double centre_offset_mm)
    : settings_(settings), cutter_(cutter), side_(side), centre_offset_mm_(centre_offset_mm) {}

ProfilePoint ProfileWorkpiece::at(double path_mm) const {
    const auto& points = settings_.points;
    const auto after = std::upper_bound(points.begin(), points.end(), path_mm,
                                        [](double s, const ProfilePoint& point) { return s < point.path_mm; });
    if (after == points.begin()) {
        return {path_mm, 0.0, 0.0};
    }
    const ProfilePoint& low = *(after - 1);
    if (!settings_.linear || after == points.end()) {
        return low;
    }
    const double share = (path_mm - low.path_mm) / (after->path_mm - low.path_mm);
    return {path_mm, low.axial_depth_mm + (after->axial_depth_mm - low.axial_depth_mm) * share,
            low.radial_width_mm + (after->radial_width_mm - low.radial_width_mm) * share};
}

bool ProfileWorkpiece::move_to(const Eigen::Vector3d&, const Eigen::Vector3d&, double path_mm) {
    constexpr double step_mm = 0.02;
    if (last_path_mm_ >= 0.0 && std::abs(path_mm - last_path_mm_) < step_mm) {
        return false;
    }
    last_path_mm_ = path_mm;
    const ProfilePoint now = at(path_mm);
    const double radius = 0.5 * cutter_.diameter_mm;
    const Strip strip = strip_of(side_, now.radial_width_mm, radius, centre_offset_mm_);
    set(now.axial_depth_mm > 0.0
            ? uniform_engagement(angle_at(strip.high_mm, radius), angle_at(strip.low_mm, radius), now.axial_depth_mm)
            : EngagementMap{});
    return true;
}

std::unique_ptr<Workpiece> workpiece_of(const Scenario& scenario) {
    if (scenario.has_program()) {
        return std::make_unique<StockWorkpiece>(scenario.stock, scenario.cutter);
    }
    const auto& tool = scenario.parameters.tool;
    return std::make_unique<ProfileWorkpiece>(scenario.profile, scenario.cutter, tool.side,
                                              static_cast<double>(tool.centre_offset_mm));
}

}  // namespace millforce::sim
