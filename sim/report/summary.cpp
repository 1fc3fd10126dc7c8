// SPDX-License-Identifier: Apache-2.0
#include "report/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace millforce::sim {

namespace {

using Cell = std::string (*)(const RunResult& run, std::span<const RunResult> runs);

struct FigureColumn {
    const char* label;
    const char* explanation;
    Cell cell;
};

std::string with_unit(double value, int places, const char* unit) {
    return std::isfinite(value) ? fmt::format("{:.{}f}{}", value, places, unit) : "-";
}

std::string percent(double share) {
    return with_unit(100.0 * share, 1, " %");
}

std::string ending(const RunResult& run) {
    if (run.figures.fault != "none") {
        return run.figures.fault;
    }
    return run.figures.finished ? "finished" : "unfinished";
}

constexpr FigureColumn figure_columns[] = {
    {"time", "Machining time of the part program, air moves included.",
     [](const RunResult& run, auto) { return with_unit(run.figures.time_s, 1, " s"); }},
    {"time saved", "Against the constant feed that is safe everywhere on the part, even where the material is harder.",
     [](const RunResult& run, std::span<const RunResult> runs) {
         return with_unit(time_saved_percent(run, runs).value_or(host::no_estimate), 1, " %");
     }},
    {"  in hindsight", "Against the best constant feed for exactly this material, which nobody knows beforehand.",
     [](const RunResult& run, std::span<const RunResult> runs) {
         return with_unit(time_saved_percent(run, runs, constant_feed_in_hindsight).value_or(host::no_estimate), 1,
                          " %");
     }},
    {"peak tooth force", "Largest true force of one tooth.",
     [](const RunResult& run, auto) { return with_unit(run.figures.peak_tooth_force_N, 0, " N"); }},
    {"peak / limit", "Largest true tooth force over what the tooth may carry.",
     [](const RunResult& run, auto) { return percent(run.figures.peak_over_limit); }},
    {"time over limit", "Time with the true tooth force above its limit.",
     [](const RunResult& run, auto) { return with_unit(run.figures.time_over_limit_s, 2, " s"); }},
    {"longest over limit", "Longest stretch of revolutions with a peak above the limit.",
     [](const RunResult& run, auto) { return with_unit(run.figures.longest_over_limit_s, 3, " s"); }},
    {"reaction time", "What physics allows: override latency, deceleration and two revolutions.",
     [](const RunResult& run, auto) { return with_unit(run.figures.reaction_time_s, 3, " s"); }},
    {"over limit, late", "Above the limit though the engagement has not grown for the reaction time.",
     [](const RunResult& run, auto) { return with_unit(run.figures.late_over_limit_s, 3, " s"); }},
    {"teeth broken", "Teeth whose force reached the breaking share of the limit.",
     [](const RunResult& run, auto) { return fmt::to_string(run.figures.teeth_broken); }},
    {"mean force / limit", "Mean of true tooth force over limit while cutting: how much of the tooth is used.",
     [](const RunResult& run, auto) { return percent(run.figures.mean_force_use); }},
    {"mean override", "Mean feed override while cutting.",
     [](const RunResult& run, auto) { return percent(run.figures.mean_override); }},
    {"immersion rms error", "Error of the estimated radial immersion (a_e/R, 0 to 2), where there was an estimate.",
     [](const RunResult& run, auto) { return with_unit(run.figures.immersion_rms, 3, ""); }},
    {"  within 95 % band", "Share of the immersion estimates whose own 95 % band held the truth.",
     [](const RunResult& run, auto) { return percent(run.figures.immersion_coverage); }},
    {"depth rms error", "Error of the estimated axial depth, where there was an estimate.",
     [](const RunResult& run, auto) { return with_unit(run.figures.depth_rms_mm, 3, " mm"); }},
    {"  within 95 % band", "Share of the depth estimates whose own 95 % band held the truth.",
     [](const RunResult& run, auto) { return percent(run.figures.depth_coverage); }},
    {"cut with an estimate", "Share of the cutting samples that had an immersion estimate.",
     [](const RunResult& run, auto) { return percent(run.figures.estimate_share); }},
    {"x real time", "Simulated time per time on the wall clock.",
     [](const RunResult& run, auto) { return with_unit(run.figures.real_time_factor, 0, ""); }},
    {"ended", "Finished: at the end of the part program; else the fault that stopped the run.",
     [](const RunResult& run, auto) { return ending(run); }},
};

void append_block(std::string& out, std::span<const RunResult> runs, std::span<const FigureRow> rows, std::size_t first,
                  std::size_t count) {
    constexpr int label_width = 22;
    constexpr std::size_t smallest_column = 14;
    const auto width = [&](std::size_t column) {
        std::size_t widest = std::max(smallest_column, runs[column].controller.size());
        for (const FigureRow& row : rows) {
            widest = std::max(widest, row.cells[column].size());
        }
        return widest;
    };
    std::string header = fmt::format("{:<{}}", "", label_width);
    for (std::size_t column = first; column < first + count; ++column) {
        header += fmt::format("  {:>{}}", runs[column].controller, width(column));
    }
    out += header + '\n' + std::string(header.size(), '-') + '\n';
    for (const FigureRow& row : rows) {
        out += fmt::format("{:<{}}", row.label, label_width);
        for (std::size_t column = first; column < first + count; ++column) {
            out += fmt::format("  {:>{}}", row.cells[column], width(column));
        }
        out += '\n';
    }
}

}  // namespace

const RunResult* run_named(std::string_view name, std::span<const RunResult> runs) {
    const auto found =
        std::find_if(runs.begin(), runs.end(), [name](const RunResult& run) { return run.controller == name; });
    return found == runs.end() ? nullptr : &*found;
}

std::optional<double> time_saved_percent(const RunResult& run, std::span<const RunResult> runs,
                                         std::string_view against) {
    const bool is_constant = run.controller == constant_feed || run.controller == constant_feed_in_hindsight;
    const RunResult* other = run_named(against, runs);
    if (is_constant || other == nullptr || !run.figures.finished || !other->figures.finished ||
        !(other->figures.time_s > 0.0)) {
        return std::nullopt;
    }
    return 100.0 * (other->figures.time_s - run.figures.time_s) / other->figures.time_s;
}

std::vector<FigureRow> figure_rows(std::span<const RunResult> runs) {
    std::vector<FigureRow> rows;
    for (const FigureColumn& column : figure_columns) {
        FigureRow& row = rows.emplace_back();
        row.label = column.label;
        row.explanation = column.explanation;
        for (const RunResult& run : runs) {
            row.cells.push_back(column.cell(run, runs));
        }
    }
    return rows;
}

std::string summary_table(const ScenarioInfo& info, std::span<const RunResult> runs) {
    if (runs.empty()) {
        return {};
    }
    constexpr std::size_t runs_per_block = 4;
    const std::vector<FigureRow> rows = figure_rows(runs);
    const double speed_rpm = spindle_speed_rpm(info);
    std::string out = fmt::format("{}\n", info.title.empty() ? info.name : info.title);
    out += fmt::format("{}; {}; ", info.tool, info.material);
    if (speed_rpm > 0.0) {
        out += fmt::format("{:.0f} rpm; ", speed_rpm);
    }
    out += fmt::format("tooth force limit {:.0f} N\n", info.tooth_force_limit_N);
    for (std::size_t first = 0; first < runs.size(); first += runs_per_block) {
        out += '\n';
        append_block(out, runs, rows, first, std::min(runs_per_block, runs.size() - first));
    }
    return out;
}

}  // namespace millforce::sim
