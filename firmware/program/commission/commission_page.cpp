// SPDX-License-Identifier: Apache-2.0
#include "commission/commission_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "commission/fitted_values.hpp"
#include "commission/scatter_plot.hpp"
#include "report/page_assets.hpp"
#include "report/page_parts.hpp"
#include "report/page_template.hpp"

namespace millforce::host {

namespace {

constexpr std::string_view page_style = R"(
table { border-collapse: collapse; } td, th { padding: 0.15rem 0.8rem 0.15rem 0; text-align: left; }
td.number { text-align: right; font-variant-numeric: tabular-nums; }
pre { overflow-x: auto; } svg { max-width: 100%; height: auto; }
.good { color: var(--held); } .repeat { color: var(--over); }
)";

constexpr std::string_view page_frame = R"({{head}}<body>
<main>
<h1>Commissioning</h1>
<p class="{{class}}"><strong>{{headline}}</strong></p>
<h2>Steps</h2>
{{steps}}
<h2>Fitted values</h2>
{{values}}
<h2>Measured points</h2>
{{plots}}
<h2>Validation</h2>
{{validation}}
</main>
</body>
</html>
)";

std::string steps_html(const std::vector<StepVerdict>& verdicts) {
    std::string text = "<table><tr><th>step</th><th>verdict</th></tr>\n";
    for (const StepVerdict& verdict : verdicts) {
        text += fmt::format("<tr><td>{}</td><td class=\"{}\">{}</td></tr>\n", html_escaped(verdict.step),
                            verdict.is_good ? "good" : "repeat", html_escaped(verdict.words));
    }
    text += "</table>\n";
    for (const StepVerdict& verdict : verdicts) {
        if (!verdict.details.empty()) {
            text += fmt::format("<details><summary>{}</summary><pre>{}</pre></details>\n", html_escaped(verdict.step),
                                html_escaped(verdict.details));
        }
    }
    return text;
}

std::string value_row(const FittedKey& key) {
    return fmt::format(
        "<tr><td>{}.{}</td><td class=\"number\">{:.4g}</td><td class=\"number\">{}</td><td>{}</td><td>{}</td></tr>\n",
        html_escaped(key.table), html_escaped(key.key), key.value,
        key.standard_error ? fmt::format("{:.2g}", *key.standard_error) : "", html_escaped(key.unit),
        html_escaped(key.sentence));
}

std::string idle_rows(const IdleFit& fit) {
    return value_row({"idle", "current at rest", fit.offset_A, fit.offset_se, "A", "Of the line over the speed."}) +
           value_row(
               {"idle", "slope", fit.slope_A_s, fit.slope_se, "A·s/rad", "Growth of the idle current with speed."}) +
           value_row({"idle", "residual", fit.residual_A, {}, "A", "Of the line, rms."}) +
           value_row({"idle", "noise", fit.noise_A, {}, "A", "Of one sample of the spindle current."});
}

std::string values_html(const CommissionPage& page, const Session& session) {
    std::string text =
        "<table><tr><th>key</th><th>value</th><th>standard error</th><th>unit</th><th>meaning</th></tr>\n";
    text += page.idle_fit ? idle_rows(*page.idle_fit) : "";
    for (const std::string& name : page.files) {
        if (!session.has(name)) {
            continue;
        }
        for (const FittedKey& key : fitted_keys(session.file(name))) {
            text += value_row(key);
        }
    }
    return text + "</table>\n";
}

std::string idle_plot(const CommissionPage& page) {
    ScatterPlot plot{"Idle current of the spindle", "speed, 1/min", "current, A", {}, {}};
    double fastest = 0.0;
    for (const IdlePlateau& plateau : page.idle) {
        plot.points.emplace_back(plateau.spindle_rad_s * 30.0 / std::numbers::pi, plateau.current_A);
        fastest = std::max(fastest, plateau.spindle_rad_s);
    }
    if (page.idle_fit) {
        for (const double speed : {0.0, fastest}) {
            plot.line.emplace_back(speed * 30.0 / std::numbers::pi,
                                   page.idle_fit->offset_A + page.idle_fit->slope_A_s * speed);
        }
    }
    return plot_html(plot);
}

/// By the fit, from the fastest feed in − to the fastest in +, with the jump at rest.
std::vector<std::pair<double, double>> friction_line(const MachineParameters& machine, std::size_t axis,
                                                     const std::vector<SteadyFeed>& feeds) {
    const auto [slowest, fastest] = std::minmax_element(
        feeds.begin(), feeds.end(),
        [](const SteadyFeed& a, const SteadyFeed& b) { return a.feed_m_per_min < b.feed_m_per_min; });
    std::vector<std::pair<double, double>> line;
    constexpr int steps = 40;
    for (int k = 0; k <= steps; ++k) {
        const double share = static_cast<double>(k) / steps;
        const double feed = slowest->feed_m_per_min + share * (fastest->feed_m_per_min - slowest->feed_m_per_min);
        line.emplace_back(feed, signed_friction_current_A(machine, axis, feed) +
                                    static_cast<double>(machine.axes.at(axis).gravity_A));
    }
    return line;
}

std::string plots_html(const CommissionPage& page) {
    std::string text = page.idle.empty() ? "" : idle_plot(page);
    for (const auto& [axis, feeds] : page.air) {
        ScatterPlot plot{"Friction of " + axis, "feed, m/min", "current, A", {}, {}};
        for (const SteadyFeed& feed : feeds) {
            plot.points.emplace_back(feed.feed_m_per_min, feed.current_A);
        }
        if (page.machine && !feeds.empty()) {
            plot.line = friction_line(*page.machine, axis == "x" ? 0 : axis == "y" ? 1 : 2, feeds);
        }
        text += feeds.empty() ? "" : plot_html(plot);
    }
    return text;
}

std::string validation_html(const std::vector<ValidatedCut>& cuts) {
    if (cuts.empty()) {
        return "<p>Not done yet.</p>";
    }
    std::string text =
        "<p>Cuts that the fit has not seen: forces from the drives' currents beside those of the published law. The "
        "bound is twice the stated deviation.</p>\n<table><tr><th>axis</th><th>feed, mm/min</th><th>width, "
        "mm</th><th>torque, N·m</th><th>by the law</th><th>error</th><th>bound</th><th>feed force, N</th><th>by the "
        "law</th><th>error</th><th>bound</th></tr>\n";
    for (const ValidatedCut& cut : cuts) {
        text += fmt::format(
            "<tr class=\"{}\"><td>{}</td><td>{:.0f}</td><td>{:g}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:+.1f} "
            "%</td><td>{:.0f} %</td><td>{:.1f}</td><td>{:.1f}</td><td>{:+.1f} %</td><td>{:.0f} %</td></tr>\n",
            cut.holds() ? "good" : "repeat", cut.axis, cut.feed_mm_min, cut.radial_width_mm, cut.torque_Nm,
            cut.expected_torque_Nm, 100.0 * cut.torque_error(), 100.0 * cut.torque_bound, cut.feed_force_N,
            cut.expected_feed_force_N, 100.0 * cut.force_error(), 100.0 * cut.force_bound);
    }
    return text + "</table>\n";
}

/// Done: the files were written and checked.
bool is_done(const std::vector<StepVerdict>& verdicts) {
    return std::any_of(verdicts.begin(), verdicts.end(), [](const StepVerdict& v) { return v.step == "check"; });
}

std::string headline(const std::vector<StepVerdict>& verdicts) {
    const auto bad = std::find_if(verdicts.begin(), verdicts.end(), [](const StepVerdict& v) { return !v.is_good; });
    if (bad != verdicts.end()) {
        return bad->step + ": " + bad->words;
    }
    return is_done(verdicts) ? "Good enough: machine.toml and tool.toml are written." : "Not finished.";
}

}  // namespace

std::string page_text(const CommissionPage& page, const Session& session) {
    const bool is_good = is_done(page.verdicts) && std::all_of(page.verdicts.begin(), page.verdicts.end(),
                                                               [](const StepVerdict& v) { return v.is_good; });
    return filled(page_frame, {{"head", page_head("Commissioning", {page_assets::report_style(), page_style})},
                               {"class", is_good ? "good" : "repeat"},
                               {"headline", html_escaped(headline(page.verdicts))},
                               {"steps", steps_html(page.verdicts)},
                               {"values", values_html(page, session)},
                               {"plots", plots_html(page)},
                               {"validation", validation_html(page.validated)}});
}

}  // namespace millforce::host
