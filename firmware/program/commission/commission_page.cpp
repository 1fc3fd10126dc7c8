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

constexpr double rad_s_per_1000_rpm = 1000.0 * std::numbers::pi / 30.0;

constexpr std::string_view page_style = R"(
.verdicts { margin: 0; padding: 0; list-style: none; }
.verdicts li { display: grid; grid-template-columns: 6.5em minmax(0, 1fr); padding: 6px 0;
  border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
.good strong { color: var(--held); }
.repeat strong { color: var(--over); }
details { color: var(--muted); }
pre { overflow-x: auto; }
.figures.keys th[scope="row"]::first-letter, .figures.validation th[scope="row"]::first-letter { text-transform: none; }
.figures.keys th code { margin-left: 0; color: inherit; overflow-wrap: normal; }
@media (min-width: 701px) { .figures.keys .explanation { width: 45%; } }
.plots { display: flex; flex-wrap: wrap; gap: 12px 24px; }
svg { max-width: 100%; height: auto; }
)";

constexpr std::string_view page_frame = R"({{head}}<body>
<main>

<header>
  <p class="origin">millforce commission</p>
  <h1>Commissioning</h1>
  <dl class="facts">
{{facts}}  </dl>
</header>

<section class="headline {{class}}" aria-label="Result">
  <strong>{{headline}}</strong>
</section>

<section>
  <h2>Steps</h2>
{{steps}}</section>

<section>
  <h2>Fitted values</h2>
{{values}}</section>

<section>
  <h2>Measured points</h2>
  <p class="how">Points: measured. Line: the fit.</p>
  <div class="plots">
{{plots}}  </div>
</section>

<section>
  <h2>Validation</h2>
{{validation}}</section>

</main>
</body>
</html>
)";

std::string steps_html(const std::vector<StepVerdict>& verdicts) {
    std::string text = "<ul class=\"verdicts\">\n";
    for (const StepVerdict& verdict : verdicts) {
        text += fmt::format("<li class=\"{}\"><b>{}</b><div>{}", verdict.is_good ? "good" : "repeat",
                            html_escaped(verdict.step), html_escaped(verdict.words));
        text += verdict.details.empty() ? ""
                                        : fmt::format("<details><summary>details</summary><pre>{}</pre></details>",
                                                      html_escaped(verdict.details));
        text += "</div></li>\n";
    }
    return text + "</ul>\n";
}

std::string value_row(std::string_view name_html, double value, std::optional<double> standard_error,
                      std::string_view unit, std::string_view meaning) {
    return fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{:.4g}</td><td>{}</td><td>{}</td><td class=\"explanation\">{}</td></tr>\n",
        name_html, value, standard_error ? fmt::format("{:.2g}", *standard_error) : "", html_escaped(unit),
        html_escaped(meaning));
}

std::string key_row(const FittedKey& key) {
    const std::string name = fmt::format("<code>{}.{}</code>", html_escaped(key.table), html_escaped(key.key));
    return value_row(name, key.value, key.standard_error, key.unit, key.sentence);
}

std::string idle_rows(const IdleFit& fit) {
    return value_row("idle current at rest", fit.offset_A, fit.offset_se, "A", "Of the line over the speed.") +
           value_row("idle current, slope", fit.slope_A_s * rad_s_per_1000_rpm, fit.slope_se * rad_s_per_1000_rpm,
                     "A per 1000/min", "Growth with the spindle's speed.") +
           value_row("idle current, residual", fit.residual_A, {}, "A", "Of the line, rms.") +
           value_row("idle current, noise", fit.noise_A, {}, "A", "Of one sample of the spindle current.");
}

std::string values_html(const CommissionPage& page, const Session& session) {
    std::string text =
        "<table class=\"figures keys side-by-side\" style=\"--values: 3\">\n<thead><tr><th scope=\"col\">Key</th>"
        "<th scope=\"col\">value</th><th scope=\"col\">standard error</th><th scope=\"col\">unit</th>"
        "<th scope=\"col\" class=\"explanation\">What it is</th></tr></thead>\n<tbody>\n";
    text += page.idle_fit ? idle_rows(*page.idle_fit) : "";
    for (const std::string& name : page.files) {
        if (!session.has(name)) {
            continue;
        }
        for (const FittedKey& key : fitted_keys(session.file(name))) {
            text += key_row(key);
        }
    }
    return text + "</tbody>\n</table>\n";
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
        return "<p>Not done yet.</p>\n";
    }
    std::string text =
        "<p class=\"how\">Cuts that the fit has not seen: forces from the drives' currents beside those of the "
        "published law. The bound is twice the stated deviation.</p>\n"
        "<table class=\"figures validation side-by-side\" style=\"--values: 3\">\n<thead><tr><th scope=\"col\">Cut</th>"
        "<th scope=\"col\">torque, N·m</th><th scope=\"col\">by the law</th><th scope=\"col\">off by</th>"
        "<th scope=\"col\">feed force, N</th><th scope=\"col\">by the law</th><th scope=\"col\">off by</th>"
        "</tr></thead>\n<tbody>\n";
    for (const ValidatedCut& cut : cuts) {
        text += fmt::format(
            "<tr class=\"{}\"><th scope=\"row\">{}, {:.0f} mm/min, {:g} mm wide</th><td>{:.3f}</td><td>{:.3f}</td>"
            "<td><strong>{:+.1f} %</strong><small>bound {:.0f} %</small></td><td>{:.1f}</td><td>{:.1f}</td>"
            "<td><strong>{:+.1f} %</strong><small>bound {:.0f} %</small></td></tr>\n",
            cut.holds() ? "good" : "repeat", cut.axis, cut.feed_mm_min, cut.radial_width_mm, cut.torque_Nm,
            cut.expected_torque_Nm, 100.0 * cut.torque_error(), 100.0 * cut.torque_bound, cut.feed_force_N,
            cut.expected_feed_force_N, 100.0 * cut.force_error(), 100.0 * cut.force_bound);
    }
    return text + "</tbody>\n</table>\n";
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
    std::string facts;
    for (const auto& [name, value] : page.facts) {
        facts += fact_html(name, value);
    }
    return filled(page_frame, {{"facts", facts},
                               {"head", page_head("Commissioning", {page_assets::report_style(), page_style})},
                               {"class", is_good ? "good" : "repeat"},
                               {"headline", html_escaped(headline(page.verdicts))},
                               {"steps", steps_html(page.verdicts)},
                               {"values", values_html(page, session)},
                               {"plots", plots_html(page)},
                               {"validation", validation_html(page.validated)}});
}

}  // namespace millforce::host
