// SPDX-License-Identifier: Apache-2.0
#include "report/html_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "report/page_assets.hpp"
#include "report/page_parts.hpp"
#include "report/page_template.hpp"
#include "report/report_assets.hpp"
#include "report/report_data.hpp"
#include "report/summary.hpp"
#include "run_report/ceiling_table.hpp"
#include "run_report/run_words.hpp"

namespace millforce::sim {

namespace {

std::string origin_html(const ScenarioInfo& info) {
    std::string out;
    for (const auto& [name, value] : info.origin) {
        out += host::fact_html(name, value);
    }
    return out;
}

std::string feed_text(double feed_mm_s) {
    return fmt::format("{:.0f} mm/min", 60.0 * feed_mm_s);
}

std::string safe_for(const ScenarioInfo& info) {
    return info.hardest_material > 1.0 ? fmt::format("safe everywhere for material up to {:.0f} % harder",
                                                     100.0 * (info.hardest_material - 1.0))
                                       : "safe everywhere";
}

std::string facts_html(const ScenarioInfo& info) {
    const double speed_rpm = spindle_speed_rpm(info);
    std::string out = host::fact_html("Tool", info.tool) + host::fact_html("Material", info.material);
    out += host::fact_html("Force limit of one tooth", fmt::format("{:.0f} N", info.tooth_force_limit_N));
    if (speed_rpm > 0.0) {
        out += host::fact_html("Spindle", fmt::format("{:.0f} rpm", speed_rpm));
    }
    if (info.constant_feed_mm_s > 0.0) {
        out += host::fact_html("Constant feed, " + safe_for(info), feed_text(info.constant_feed_mm_s));
    }
    if (info.hindsight_feed_mm_s > 0.0) {
        out += host::fact_html("Best constant feed in hindsight", feed_text(info.hindsight_feed_mm_s));
    }
    out += host::fact_html("Seed", fmt::to_string(info.seed));
    return out;
}

bool limit_held(const RunFigures& figures) {
    return figures.peak_over_limit <= 1.0;
}

/// A difference of times for large type, and how it is read.
struct Comparison {
    std::string value;
    std::string meaning;
};

/// A difference of more than the whole is a multiple: nobody reads "1730 % more".
Comparison comparison_of(double saved_percent) {
    if (saved_percent <= -100.0) {
        return {fmt::format("{:.1f} times", 1.0 - saved_percent / 100.0), "the machining time of"};
    }
    return {fmt::format("{:.1f} %", std::abs(saved_percent)),
            saved_percent < 0.0 ? "more machining time than" : "less machining time than"};
}

std::string constant_feed_words(const ScenarioInfo& info) {
    return info.constant_feed_mm_s > 0.0 ? fmt::format("the fastest constant feed that is {}: {}", safe_for(info),
                                                       feed_text(info.constant_feed_mm_s))
                                         : "a constant feed that is safe everywhere";
}

std::string hindsight_stat_html(const ScenarioInfo& info, std::span<const RunResult> runs) {
    const std::optional<double> saved = time_saved_percent(runs.front(), runs, constant_feed_in_hindsight);
    if (!saved) {
        return {};
    }
    const Comparison comparison = comparison_of(*saved);
    return host::stat_html("", comparison.value,
                           fmt::format("{} the best constant feed for exactly this material, which is known only in "
                                       "hindsight: {}",
                                       comparison.meaning, feed_text(info.hindsight_feed_mm_s)));
}

/// The time saved, with the feeds against which it counts.
std::string headline_html(const ScenarioInfo& info, std::span<const RunResult> runs) {
    const RunFigures& figures = runs.front().figures;
    const RunResult* constant = run_named(constant_feed, runs);
    const std::optional<double> saved = time_saved_percent(runs.front(), runs);
    const double constant_s = constant == nullptr ? 0.0 : constant->figures.time_s;
    const double longest_s = saved ? std::max(figures.time_s, constant_s) : figures.time_s;
    const std::string time = host::readable_time(figures.time_s, longest_s);
    std::string out;
    if (saved) {
        const Comparison comparison = comparison_of(*saved);
        out += host::stat_html(limit_held(figures) && *saved >= 0.0 ? "hero held" : "hero", comparison.value,
                               fmt::format("{} {}", comparison.meaning, constant_feed_words(info)));
        out += hindsight_stat_html(info, runs);
        out += host::stat_html("", time, fmt::format("instead of {}", host::readable_time(constant_s, longest_s)));
    } else {
        out += host::stat_html("hero", time, figures.finished ? "machining time" : "until the run stopped");
    }
    out +=
        host::stat_html(limit_held(figures) ? "held" : "over", fmt::format("{:.0f} %", 100.0 * figures.peak_over_limit),
                        "of its limit: the largest force on one tooth");
    return out;
}

host::CeilingTimes ceiling_times(const RunResult& run) {
    host::CeilingTimes times;
    double last_s = 0.0;
    for (const TracePoint& point : run.trace) {
        times.add(point.time_s - last_s, static_cast<control::Limit>(point.limit),
                  static_cast<control::CutState>(point.state));
        last_s = point.time_s;
    }
    return times;
}

/// Override of a constant feed; 0: not known.
double constant_override(const RunResult& run) {
    const auto fed = std::find_if(run.trace.begin(), run.trace.end(),
                                  [](const TracePoint& point) { return !point.rapid && point.override_ratio > 0.0; });
    return fed == run.trace.end() ? 0.0 : fed->override_ratio;
}

/// How much longer each ceiling made the run than the constant feed would have been, where it was slower than that.
std::array<double, control::limit_count> lost_times_s(const RunResult& run, double constant_ratio) {
    std::array<double, control::limit_count> lost_s{};
    double last_s = 0.0;
    for (const TracePoint& point : run.trace) {
        const double step_s = point.time_s - last_s;
        last_s = point.time_s;
        const double constant_mm_s = constant_ratio * point.programmed_feed_mm_s;
        if (!point.rapid && point.feed_mm_s < constant_mm_s) {
            lost_s[point.limit % control::limit_count] += step_s * (1.0 - point.feed_mm_s / constant_mm_s);
        }
    }
    return lost_s;
}

/// Which ceiling cost most, where the constant feed was faster.
std::string reason_html(std::span<const RunResult> runs) {
    if (time_saved_percent(runs.front(), runs).value_or(0.0) >= 0.0) {
        return {};
    }
    const auto lost_s = lost_times_s(runs.front(), constant_override(*run_named(constant_feed, runs)));
    const auto worst = std::max_element(lost_s.begin(), lost_s.end());
    const double all_s = std::accumulate(lost_s.begin(), lost_s.end(), 0.0);
    if (!(all_s > 0.0)) {
        return {};
    }
    const host::CeilingWords& words = host::words_of(static_cast<control::Limit>(worst - lost_s.begin()));
    return fmt::format(
        "<strong>Why it took longer:</strong> {} of the lost time passed while the ceiling on the feed was “{}”. {} ",
        host::readable_share(*worst / all_s), words.label, words.meaning);
}

std::string verdict_html(std::span<const RunResult> runs) {
    const RunFigures& figures = runs.front().figures;
    std::string out = reason_html(runs);
    if (!figures.finished) {
        out += fmt::format("The part program did not come to its end (fault: {}). ", host::html_escaped(figures.fault));
    }
    if (limit_held(figures)) {
        out += fmt::format("No tooth went over its limit; {}.",
                           figures.teeth_broken == 0 ? "none broke" : "but a tooth broke");
        return out;
    }
    out += fmt::format(
        "The limit was exceeded for {:.2f} s in total, {:.3f} s at a stretch: {}. Teeth broken: {}.",
        figures.time_over_limit_s, figures.longest_over_limit_s,
        figures.late_over_limit_s > 0.0
            ? fmt::format(
                  "{:.3f} s of it when the engagement had not grown for the {:.3f} s that latency, deceleration "
                  "and two revolutions need",
                  figures.late_over_limit_s, figures.reaction_time_s)
            : fmt::format("only while the engagement grew, and within the {:.3f} s after it that latency, deceleration "
                          "and two revolutions need",
                          figures.reaction_time_s),
        figures.teeth_broken);
    return out;
}

/// "-" and "x" in the table are for terminals.
std::string label_html(const std::string& label) {
    return label.starts_with("x ") ? "×" + label.substr(1) : label;
}

std::string cell_text(const std::string& cell) {
    return cell == "-" ? "–" : host::html_escaped(cell);
}

/// May break after an underscore.
std::string column_name_html(const std::string& controller) {
    std::string name = host::html_escaped(controller);
    for (std::size_t at = name.find('_'); at != std::string::npos; at = name.find('_', at + 1)) {
        name.insert(at + 1, "<wbr>");
    }
    return name;
}

std::string figures_table_html(std::span<const RunResult> runs) {
    std::string out = fmt::format(
        "<table class=\"figures side-by-side\" style=\"--values: {}\">\n<thead><tr><th scope=\"col\">Figure</th>",
        runs.size());
    for (const RunResult& run : runs) {
        out += fmt::format("<th scope=\"col\">{}</th>", column_name_html(run.controller));
    }
    out += "<th scope=\"col\" class=\"explanation\">What it is</th></tr></thead>\n<tbody>\n";
    for (const FigureRow& row : figure_rows(runs)) {
        const bool detail = row.label.starts_with("  ");
        out += fmt::format("<tr><th scope=\"row\"{}>{}</th>", detail ? " class=\"detail\"" : "",
                           label_html(detail ? row.label.substr(2) : row.label));
        for (const std::string& cell : row.cells) {
            out += fmt::format("<td>{}</td>", cell_text(cell));
        }
        out += fmt::format("<td class=\"explanation\">{}</td></tr>\n", host::html_escaped(row.explanation));
    }
    return out + "</tbody>\n</table>\n";
}

}  // namespace

std::string report_html(const ScenarioInfo& info, std::span<const RunResult> runs) {
    const std::string title = host::html_escaped(info.title.empty() ? info.name : info.title);
    const std::string description = host::html_escaped(info.description);
    const std::string head = host::page_head(
        title, {host::without_source_map(host::page_assets::dygraphs_style()), host::page_assets::report_style()});
    const std::string facts = facts_html(info);
    const std::string headline = headline_html(info, runs);
    const std::string verdict = verdict_html(runs);
    const std::string figures = figures_table_html(runs);
    const std::string ceilings = host::ceilings_html(ceiling_times(runs.front()));
    const std::string controlled = host::html_escaped(runs.front().controller);
    const std::string origin = origin_html(info);
    const std::string data = report_data_json(info, runs);
    return host::filled(report_assets::report_template(),
                        {
                            {"head", head},
                            {"title", title},
                            {"description", description},
                            {"controlled", controlled},
                            {"facts", facts},
                            {"headline", headline},
                            {"verdict", verdict},
                            {"figures", figures},
                            {"ceilings", ceilings},
                            {"origin", origin},
                            {"data", data},
                            {"charts_script", host::page_assets::charts_script()},
                            {"top_view_script", report_assets::top_view_script()},
                            {"report_script", report_assets::report_script()},
                            {"dygraphs_script", host::without_source_map(host::page_assets::dygraphs_script())},
                        });
}

}  // namespace millforce::sim
