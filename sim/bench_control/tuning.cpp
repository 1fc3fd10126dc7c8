// SPDX-License-Identifier: Apache-2.0
#include "bench_control/tuning.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "bench_control/bench_assets.hpp"
#include "bench_control/bench_table.hpp"
#include "bench_control/load_rules.hpp"
#include "bench_control/optimiser.hpp"
#include "bench_control/parallel.hpp"
#include "files/toml_reader.hpp"
#include "files/toml_writer.hpp"

namespace millforce::sim {

double tuning_cost(const std::vector<BenchRun>& runs) {
    constexpr double highest_peak_95 = 1.05;
    double ln_time = 0.0;
    double failed = 0.0;
    std::vector<double> peaks;
    for (const BenchRun& run : runs) {
        ln_time += std::log(run.time_s);
        failed += run.teeth_broken > 0.0 || run.finished < 0.5 ? 1.0 : 0.0;
        peaks.push_back(run.peak_over_limit);
    }
    const auto count = static_cast<double>(runs.size());
    return ln_time / count + 20.0 * std::max(quantile(peaks, 0.95) - highest_peak_95, 0.0) + 2.0 * failed / count;
}

namespace {

std::vector<SearchRange> ranges_of(const RuleDescription& rule) {
    std::vector<SearchRange> ranges;
    for (const RuleParameter& parameter : rule.parameters) {
        ranges.push_back({parameter.low, parameter.high, parameter.start});
    }
    return ranges;
}

/// Of a controller with these settings, on each part with each plant.
double cost_of(const RuleDescription& controller, const std::vector<double>& values, std::vector<PreparedPart>& parts,
               const TrainingPlants& plants) {
    const RuleSettings settings{{std::string(controller.name), values}};
    const auto seeds = static_cast<std::size_t>(plants.seeds);
    std::vector<BenchRun> runs(parts.size() * seeds);
    const auto show_nothing = [](double) {};
    run_parallel(
        parts.size(), plants.threads, [&](std::size_t k) { teach(parts[k], settings); }, show_nothing);
    run_parallel(
        runs.size(), plants.threads,
        [&](std::size_t k) {
            runs[k] = run_contender(*contender_named(controller.name), parts[k / seeds], plants.first_seed + k % seeds,
                                    settings);
        },
        show_nothing);
    return tuning_cost(runs);
}

RuleSettings settings_in(host::TomlFile file) {
    host::TomlFile::Table root = file.root();
    RuleSettings settings;
    for (const RuleDescription& rule : described_controllers()) {
        host::TomlFile::Table table = root.table(std::string(rule.name));
        std::vector<double>& values = settings[std::string(rule.name)];
        for (const RuleParameter& parameter : rule.parameters) {
            values.push_back(table.number(std::string(parameter.name), parameter.low, parameter.high));
        }
        table.reject_unknown_keys();
    }
    root.reject_unknown_keys();
    return settings;
}

}  // namespace

std::vector<double> tuned_settings(const RuleDescription& controller, std::vector<PreparedPart>& parts,
                                   const TrainingPlants& plants, int evaluations,
                                   const std::function<void(double)>& progress) {
    const int in_all = evaluations * static_cast<int>(controller.parameters.size());
    int done = 0;
    return minimise(
               [&](const std::vector<double>& values) {
                   progress(std::min(static_cast<double>(done++) / in_all, 1.0));
                   return cost_of(controller, values, parts, plants);
               },
               ranges_of(controller), in_all)
        .at;
}

RuleSettings built_in_settings() {
    return settings_in(host::TomlFile::from_text(std::string(bench_assets::tuned_settings()), "tuned.toml"));
}

RuleSettings read_settings(const std::string& file) {
    return settings_in(host::TomlFile::open(file));
}

std::string settings_text(const RuleSettings& settings, const std::string& origin) {
    std::ostringstream text;
    text << "# SPDX-License-Identifier: Apache-2.0\n";
    host::TomlWriter toml(text);
    toml.comment(origin);
    for (const RuleDescription& rule : described_controllers()) {
        toml.table(rule.name);
        const std::vector<double>& values = settings.find(rule.name)->second;
        for (std::size_t k = 0; k < values.size(); ++k) {
            toml.key(rule.parameters[k].name, std::round(values[k] * 1e4) / 1e4);
        }
    }
    return text.str();
}

}  // namespace millforce::sim
