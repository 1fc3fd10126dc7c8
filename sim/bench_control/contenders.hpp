// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench_control/load_rules.hpp"
#include "bench_control/part_files.hpp"
#include "bench_control/parts.hpp"
#include "loop/scenario.hpp"
#include "part_map/part_map.hpp"

namespace millforce::sim {

/// A controller on its machine. A controller with a load rule runs on the machine with all currents.
struct Contender {
    enum class Kind : std::uint8_t { ours, rival, safe_constant, bound };
    enum class Map : std::uint8_t {
        none,
        geometry,  ///< of program, drawn blank and tool
        memory,    ///< what the part before left behind, milled without a map
    };

    std::string_view name;
    std::string_view title;
    Kind kind;
    BenchMachine machine = BenchMachine::currents;
    Map map = Map::none;
    bool is_told = false;  ///< ours that is told a feed, and how far beyond it
};

/// Ours, the rules of load_rules.hpp by their names, "constant_safe", the constant feed that is safe for a K_s 30 %
/// higher, and "plan", the clairvoyant bound.
[[nodiscard]] std::span<const Contender> contenders();
/// nullptr where there is none of that name.
[[nodiscard]] const Contender* contender_named(std::string_view name);

/// All that have settings: the load rules, and ours that is told a safe feed, "ours_told": feed_share, its
/// safe_override as a share of the constant feed that is safe for a K_s 30 % higher, and depth_step_share.
[[nodiscard]] std::vector<RuleDescription> described_controllers();

/// The settings of each of them, by its name, in the order of its parameters.
using RuleSettings = std::map<std::string, std::vector<double>, std::less<>>;

/// F of a load rule, and what it was taught at that F.
struct TaughtFeed {
    double feed_ratio = 0.0;
    double load = 0.0;
};

/// A part with what is worked out once for all its runs.
struct PreparedPart {
    BenchPart part;
    std::array<Scenario, 3> on_machine;  ///< by BenchMachine
    host::PartMap map;
    double safe_ratio = 0.0;  ///< largest constant feed over F that is safe for a K_s 30 % higher, on the drawn blank
    double longest_run_s = 0.0;  ///< a run that takes so long is given up: four times that at the safe feed
    std::map<std::string, TaughtFeed, std::less<>> taught;  ///< by the name of the load rule
};

/// Writes the part's files into the folder and works out what all its runs need: five simulations as a rule. Throws
/// InputError.
[[nodiscard]] PreparedPart prepare(const std::filesystem::path& folder, const BenchPart& part);
/// The teach-in of each load rule that has settings, at its feed_share. A simulation for each feed_share.
void teach(PreparedPart& prepared, const RuleSettings& settings);

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
