// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "cutting/cutting_force.hpp"
#include "loop/override_source.hpp"
#include "loop/scenario.hpp"
#include "report/run_result.hpp"
#include "stock/engagement.hpp"

namespace millforce::sim {

/// Watches a run from outside: it sees the plant's truth at every step and the controller's estimates, writes the trace
/// and works out the figures. Nothing of it reaches the controller.
class RunJudge {
  public:
    struct Motion {
        Eigen::Vector3d position_mm;
        double feed_mm_s;
        double path_mm;
        double programmed_feed_mm_s;
        bool rapid;
        double spindle_speed_rad_s;
        double override_ratio;
    };

    explicit RunJudge(const Scenario& scenario);

    void observe(double dt_s, const Motion& motion, const CuttingLoad& load, const TrueEngagement& truth);
    void observe_peak(double total_in_plane_N) { peak_total_N_ = std::max(peak_total_N_, total_in_plane_N); }
    void follow(double time_s, const hal::FeedOverride& output, const TraceSource& controller, double trace_interval_s);

    /// A latched fault has stopped the feed: the run is over.
    [[nodiscard]] bool fault_stopped() const { return stopped_s_ > 2.0; }
    [[nodiscard]] RunResult result(const std::string& controller, bool finished) const;

  private:
    void close_interval(double time_s, const hal::FeedOverride& output, const TraceSource& controller);
    void judge_estimate(const TracePoint& point);
    void close_revolution(bool cutting);
    [[nodiscard]] bool engagement_has_grown(double within_s) const;
    void count_teeth(const CuttingLoad& load);

    double limit_N_;
    double break_N_;
    double latency_s_;  // of the override, and of a load that comes late
    double acceleration_mm_s2_;
    std::size_t teeth_;
    RunResult result_;

    double interval_angle_rad_ = 0.0;
    double interval_s_ = 0.0;
    double interval_cutting_s_ = 0.0;
    double torque_sum_ = 0.0;
    double feed_force_sum_ = 0.0;
    double immersion_sum_ = 0.0;
    double depth_sum_ = 0.0;
    double peak_tooth_N_ = 0.0;
    double peak_total_N_ = 0.0;
    double radius_mm_;
    Motion motion_{};

    /// The largest chip section (width × depth in front of the tool) of each of the last revolutions.
    struct Revolution {
        double duration_s = 0.0;
        double section_mm2 = 0.0;
    };
    std::array<Revolution, 16> revolutions_{};
    std::size_t revolution_count_ = 0;
    double section_mm2_ = 0.0;

    double revolution_peak_N_ = 0.0;
    double revolution_rad_ = 0.0;
    double revolution_s_ = 0.0;
    double over_since_s_ = 0.0;
    std::array<bool, Cutter::max_teeth> broken_{};
    double use_sum_ = 0.0;
    double override_sum_ = 0.0;
    double stopped_s_ = 0.0;
    double stopped_at_mm_ = 0.0;

    /// Root of the mean square error, over that of the truth.
    class RelativeError {
      public:
        void add(double estimate, double truth) {
            if (std::isfinite(estimate)) {
                error2_ += (estimate - truth) * (estimate - truth);
                truth2_ += truth * truth;
            }
        }
        [[nodiscard]] double value() const { return truth2_ > 0.0 ? std::sqrt(error2_ / truth2_) : host::no_estimate; }

      private:
        double error2_ = 0.0;
        double truth2_ = 0.0;
    };
    RelativeError tangential_error_;
    RelativeError feed_force_error_;
    double immersion_error2_ = 0.0;
    double depth_error2_ = 0.0;
    int immersion_samples_ = 0;
    int depth_samples_ = 0;
    int immersion_inside_ = 0;
    int depth_inside_ = 0;
    int cutting_samples_ = 0;
};

}  // namespace millforce::sim
