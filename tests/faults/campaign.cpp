// SPDX-License-Identifier: Apache-2.0
#include "faults/campaign.hpp"

#include <algorithm>
#include <cmath>

#include "loop/bounds.hpp"
#include "loop/ensemble.hpp"
#include "loop/simulation.hpp"
#include "sim/without_axis_currents.hpp"

namespace millforce::faults {

namespace {

sim::RunFigures mill(const Part& part, std::uint64_t seed, const FaultyMachine::Settings& settings,
                     FaultyMachine::Reaction& reaction) {
    sim::Scenario scenario = part.scenario;
    scenario.seed = seed;
    scenario.deviation = sim::drawn_deviation(scenario, seed);
    sim::MillforceController controller(part.stated);
    FaultyMachine machine(controller, settings);
    sim::SimulationSettings stopped_early;  // where the feed is held for good
    stopped_early.longest_run_s = part.duration_s > 0.0 ? 1.5 * part.duration_s : stopped_early.longest_run_s;
    const sim::RunFigures figures = sim::simulate(scenario, machine, "millforce", stopped_early).result.figures;
    reaction = machine.reaction();
    return figures;
}

}  // namespace

Part part_named(const std::string& name, bool spindle_alone) {
    Part part{.scenario = sim::read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/" + name + ".toml")};
    part.stated = spindle_alone ? test::without_axis_currents(part.scenario.parameters) : part.scenario.parameters;
    FaultyMachine::Reaction none;
    part.duration_s = mill(part, part.scenario.seed, {}, none).time_s;
    return part;
}

Outcome mill_with(const Part& part, SignalFault fault, std::uint64_t seed) {
    constexpr double spindle_start_s = 2.0;  // of a simulation, before the program begins
    std::mt19937_64 random(seed);
    const double begins_s = spindle_start_s + std::uniform_real_distribution(0.0, part.duration_s)(random);
    const auto rated_A = static_cast<double>(part.stated.machine.spindle_rated_current_A);
    Outcome outcome;
    const sim::RunFigures figures = mill(
        part, seed, {.fault = fault, .begins_s = begins_s, .spindle_rated_A = rated_A, .seed = seed}, outcome.reaction);
    outcome.peak_over_limit = figures.peak_over_limit;
    outcome.teeth_broken = figures.teeth_broken;
    return outcome;
}

void Tally::add(const Outcome& outcome) {
    if (!outcome.reaction.has_begun) {
        return;
    }
    ++runs;
    broken_parts += outcome.teeth_broken > 0 ? 1 : 0;
    over += outcome.peak_over_limit > sim::largest_peak_over_limit ? 1 : 0;
    faults += outcome.reaction.fault != 0 ? 1 : 0;
    largest_peak = std::max(largest_peak, outcome.peak_over_limit);
    if (outcome.reaction.has_reacted) {
        reactions_s.push_back(outcome.reaction.after_s);
    }
}

double Tally::median_reaction_s() const {
    std::vector<double> sorted = reactions_s;
    std::sort(sorted.begin(), sorted.end());
    return sorted.empty() ? std::nan("") : sorted[sorted.size() / 2];
}

double Tally::longest_reaction_s() const {
    return reactions_s.empty() ? std::nan("") : *std::max_element(reactions_s.begin(), reactions_s.end());
}

}  // namespace millforce::faults
