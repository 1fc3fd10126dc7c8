// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cutting/cutter.hpp"
#include "cutting/engagement_map.hpp"
#include "stock/height_map.hpp"

namespace millforce::sim {

/// Where a tool meets the workpiece, in the feed frame: for each angle φ a point is looked at that stands as far beside
/// the axis as the periphery does, y = R cos φ, and so far ahead that it clears the circle removed so far by a cell:
/// x = √((R + m)² − y²), m = 1 cell. It is what the tool is about to remove: within the width that it will sweep, so
/// that no wall beside the tool is taken for material in front of it, and not yet gnawed at by the removal at this
/// position. So everything is seen early: an entry, an exit or a corner by one cell of path in front of the tool, and
/// by up to six cells at its sides, where chips are thin.
///
/// Resolution: the width of a cut to 0.2 cells. A stretch of material narrower than a quarter of a cell across the feed
/// is taken for the grain of a finished wall and left out; a cut that thin needs smaller cells.
/// A move along the axis alone engages no flank: plunge into drilled holes. A ball end is looked at in 24 heights.
class LookAhead {
  public:
    /// `cell_mm`: of the height maps that it is used with.
    LookAhead(const Cutter& cutter, double cell_mm);

    /// The tool stands with its tip at `tip_mm` and moves along `direction` (unit vector in machine axes). The map
    /// holds the state after the removal at this position, or up to two cells of path before it.
    [[nodiscard]] EngagementMap engagement(const HeightMap& map, const Eigen::Vector3d& tip_mm,
                                           const Eigen::Vector3d& direction) const;

  private:
    /// The points at one height above the tip: (in front of the axis, left of it).
    struct Ring {
        double height_mm;
        std::array<Eigen::Vector2d, EngagementMap::bin_count / 2> points_mm;
    };

    [[nodiscard]] Ring ring(double height_mm, double radius_mm) const;
    [[nodiscard]] EngagementMap::Bin flat_bin(const HeightMap::Material& material, double tip_z_mm, double sine) const;
    template <typename MaterialAt>
    [[nodiscard]] EngagementMap::Bin ball_bin(const MaterialAt& material_at, double tip_z_mm) const;

    double cell_mm_;
    Cutter cutter_;
    std::vector<Ring> rings_;
};

/// The engagement in the terms of the estimators: the truth that they are judged against. Material of less than 2 % of
/// the greatest height is left out: the floor's skin, which the end scrapes off, is no width of cut.
struct TrueEngagement {
    bool cutting = false;
    double entry_rad = 0.0;  ///< entry of the hull of all that is engaged
    double exit_rad = 0.0;
    double radial_immersion = 0.0;  ///< Σ (cos φ_st − cos φ_ex): width of the material in front of the tool over R
    double axial_depth_mm = 0.0;    ///< mean height, weighted with sin φ as the chip is
    int intervals = 0;              ///< separate stretches of engagement
};

TrueEngagement summarise(const EngagementMap& map);

/// A stretch of engagement of one height.
struct UniformArc {
    double entry_rad = 0.0;
    double exit_rad = 0.0;
    double height_mm = 0.0;  ///< weighted with sin φ as the chip is
};

/// What is engaged as arcs, the same material as in summarise(): another arc begins at a gap, and where the height
/// differs by a tenth from that of the arc so far. In the order of φ.
std::vector<UniformArc> uniform_arcs(const EngagementMap& map);

}  // namespace millforce::sim
