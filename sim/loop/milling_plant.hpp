// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>

#include "loop/run_judge.hpp"
#include "loop/scenario.hpp"
#include "loop/workpiece.hpp"
#include "machine/machine_plant.hpp"

namespace millforce::sim {

/// How far and in which direction the tool has gone while the spindle turned by a given angle, up to now. Looked up by
/// the spindle's angle, for the spindle slows down under a tooth.
class FeedHistory {
  public:
    explicit FeedHistory(double angle_rad) : angle_rad_(angle_rad) {}

    void add(double angle_rad, const Eigen::Vector3d& position_mm) {
        newest_ = (newest_ + 1) % places_.size();
        places_[newest_] = {angle_rad, position_mm};
        filled_ = std::min(filled_ + 1, places_.size());
        if (behind_ == newest_) {
            behind_ = after(behind_);
        }
    }
    /// From where the tool stood to where it stands; extended in proportion while the spindle has turned by less.
    [[nodiscard]] Eigen::Vector3d way_mm() {
        const double then_rad = places_[newest_].angle_rad - angle_rad_;
        if (filled_ < places_.size()) {
            behind_ = (newest_ + places_.size() + 1 - filled_) % places_.size();
        }
        while (after(behind_) != newest_ && places_[after(behind_)].angle_rad <= then_rad) {
            behind_ = after(behind_);
        }
        const Place& now = places_[newest_];
        const Place& from = places_[behind_];
        const Place& to = places_[after(behind_)];
        const double turned_rad = now.angle_rad - from.angle_rad;
        if (filled_ < 3 || !(turned_rad > 0.0)) {
            return Eigen::Vector3d::Zero();
        }
        if (turned_rad < angle_rad_) {
            return (now.position_mm - from.position_mm) * (angle_rad_ / turned_rad);
        }
        const double step_rad = to.angle_rad - from.angle_rad;
        const double share = step_rad > 0.0 ? std::min((then_rad - from.angle_rad) / step_rad, 1.0) : 0.0;
        return now.position_mm - (from.position_mm + share * (to.position_mm - from.position_mm));
    }

  private:
    struct Place {
        double angle_rad = 0.0;
        Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
    };
    [[nodiscard]] std::size_t after(std::size_t place) const { return (place + 1) % places_.size(); }

    double angle_rad_;
    std::array<Place, 1024> places_{};
    std::size_t newest_ = 0;
    std::size_t behind_ = 1;
    std::size_t filled_ = 0;
};

/// The engagement and the feed under which a tooth carried most.
struct HardestCut {
    double tooth_force_N = 0.0;
    double feed_per_tooth_mm = 0.0;
    EngagementMap engagement{};
};

/// Drives, tool and workpiece under a CNC's command: command → drives → engagement → cutting force → drives. Whose the
/// command is does not matter: the simulated CNC's, or that of a real one.
class MillingPlant {
  public:
    /// The machine is the scenario's with its deviation.
    explicit MillingPlant(const Scenario& scenario);

    struct Command {
        Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
        Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< direction of the path; zero: at rest
        double feed_mm_s = 0.0;
        double programmed_feed_mm_s = 0.0;
        double path_mm = 0.0;  ///< commanded, since the start
        bool is_rapid = false;
        double spindle_speed_rad_s = 0.0;
        double override_ratio = 0.0;  ///< for the record
    };

    /// Spindle at speed, axes standing.
    void start_at(const Eigen::Vector3d& position_mm, double spindle_speed_rad_s);
    /// The edges have worn: factors on the scenario's coefficients, of the chip's section and of the edges' length.
    void set_wear(double of_section, double of_edge);
    void set_clock(double time_s) { machine_.set_clock(time_s); }
    void advance(double dt_s, const Command& command);
    /// The machine alone, away from the workpiece: nothing is cut, and nothing is judged.
    void idle(double dt_s, const MachinePlant::Command& command) { machine_.advance(dt_s, command, {}); }

    [[nodiscard]] hal::DriveSample sample() { return machine_.sample(); }
    [[nodiscard]] const MachinePlant& machine() const { return machine_; }
    [[nodiscard]] double time_s() const { return machine_.time_s(); }
    [[nodiscard]] const CuttingLoad& load() const { return cutting_load_; }  ///< load of the last step
    [[nodiscard]] const HardestCut& hardest_cut() const { return hardest_cut_; }
    [[nodiscard]] RunJudge& judge() { return judge_; }

  private:
    void cut(double dt_s, double feed_per_tooth_mm);

    Scenario scenario_;
    MachinePlant machine_;
    CuttingForce cutting_;
    std::unique_ptr<Workpiece> workpiece_;
    FeedHistory since_tooth_before_;                       ///< the chip is what that tooth left
    FeedHistory since_last_revolution_;                    ///< over it the axes' shaking under the teeth cancels out
    Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();  ///< the tool goes in it
    RunJudge judge_;
    MachinePlant::Load load_{};
    CuttingLoad cutting_load_{};
    HardestCut hardest_cut_{};
    double path_mm_ = 0.0;
    double peak_total_N_ = 0.0;
};

}  // namespace millforce::sim
