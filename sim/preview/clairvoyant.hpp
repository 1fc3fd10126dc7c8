// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "loop/override_source.hpp"
#include "loop/scenario.hpp"
#include "part_map/path_position.hpp"

namespace millforce::sim {

/// The feed of one who knows the true cut everywhere: at each place the one at which the plant's own law, with its
/// coefficients and its runout, puts the highest tooth at `share` of its limit, at most override_max; and no faster
/// than lets the machine brake to each place ahead. What no controller can undercut by more than the law's own error,
/// if the limit is to hold. Knows neither noise nor latency: clairvoyant_run() takes the latter out.
class ClairvoyantFeed : public OverrideSource {
  public:
    /// Throws InputError. Cost: three revolutions of the force law for each change of the cut, 1 to 2 ms.
    explicit ClairvoyantFeed(const Scenario& scenario, double share = 1.0);

    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override;
    void describe(TracePoint&) const override {}

    /// Of the plan, mm/s; infinite behind its end.
    [[nodiscard]] double feed_at(double path_mm) const;

  private:
    struct Place {
        double path_mm;
        double feed_mm_s;
    };

    void lower_to_neighbours();
    void brake_in_time(double acceleration_mm_s2);

    std::vector<Place> plan_;
    host::PathPosition position_;
};

/// The scenario milled so, on a CNC that answers at once.
[[nodiscard]] RunResult clairvoyant_run(const Scenario& scenario);

}  // namespace millforce::sim
