// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "loop/scenario.hpp"
#include "stock/engagement.hpp"
#include "stock/height_map.hpp"

namespace millforce::sim {

/// What the tool meets as it moves: the engagement now, kept until the tool has moved on by a fraction of a cell.
class Workpiece {
  public:
    virtual ~Workpiece() = default;
    /// Takes the place of the tool; returns true where the engagement is another than before.
    virtual bool move_to(const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction, double path_mm) = 0;
    [[nodiscard]] const EngagementMap& engagement() const { return map_; }
    [[nodiscard]] const EngagementBounds& bounds() const { return bounds_; }
    [[nodiscard]] const TrueEngagement& truth() const { return truth_; }

  protected:
    void set(const EngagementMap& map);

  private:
    EngagementMap map_{};
    EngagementBounds bounds_{};
    TrueEngagement truth_{};
};

/// A block of stock with material removal.
class StockWorkpiece : public Workpiece {
  public:
    StockWorkpiece(const StockSettings& settings, const Cutter& cutter);
    /// The next place is that of another tool, wherever it is.
    void change_tool(const Cutter& cutter);
    bool move_to(const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction, double path_mm) override;

  private:
    void remove_up_to(const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction);

    Cutter cutter_;
    HeightMap map_;
    LookAhead look_ahead_;
    std::optional<Eigen::Vector3d> last_tip_mm_;
    Eigen::Vector3d removed_up_to_mm_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d removal_direction_ = Eigen::Vector3d::Zero();
};

/// Depth and width as functions of the path.
class ProfileWorkpiece : public Workpiece {
  public:
    ProfileWorkpiece(const ProfileSettings& settings, const Cutter& cutter, estimation::CutSide side,
                     double centre_offset_mm);
    bool move_to(const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction, double path_mm) override;

  private:
    [[nodiscard]] ProfilePoint at(double path_mm) const;

    ProfileSettings settings_;
    Cutter cutter_;
    estimation::CutSide side_;
    double centre_offset_mm_;
    double last_path_mm_ = -1.0;
};

/// The scenario's: stock where it has a part program, else its profile.
std::unique_ptr<Workpiece> workpiece_of(const Scenario& scenario);

}  // namespace millforce::sim
