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

class TrainingRuns {
  public:
    TrainingRuns(std::vector<PreparedPart>& parts, std::uint64_t first_seed, int seeds, unsigned threads)
        : parts_(parts), first_seed_(first_seed), seeds_(static_cast<std::size_t>(seeds)), threads_(threads) {}

    void teach_all(double feed_share) {
        run_parallel(
            parts_.size(), threads_, [&](std::size_t k) { teach(parts_[k], feed_share); }, [](double) {});
    }

    double cost(const RuleDescription& rule, const std::vector<double>& values) {
        const Contender& contender = *contender_named(rule.name);
        const RuleSettings settings{{std::string(rule.name), values}};
        std::vector<BenchRun> runs(parts_.size() * seeds_);
        run_parallel(
            runs.size(), threads_,
            [&](std::size_t k) {
                runs[k] = run_contender(contender, parts_[k / seeds_], first_seed_ + k % seeds_, settings);
            },
            [](double) {});
        return tuning_cost(runs);
    }

  private:
    std::vector<PreparedPart>& parts_;
    std::uint64_t first_seed_;
    std::size_t seeds_;
    unsigned threads_;
};

RuleSettings settings_in(host::TomlFile file) {
    host::TomlFile::Table root = file.root();
    RuleSettings settings;
    for (const RuleDescription& rule : rule_descriptions()) {
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

RuleSettings tuned_settings(std::vector<PreparedPart>& parts, std::uint64_t first_seed, int seeds, unsigned threads,
                            int evaluations, const std::function<void(const std::string&, double)>& progress) {
    TrainingRuns training(parts, first_seed, seeds, threads);
    RuleSettings settings;
    for (const RuleDescription& rule : rule_descriptions()) {
        const bool is_constant = rule.name == "constant";
        int done = 0;
        const Minimum best = minimise(
            [&](const std::vector<double>& values) {
                progress(std::string(rule.title), static_cast<double>(done++) / evaluations);
                if (is_constant) {
                    training.teach_all(values.front());
                }
                return training.cost(rule, values);
            },
            ranges_of(rule), evaluations);
        settings[std::string(rule.name)] = best.at;
        if (is_constant) {
            training.teach_all(best.at.front());
        }
    }
    return settings;
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
    for (const RuleDescription& rule : rule_descriptions()) {
        toml.table(rule.name);
        const std::vector<double>& values = settings.find(rule.name)->second;
        for (std::size_t k = 0; k < values.size(); ++k) {
            toml.key(rule.parameters[k].name, std::round(values[k] * 1e4) * 1e-4);
        }
    }
    return text.str();
}

}  // namespace millforce::sim
