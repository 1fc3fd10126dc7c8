// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench_control/contenders.hpp"

namespace millforce::sim {

/// What the settings of a rule are chosen by: as fast as it can be at the safety that is asked of all: no broken tooth,
/// and the 95th percentile of the peaks at or below 105 % of the limit. Mean of ln time, plus 20 for each unit beyond
/// 1.05, plus 2 for each share of runs with a broken tooth or not finished. Needs at least one run.
[[nodiscard]] double tuning_cost(const std::vector<BenchRun>& runs);

/// Chooses the settings of all rules on these parts, with the plants of these seeds: the constant feed first, for all
/// others drive on it. The parts are taught again for it. `progress`: what is being done, and its share.
[[nodiscard]] RuleSettings tuned_settings(std::vector<PreparedPart>& parts, std::uint64_t first_seed, int seeds,
                                          unsigned threads, int evaluations,
                                          const std::function<void(const std::string& rule, double share)>& progress);

/// The settings that the program brings along: tuned.toml, of the form that `millforce bench control --tune` writes.
[[nodiscard]] RuleSettings built_in_settings();
/// A file of the same form. Throws InputError.
[[nodiscard]] RuleSettings read_settings(const std::string& file);
[[nodiscard]] std::string settings_text(const RuleSettings& settings, const std::string& origin);

}  // namespace millforce::sim
