// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench_control/contenders.hpp"

namespace millforce::sim {

/// What settings are chosen by: as fast as can be at the safety that is asked of all: no broken tooth, and the 95th
/// percentile of the peaks at or below 105 % of the limit. Mean of ln time, plus 20 for each unit beyond
/// 1.05, plus 2 for each share of runs with a broken tooth or not finished. Needs at least one run.
[[nodiscard]] double tuning_cost(const std::vector<BenchRun>& runs);

/// The plants that settings are chosen on.
struct TrainingPlants {
    std::uint64_t first_seed = 1;
    int seeds = 1;
    unsigned threads = 1;
};

/// Chooses the settings of one controller on these parts: its own F, at which it is taught anew each time, and the rest
/// of its parameters. `evaluations` is for each of its parameters. `progress`: the share that is done.
[[nodiscard]] std::vector<double> tuned_settings(const RuleDescription& controller, std::vector<PreparedPart>& parts,
                                                 const TrainingPlants& plants, int evaluations,
                                                 const std::function<void(double share)>& progress);

/// The settings that the program brings along: tuned.toml, of the form that `millforce bench control --tune` writes.
[[nodiscard]] RuleSettings built_in_settings();
/// A file of the same form. Throws InputError.
[[nodiscard]] RuleSettings read_settings(const std::string& file);
[[nodiscard]] std::string settings_text(const RuleSettings& settings, const std::string& origin);

}  // namespace millforce::sim
