// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "loop/override_source.hpp"
#include "loop/simulation.hpp"

namespace millforce::sim {

double safe_constant_override(const Scenario& scenario, double hardest, const SimulationSettings& settings) {
    Scenario hard = scenario;
    hard.deviation.cutting_force_scale *= hardest;
    const double exponent = 0.75;
    double ratio = 0.5;
    double best = 0.0;
    for (int round = 0; round < 5; ++round) {
        ConstantFeed constant(hard.parameters, ratio);
        const Simulated run = simulate(hard, constant, "constant", settings);
        if (run.interrupted) {
            return ratio;
        }
        const double share = run.result.figures.peak_over_limit;
        if (share <= 1.0) {
            best = std::max(best, ratio);
        }
        if (!(share > 0.0) || (share > 0.985 && share <= 1.0)) {
            break;
        }
        ratio = std::clamp(ratio * std::pow(0.995 / share, 1.0 / exponent), 0.01, 5.0);
    }
    return best > 0.0 ? best : ratio * 0.9;
}

}  // namespace millforce::sim
