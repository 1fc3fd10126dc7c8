// SPDX-License-Identifier: Apache-2.0
#include "bench_control/contenders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench_control/disturbance.hpp"
#include "bench_control/load_control.hpp"
#include "bench_control/load_rules.hpp"
#include "bench_control/text_file.hpp"
#include "loop/simulation.hpp"
#include "preview/clairvoyant.hpp"
#include "preview/memory.hpp"
#include "preview/preview.hpp"
#include "report/summary.hpp"
#include "report/trace_csv.hpp"

namespace millforce::sim {

namespace {

using enum Contender::Kind;
using enum Contender::Map;
using enum BenchMachine;

constexpr std::array all_contenders{
    Contender{"ours", "millforce, without a map", ours},
    Contender{"ours_told", "millforce, told a safe feed", ours, currents, none, true},
    Contender{"ours_spindle", "millforce, spindle current alone", ours, spindle_alone},
    Contender{"ours_vfd", "millforce, a converter's load alone", ours, converter},
    Contender{"ours_map", "millforce, map from geometry", ours, currents, geometry},
    Contender{"ours_map_told", "millforce, map, told a safe feed", ours, currents, geometry, true},
    Contender{"ours_map_spindle", "millforce, map, spindle current alone", ours, spindle_alone, geometry},
    Contender{"ours_map_vfd", "millforce, map, a converter's load alone", ours, converter, geometry},
    Contender{"ours_memory", "millforce, second part, by memory", ours, currents, memory},
    Contender{"constant_safe", "Constant feed, safe everywhere", safe_constant},
    Contender{"constant", "Constant feed, as searched", rival},
    Contender{"afc", "AFC (HEIDENHAIN)", rival},
    Contender{"haas", "Autofeed (Haas)", rival},
    Contender{"toolscope", "TS-AFC (ToolScope)", rival},
    Contender{"synfct", "SYNFCT (Siemens)", rival},
    Contender{"pid", "PID on the load (LinuxCNC)", rival},
    Contender{"plan", "the clairvoyant bound", bound},
};

constexpr std::array told_parameters{share_of_safe_feed, RuleParameter{"depth_step_share", 1.0, 2.0, 1.3}};
constexpr RuleDescription told_description{"ours_told", "millforce, told a safe feed", told_parameters};

const Scenario& drawn(const PreparedPart& part, BenchMachine machine) {
    return part.on_machine[static_cast<std::size_t>(machine)];
}

Scenario plant_of(const Contender& contender, const PreparedPart& part, const Disturbance& disturbance,
                  std::uint64_t seed) {
    return disturbed(drawn(part, contender.machine), disturbance, part.part.depth_mm, seed);
}

/// Of the same batch: machine, tool and steel are the same, but its blank lies as another one does.
host::PartMap memory_of_part_before(const Contender& contender, const PreparedPart& part, std::uint64_t seed) {
    constexpr std::uint64_t far_off = 1'000'000'000;
    const Disturbance other = drawn_disturbance(seed + far_off);
    Disturbance before = drawn_disturbance(seed);
    before.offset_x_mm = other.offset_x_mm;
    before.offset_y_mm = other.offset_y_mm;
    before.oversize = other.oversize;
    return memory_of(plant_of(contender, part, before, seed + far_off), largest_stock_offset_mm);
}

std::unique_ptr<OverrideSource> controller_of(const Contender& contender, const PreparedPart& part,
                                              const Scenario& plant, std::uint64_t seed, const RuleSettings& settings) {
    if (contender.kind == safe_constant) {
        return controller_named(constant_feed, plant.parameters, part.safe_ratio);
    }
    if (contender.kind == rival) {
        const TaughtFeed& taught = part.taught.find(contender.name)->second;
        return std::make_unique<LoadControl>(
            load_settings(plant, taught.feed_ratio, taught.load),
            make_rule(contender.name, settings.find(contender.name)->second, 0.5 * part.part.tool_diameter_mm));
    }
    firmware::Parameters<float> parameters = plant.parameters;
    if (contender.is_told) {
        const std::vector<double>& told = settings.find(told_description.name)->second;
        parameters.tool.control.safe_override = static_cast<float>(told[0] * part.safe_ratio);
        parameters.tool.control.depth_step_share = static_cast<float>(told[1]);
    }
    switch (contender.map) {
        case none:
            break;
        case geometry:
            return std::make_unique<MappedController>(parameters, part.map);
        case memory:
            return std::make_unique<MappedController>(parameters, memory_of_part_before(contender, part, seed));
    }
    return std::make_unique<MillforceController>(parameters);
}

/// The thickest chip that a tooth meets: f_z where the cut reaches the tool's front, else f_z sin φ at its edge.
double thickest_chip_mm(double feed_per_tooth_mm, double radial_immersion) {
    const double cosine = 1.0 - std::min(radial_immersion, 1.0);
    return feed_per_tooth_mm * std::sqrt(1.0 - cosine * cosine);
}

double rubbing_s(const RunResult& result, const PreparedPart& part) {
    const auto& tool = drawn(part, currents).parameters.tool;
    const double least_mm = static_cast<double>(tool.law.minimum_chip_thickness_mm);
    const double teeth_per_s = part.part.spindle_rpm / 60.0 * part.part.teeth;
    double sum_s = 0.0;
    double last_s = 0.0;
    for (const TracePoint& point : result.trace) {
        const bool is_cutting = std::isfinite(point.true_radial_immersion);
        if (is_cutting && thickest_chip_mm(point.feed_mm_s / teeth_per_s, point.true_radial_immersion) < least_mm) {
            sum_s += point.time_s - last_s;
        }
        last_s = point.time_s;
    }
    return sum_s;
}

BenchRun figures_of(const Contender& contender, const PreparedPart& part, std::uint64_t seed, const RunResult& result) {
    const RunFigures& figures = result.figures;
    BenchRun run;
    run.part = part.part.name;
    run.controller = contender.name;
    run.seed = seed;
    run.time_s = figures.time_s;
    run.cutting_time_s = figures.cutting_time_s;
    run.peak_over_limit = figures.peak_over_limit;
    run.revolutions_over = figures.time_over_limit_s * part.part.spindle_rpm / 60.0;
    run.teeth_broken = figures.teeth_broken;
    run.rubbing_s = rubbing_s(result, part);
    run.finished = figures.finished ? 1.0 : 0.0;
    return run;
}

RunResult controlled_run(const Contender& contender, const PreparedPart& part, const Scenario& plant,
                         std::uint64_t seed, const RuleSettings& settings) {
    SimulationSettings simulation;
    simulation.longest_run_s = part.longest_run_s;
    const auto controller = controller_of(contender, part, plant, seed, settings);
    return simulate(plant, *controller, std::string(contender.name), simulation).result;
}

}  // namespace

std::span<const Contender> contenders() {
    return all_contenders;
}

const Contender* contender_named(std::string_view name) {
    const auto* const found = std::ranges::find(all_contenders, name, &Contender::name);
    return found == all_contenders.end() ? nullptr : found;
}

std::vector<RuleDescription> described_controllers() {
    const auto rules = rule_descriptions();
    std::vector<RuleDescription> all(rules.begin(), rules.end());
    all.push_back(told_description);
    return all;
}

PreparedPart prepare(const std::filesystem::path& folder, const BenchPart& part) {
    write_part_files(folder, part);
    constexpr double patience = 4.0;
    PreparedPart prepared;
    prepared.part = part;
    for (const BenchMachine machine : {currents, spindle_alone, converter}) {
        prepared.on_machine[static_cast<std::size_t>(machine)] = read_bench_part(folder, part, machine);
    }
    const Scenario& scenario = drawn(prepared, currents);
    prepared.map = preview_within(scenario, largest_stock_offset_mm);
    prepared.safe_ratio = safe_constant_override(scenario);
    prepared.longest_run_s = patience * taught_cut(scenario, prepared.safe_ratio).time_s;
    return prepared;
}

void teach(PreparedPart& prepared, const RuleSettings& settings) {
    std::map<double, double> load_at;
    for (const RuleDescription& rule : rule_descriptions()) {
        const auto found = settings.find(rule.name);
        if (found == settings.end()) {
            continue;
        }
        const double feed_ratio = found->second.front() * prepared.safe_ratio;
        if (!load_at.contains(feed_ratio)) {
            load_at[feed_ratio] = taught_cut(drawn(prepared, currents), feed_ratio).load;
        }
        prepared.taught[std::string(rule.name)] = {feed_ratio, load_at[feed_ratio]};
    }
}

BenchRun run_contender(const Contender& contender, const PreparedPart& part, std::uint64_t seed,
                       const RuleSettings& settings, const std::filesystem::path& traces) {
    const Scenario plant = plant_of(contender, part, drawn_disturbance(seed), seed);
    const RunResult result =
        contender.kind == bound ? clairvoyant_run(plant) : controlled_run(contender, part, plant, seed, settings);
    if (!traces.empty()) {
        write_text_file(traces / fmt::format("{}_{}_{}.csv", part.part.name, contender.name, seed), trace_csv(result));
    }
    return figures_of(contender, part, seed, result);
}

}  // namespace millforce::sim
