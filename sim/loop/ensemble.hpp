// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "loop/simulation.hpp"
#include "part_map/part_map.hpp"

/// The same scenario many times, each with another plant: what the parameter files call uncertain is drawn as they say.
/// A band of 95 % promises to hold in 95 % of what may be met, and not in one run, whose K_s is what it is.

namespace millforce::sim {

/// Draws how a plant differs from what the controller believes, from the deviations that its parameters state:
/// K_s and r_1 log-normal (K_s_relative_sd, r_1_relative_sd), their exponents normal (…_exponent_sd), friction normal
/// (friction_relative_sd), torque and force constants normal (gain_relative_sd). Deterministic in `seed`.
[[nodiscard]] PlantDeviation drawn_deviation(const Scenario& scenario, std::uint64_t seed);

struct EnsembleFigures {
    int runs = 0;
    int unfinished = 0;
    int teeth_broken = 0;
    double peak_over_limit_median = 0.0;
    double peak_over_limit_95 = 0.0;  ///< the peak that 95 % of the runs stay at or below
    double peak_over_limit_worst = 0.0;
    double late_over_limit_s_worst = 0.0;  ///< see RunFigures
    double time_s_mean = 0.0;
    double tangential_error = host::no_estimate;  ///< rms over the runs, as are the other errors
    double feed_force_error = host::no_estimate;
    double estimate_share = 0.0;  ///< share of the time in cut: with an immersion
    double immersion_rms = host::no_estimate;
    double immersion_coverage = host::no_estimate;  ///< mean over the runs
    double depth_share = 0.0;                       ///< share of the time in cut: with a depth
    double depth_rms_mm = host::no_estimate;
    double depth_coverage = host::no_estimate;
};

/// What all runs of an ensemble have in common beside the scenario.
struct EnsembleSettings {
    std::optional<host::PartMap> map;  ///< what the controllers look ahead with
    double longest_run_s = SimulationSettings{}.longest_run_s;
};

/// Runs `runs` plants with seeds scenario.seed, +1, … on all processors; the result does not depend on their number.
/// `progress` is called from this thread with the share done; false stops, and what is done by then is returned.
[[nodiscard]] std::vector<RunFigures> run_ensemble(const Scenario& scenario, int runs,
                                                   const std::function<bool(double share)>& progress = {},
                                                   const EnsembleSettings& settings = {});

[[nodiscard]] EnsembleFigures summarise_ensemble(const std::vector<RunFigures>& runs);

}  // namespace millforce::sim
