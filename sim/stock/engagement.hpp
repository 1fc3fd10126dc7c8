#pragma once

#include <Eigen/Core>

#include "cutting/cutter.hpp"
#include "cutting/engagement_map.hpp"
#include "stock/height_map.hpp"

namespace millforce::sim {

/// Where a tool that stands with its tip at `tip_mm` and moves along `direction` (unit vector in machine axes) meets the
/// workpiece, in the feed frame.
///
/// For each angle φ the point is looked at that stands as far beside the axis as the periphery does, y = R cos φ, and so
/// far ahead that it clears the circle removed so far by most of a cell: x = √((R + m)² − y²), m = 0.8 cells. It is what
/// the tool is about to remove: within the width that it will sweep, so that no wall beside the tool is taken for
/// material in front of it, and not yet gnawed at by the removal at this position. At the sides of the cutter, where
/// chips are thin, it looks six cells ahead at the most.
/// A move along the axis alone engages no flank: plunge into drilled holes. A ball end is looked at in 24 heights.
EngagementMap engagement_at(const HeightMap& map, const Cutter& cutter, const Eigen::Vector3d& tip_mm,
                            const Eigen::Vector3d& direction);

/// The engagement in the terms of the estimators: the truth that they are judged against.
struct TrueEngagement {
    bool cutting = false;
    double entry_rad = 0.0;         ///< of the hull of all that is engaged
    double exit_rad = 0.0;
    double radial_immersion = 0.0;  ///< Σ (cos φ_st − cos φ_ex): width of the material in front of the tool over R
    double axial_depth_mm = 0.0;    ///< mean height, weighted with sin φ as the chip is
    int intervals = 0;              ///< separate stretches of engagement
};

TrueEngagement summarise(const EngagementMap& map);

}  // namespace millforce::sim
