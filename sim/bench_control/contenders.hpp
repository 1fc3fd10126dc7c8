// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench_control/part_files.hpp"
#include "bench_control/parts.hpp"
#include "loop/scenario.hpp"
#include "part_map/part_map.hpp"

namespace millforce::sim {

/// A controller on its machine. A controller with a load rule runs on the machine with all currents.
struct Contender {
    enum class Kind : std::uint8_t { ours, rival, bound };

    std::string_view name;
    std::string_view title;
    Kind kind;
    BenchMachine machine = BenchMachine::currents;
    bool has_map = false;  ///< from geometry: program, drawn blank, tool
    /// depth_step_share of ours that is told the constant feed on which the load controls drive; 0: it is not.
    float share_in_a_step = 0.0F;
};

/// Ours, the rules of load_rules.hpp by their names, and "plan", the clairvoyant bound.
[[nodiscard]] std::span<const Contender> contenders();
/// nullptr where there is none of that name.
[[nodiscard]] const Contender* contender_named(std::string_view name);

/// The settings of each rule, by its name, in the order of its parameters.
using RuleSettings = std::map<std::string, std::vector<double>, std::less<>>;

/// A part with what is worked out once for all its runs.
struct PreparedPart {
    BenchPart part;
    std::array<Scenario, 3> on_machine;  ///< by BenchMachine
    host::PartMap map;
    double safe_ratio = 0.0;   ///< largest constant feed over F that is safe for a K_s 30 % higher, on the drawn blank
    double feed_ratio = 0.0;   ///< F of the rules
    double taught_load = 0.0;  ///< largest load at that F
    double longest_run_s = 0.0;  ///< a run that takes so long is given up
};

/// Writes the part's files into the folder and works out what all its runs need: four simulations as a rule. Throws
/// InputError.
[[nodiscard]] PreparedPart prepare(const std::filesystem::path& folder, const BenchPart& part);
/// F and its teach-in, again for another share of the safe feed. One simulation.
void teach(PreparedPart& prepared, double feed_share);

/// The figures of one run.
struct BenchRun {
    std::string part;
    std::string controller;
    std::uint64_t seed = 0;
    double time_s = 0.0;
    double cutting_time_s = 0.0;
    double peak_over_limit = 0.0;
    double revolutions_over = 0.0;  ///< with a tooth above its limit
    double teeth_broken = 0.0;
    double rubbing_s = 0.0;  ///< in cut, the thickest chip of a tooth thinner than the tool's least chip thickness
    double finished = 1.0;   ///< 1, or 0 where it stopped or took too long

    bool operator==(const BenchRun&) const = default;
};

/// One part, one plant, one controller. Deterministic. A few tenths of a second. Where `traces` names an existing
/// folder, the run's trace goes there as PART_CONTROLLER_SEED.csv; the bound has none. Throws InputError where it
/// cannot be written.
[[nodiscard]] BenchRun run_contender(const Contender& contender, const PreparedPart& part, std::uint64_t seed,
                                     const RuleSettings& settings, const std::filesystem::path& traces = {});

}  // namespace millforce::sim
