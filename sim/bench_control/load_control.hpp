// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "bench_control/load_rules.hpp"
#include "loop/override_source.hpp"

namespace millforce::sim {

/// A load rule as it stands on a machine. While the spindle turns and the program waits, it learns the current of
/// idling; the load is smoothed over 50 ms.
class LoadControl : public OverrideSource {
  public:
    struct Settings {
        double feed_ratio = 1.0;  ///< F of the rule over the programmed feed
        double reference = 0.0;   ///< TaughtCut::load
        double rated_current_A = 1.0;
        double sample_rate_hz = 1000.0;
    };
    LoadControl(const Settings& settings, std::unique_ptr<LoadRule> rule)
        : settings_(settings), rule_(std::move(rule)) {}

    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override;
    void describe(TracePoint&) const override {}

    /// Since the program began.
    [[nodiscard]] double largest_load() const { return largest_load_; }

  private:
    [[nodiscard]] double smoothed_load(double current_A);

    Settings settings_;
    std::unique_ptr<LoadRule> rule_;
    int samples_ = 0;
    double idle_sum_A_ = 0.0;
    double smooth_A_ = 0.0;
    double largest_load_ = 0.0;
};

/// The teach-in: the part is cut once at F, in the steel and on the blank that were calibrated and drawn, and the
/// largest smoothed load is kept.
struct TaughtCut {
    double load = 0.0;
    double time_s = 0.0;
};
[[nodiscard]] TaughtCut taught_cut(const Scenario& scenario, double feed_ratio);

/// What a machine's file says for it.
[[nodiscard]] LoadControl::Settings load_settings(const Scenario& scenario, double feed_ratio, double reference);

}  // namespace millforce::sim
