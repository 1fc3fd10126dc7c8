// SPDX-License-Identifier: Apache-2.0
#include "bench_control/bench_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "files/csv.hpp"

namespace millforce::sim {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

using Plant = std::pair<std::string, std::uint64_t>;  ///< part and seed

std::map<Plant, double> bounds_in(const std::vector<BenchRun>& runs) {
    std::map<Plant, double> bounds;
    for (const BenchRun& run : runs) {
        if (run.controller == "plan" && run.finished > 0.5) {
            bounds[{run.part, run.seed}] = run.time_s;
        }
    }
    return bounds;
}

/// NaN where the plant has no bound.
double time_over_bound(const BenchRun& run, const std::map<Plant, double>& bounds) {
    const auto bound = bounds.find({run.part, run.seed});
    if (bound == bounds.end()) {
        return host::no_estimate;
    }
    return run.finished > 0.5 ? run.time_s / bound->second : never;
}

std::string ratio_text(double value) {
    if (std::isnan(value)) {
        return "–";
    }
    return std::isinf(value) ? "not finished" : fmt::format("{:.2f}", value);
}

std::string percent_text(double share) {
    return std::isfinite(share) ? fmt::format("{:.0f} %", 100.0 * share) : "–";
}

}  // namespace

double quantile(std::vector<double> values, double share) {
    if (values.empty()) {
        return host::no_estimate;
    }
    std::ranges::sort(values);
    const double place = share * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(low);
    const double next = values[std::min(low + 1, values.size() - 1)];
    return part > 0.0 ? values[low] + part * (next - values[low]) : values[low];
}

std::vector<ContenderFigures> figures_of_runs(const std::vector<BenchRun>& runs) {
    const std::map<Plant, double> bounds = bounds_in(runs);
    std::vector<ContenderFigures> all;
    for (const Contender& contender : contenders()) {
        ContenderFigures figures{&contender, {}, {}};
        double cutting_s = 0.0;
        double rubbing_s = 0.0;
        for (const BenchRun& run : runs) {
            if (run.controller != contender.name) {
                continue;
            }
            const double ratio = time_over_bound(run, bounds);
            if (!std::isnan(ratio)) {
                figures.times_over_bound.push_back(ratio);
            }
            ++figures.runs;
            figures.peaks.push_back(run.peak_over_limit);
            figures.unfinished += run.finished > 0.5 ? 0 : 1;
            figures.teeth_broken += static_cast<int>(run.teeth_broken);
            figures.runs_with_a_broken_tooth += run.teeth_broken > 0.0 ? 1 : 0;
            figures.revolutions_over_mean += run.revolutions_over;
            cutting_s += run.cutting_time_s;
            rubbing_s += run.rubbing_s;
        }
        if (figures.runs > 0) {
            figures.revolutions_over_mean /= figures.runs;
            figures.rubbing_share = cutting_s > 0.0 ? rubbing_s / cutting_s : 0.0;
            all.push_back(std::move(figures));
        }
    }
    return all;
}

std::vector<PartFigures> figures_of_parts(const std::vector<BenchRun>& runs,
                                          const std::vector<ContenderFigures>& contenders) {
    const std::map<Plant, double> bounds = bounds_in(runs);
    std::vector<PartFigures> parts;
    for (const BenchPart& part : bench_parts()) {
        PartFigures figures{std::string(part.name), {}, {}};
        bool has_runs = false;
        for (const ContenderFigures& of : contenders) {
            std::vector<double> times;
            std::vector<double> peaks;
            for (const BenchRun& run : runs) {
                if (run.part == part.name && run.controller == of.contender->name) {
                    has_runs = true;
                    peaks.push_back(run.peak_over_limit);
                    const double ratio = time_over_bound(run, bounds);
                    if (!std::isnan(ratio)) {
                        times.push_back(ratio);
                    }
                }
            }
            figures.times_over_bound.push_back(quantile(times, 0.5));
            figures.peaks_95.push_back(quantile(peaks, 0.95));
        }
        if (has_runs) {
            parts.push_back(std::move(figures));
        }
    }
    return parts;
}

BenchTable table_of(const std::vector<ContenderFigures>& figures) {
    BenchTable table;
    table.head = {"controller",  "runs",  "time over the bound, median",         "95 %",         "peak, median",
                  "95 %",        "worst", "revolutions above the limit, a part", "teeth broken", "rubbing",
                  "not finished"};
    for (const ContenderFigures& f : figures) {
        const bool is_bound = f.contender->kind == Contender::Kind::bound;
        table.rows.push_back(
            {std::string(f.contender->title), fmt::to_string(f.runs), ratio_text(f.time(0.5)), ratio_text(f.time(0.95)),
             percent_text(f.peak(0.5)), percent_text(f.peak(0.95)), percent_text(f.peak(1.0)),
             fmt::format("{:.1f}", f.revolutions_over_mean),
             f.teeth_broken == 0 ? "0"
                                 : fmt::format("{} in {} run{}", f.teeth_broken, f.runs_with_a_broken_tooth,
                                               f.runs_with_a_broken_tooth == 1 ? "" : "s"),
             is_bound ? "–" : fmt::format("{:.1f} %", 100.0 * f.rubbing_share), fmt::to_string(f.unfinished)});
    }
    return table;
}

BenchTable table_of_parts(const std::vector<PartFigures>& parts, const std::vector<ContenderFigures>& contenders) {
    BenchTable table;
    table.head = {"part"};
    for (const ContenderFigures& of : contenders) {
        table.head.emplace_back(of.contender->title);
    }
    for (const PartFigures& part : parts) {
        std::vector<std::string> row{part.part};
        for (std::size_t k = 0; k < contenders.size(); ++k) {
            row.push_back(fmt::format("{} ({})", ratio_text(part.times_over_bound[k]), percent_text(part.peaks_95[k])));
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

std::string markdown(const BenchTable& table) {
    const auto line = [](const std::vector<std::string>& cells) {
        std::string text = "|";
        for (const std::string& cell : cells) {
            text += " " + cell + " |";
        }
        return text + "\n";
    };
    std::string text = line(table.head) + "|";
    for (std::size_t k = 0; k < table.head.size(); ++k) {
        text += "---|";
    }
    text += "\n";
    for (const auto& row : table.rows) {
        text += line(row);
    }
    return text;
}

}  // namespace millforce::sim
