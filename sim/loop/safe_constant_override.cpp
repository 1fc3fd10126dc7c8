// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "cutting/revolution_load.hpp"
#include "loop/simulation.hpp"

namespace millforce::sim {

namespace {

constexpr double smallest_ratio = 0.01;
constexpr double largest_ratio = 5.0;
constexpr double smallest_share = 0.96;  // of the limit, used by the feed that is taken

class SteadyOverride : public OverrideSource {
  public:
    explicit SteadyOverride(double ratio) : ratio_(static_cast<float>(ratio)) {}
    hal::FeedOverride step(const hal::DriveSample&, const hal::ProgramStatus& program) override {
        hal::FeedOverride output;
        output.ratio = program.rapid ? 1.0F : ratio_;
        output.hold = false;
        return output;
    }
    void describe(TracePoint&) const override {}

  private:
    float ratio_;
};

/// The factor on the feed under which the hardest cut loads its tooth with `tooth_force_N`. The force law gives the
/// ratio of two forces; the force itself is the one that was met. It grows with the feed, so halving finds it.
double feed_factor(const CuttingForce& force, const HardestCut& cut, double tooth_force_N) {
    const auto peak_N = [&](double factor) {
        return revolution_load(force, factor * cut.feed_per_tooth_mm, cut.engagement).peak_tooth_N;
    };
    const double wanted_N = peak_N(1.0) * tooth_force_N / cut.tooth_force_N;
    double low = smallest_ratio / largest_ratio;
    double high = largest_ratio / smallest_ratio;
    while (high > 1.001 * low) {
        const double middle = std::sqrt(low * high);
        (peak_N(middle) < wanted_N ? low : high) = middle;
    }
    return low;
}

/// Each round makes half of the progress that was left: how many there will be is not known.
SimulationSettings settings_of_round(const SimulationSettings& settings, int round) {
    SimulationSettings of_round = settings;
    if (settings.progress) {
        const double left = std::ldexp(1.0, -round);
        of_round.progress = [&settings, left](double share) {
            return settings.progress(1.0 - left + 0.5 * left * share);
        };
    }
    return of_round;
}

}  // namespace

double safe_constant_override(const Scenario& scenario, double hardest, const SimulationSettings& settings) {
    Scenario hard = scenario;
    hard.deviation.cutting_force_scale *= hardest;
    const Scenario plant = deviated(hard, hard.deviation, hard.seed);
    const CuttingForce force(plant.cutter, plant.coefficients, plant.cutting_options);
    const double limit_N = static_cast<double>(scenario.parameters.tool.tooth_force_limit_N);
    double ratio = 1.0;
    double safe_ratio = 0.0;
    // The first run finds the hardest cut, the second confirms the feed. More are needed where another feed has another
    // hardest cut.
    for (int round = 0; round < 4; ++round) {
        SteadyOverride steady(ratio);
        const Simulated run = simulate(hard, steady, "constant", settings_of_round(settings, round));
        const double share = run.hardest_cut.tooth_force_N / limit_N;
        if (run.interrupted || !(share > 0.0)) {
            return ratio;
        }
        if (share <= 1.0) {
            safe_ratio = std::max(safe_ratio, ratio);
        }
        if (share > smallest_share && share <= 1.0) {
            break;
        }
        const double wanted_N = 0.5 * (smallest_share + 1.0) * limit_N;
        ratio = std::clamp(ratio * feed_factor(force, run.hardest_cut, wanted_N), smallest_ratio, largest_ratio);
    }
    return safe_ratio > 0.0 ? safe_ratio : 0.9 * ratio;
}

}  // namespace millforce::sim
