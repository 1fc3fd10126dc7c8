// SPDX-License-Identifier: Apache-2.0
#include "report/html_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "report/page_assets.hpp"
#include "report/page_template.hpp"
#include "report/report_assets.hpp"
#include "report/report_data.hpp"
#include "report/summary.hpp"

namespace millforce::sim {

namespace {

/// Times that are compared are written alike: in minutes where the longest of them is.
std::string readable_time(double time_s, double longest_s) {
    if (!std::isfinite(time_s)) {
        return "–";
    }
    if (!(longest_s >= 120.0)) {
        return fmt::format("{:.1f} s", time_s);
    }
    const double minutes = std::floor(std::round(time_s) / 60.0);
    return fmt::format("{:.0f} min {:.0f} s", minutes, std::round(time_s) - 60.0 * minutes);
}

std::string fact(std::string_view name, std::string_view value) {
    return value.empty() ? std::string{}
                         : fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, host::html_escaped(value));
}

std::string facts_html(const ScenarioInfo& info) {
    const double speed_rpm = spindle_speed_rpm(info);
    std::string out = fact("Tool", info.tool) + fact("Material", info.material);
    out += fact("Force limit of one tooth", fmt::format("{:.0f} N", info.tooth_force_limit_N));
    if (speed_rpm > 0.0) {
        out += fact("Spindle", fmt::format("{:.0f} rpm", speed_rpm));
    }
    if (info.constant_feed_mm_s > 0.0) {
        out += fact("Constant feed, safe everywhere", fmt::format("{:.0f} mm/min", 60.0 * info.constant_feed_mm_s));
    }
    out += fact("Seed", fmt::to_string(info.seed));
    return out;
}

std::string stat(std::string_view style, std::string_view value, std::string_view meaning) {
    return fmt::format("<div class=\"stat {}\"><strong>{}</strong><span>{}</span></div>\n", style, value, meaning);
}

bool limit_held(const RunFigures& figures) {
    return figures.peak_over_limit <= 1.0;
}

/// The one figure that matters, with the condition under which it counts.
std::string headline_html(std::span<const RunResult> runs) {
    const RunFigures& figures = runs.front().figures;
    const RunResult* constant = constant_feed_run(runs);
    const std::optional<double> saved = time_saved_percent(runs.front(), runs);
    const double constant_s = constant == nullptr ? 0.0 : constant->figures.time_s;
    const double longest_s = saved ? std::max(figures.time_s, constant_s) : figures.time_s;
    const std::string time = readable_time(figures.time_s, longest_s);
    std::string out;
    if (saved) {
        out +=
            stat(limit_held(figures) && *saved >= 0.0 ? "hero held" : "hero", fmt::format("{:.1f} %", std::abs(*saved)),
                 *saved < 0.0 ? "more machining time than a constant feed that is safe everywhere"
                              : "less machining time than a constant feed that is safe everywhere");
        out += stat("", time, fmt::format("instead of {}", readable_time(constant_s, longest_s)));
    } else {
        out += stat("hero", time, figures.finished ? "machining time" : "until the run stopped");
    }
    out += stat(limit_held(figures) ? "held" : "over", fmt::format("{:.0f} %", 100.0 * figures.peak_over_limit),
                "of its limit: the largest force on one tooth");
    return out;
}

std::string verdict_html(std::span<const RunResult> runs) {
    const RunFigures& figures = runs.front().figures;
    std::string out;
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

std::string figures_table_html(std::span<const RunResult> runs) {
    std::string out = "<table class=\"figures\">\n<thead><tr><th scope=\"col\">Figure</th>";
    for (const RunResult& run : runs) {
        out += fmt::format("<th scope=\"col\">{}</th>", host::html_escaped(run.controller));
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
    const std::string facts = facts_html(info);
    const std::string headline = headline_html(runs);
    const std::string verdict = verdict_html(runs);
    const std::string figures = figures_table_html(runs);
    const std::string controlled = host::html_escaped(runs.front().controller);
    const std::string data = report_data_json(info, runs);
    return host::filled(report_assets::report_template(),
                        {
                            {"title", title},
                            {"description", description},
                            {"controlled", controlled},
                            {"facts", facts},
                            {"headline", headline},
                            {"verdict", verdict},
                            {"figures", figures},
                            {"data", data},
                            {"report_style", host::page_assets::report_style()},
                            {"charts_script", host::page_assets::charts_script()},
                            {"top_view_script", report_assets::top_view_script()},
                            {"report_script", report_assets::report_script()},
                            {"dygraphs_script", host::without_source_map(host::page_assets::dygraphs_script())},
                            {"dygraphs_style", host::without_source_map(host::page_assets::dygraphs_style())},
                        });
}

}  // namespace millforce::sim
