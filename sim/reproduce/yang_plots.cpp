// SPDX-License-Identifier: Apache-2.0
#include "reproduce/yang_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "reproduce/yang_shapes.hpp"
#include "reproduce/yang_tables.hpp"

namespace millforce::sim::yang {
namespace {

using Style = Plot::Series::Style;

/// One flute of mill 1 at the type's nominal depths, and where Section 2 puts entry, peak and exit (Figs. 5b–7b).
Plot single_flute(std::size_t type) {
    SteadyCut cut = published_cut(0, type, {0.0, 0.0});
    cut.feed_per_tooth_mm *= static_cast<double>(cut.cutter.teeth);
    const double pitch_rad = turn / static_cast<double>(cut.cutter.teeth);
    const auto angles = estimation::flute_angles(geometry_of(cut.cutter), depths_of(cut));
    cut.cutter.teeth = 1;
    cut.cutter.runout_mm = 0.0;
    const auto engagement_rad = static_cast<double>(angles.engagement_rad);
    const auto sweep_rad = static_cast<double>(angles.sweep_rad);
    cut.tip_angle_rad = std::numbers::pi - engagement_rad;  // the flute enters at angle 0
    constexpr int samples = 720;
    const auto revolution = force_revolution(cut, samples);
    Plot plot{
        .title = fmt::format("One flute's force, type {} (Fig. {})", std::array{"I", "II", "III"}[type], type + 5),
        .x_label = "rotation, °",
        .y_label = "resultant force, N",
        .caption = std::array{"Rises over the sweep α_sw, falls over the engagement α_en.",
                              "Rises over α_en, has a flat top of α_sw − α_en, falls.",
                              "Peaks where the edge's middle passes half immersion, after α_sw + α_en − α_enc."}[type],
        .series = {}};
    Plot::Series force{.name = "force", .style = Style::line, .x = {}, .y = {}};
    const double shown_rad = std::min(engagement_rad + sweep_rad + 0.1, 2.0 * pitch_rad);
    const auto at = [&](double angle_rad) {
        const auto index = static_cast<std::size_t>(std::lround(angle_rad / turn * samples)) % samples;
        return resultant_N(revolution[index]);
    };
    for (int i = 0; i * turn / samples < shown_rad; ++i) {
        force.x.push_back(i * 360.0 / samples);
        force.y.push_back(at(i * turn / samples));
    }
    const double critical_rad = 0.5 * (std::numbers::pi + sweep_rad);
    const double peak_rad = std::array{sweep_rad, engagement_rad, sweep_rad + engagement_rad - critical_rad}[type];
    Plot::Series points{.name = "entry, peak, exit by Section 2", .style = Style::points, .x = {}, .y = {}};
    for (const double angle_rad : {0.0, peak_rad, engagement_rad + sweep_rad}) {
        points.x.push_back(angle_rad / degree);
        points.y.push_back(at(angle_rad));
    }
    plot.series = {force, points};
    return plot;
}

/// Raw resultant of one revolution, and the flute average, over one pitch (Fig. 16).
Plot flute_average_plot(const char* letter, std::size_t mill, std::size_t type, std::size_t test) {
    const YangMill& table = yang_mills[mill];
    const SteadyCut cut =
        published_cut(mill, type, {table.axial_variation_percent[test], table.radial_variation_percent[test]});
    const ForceSensor sensor;
    const auto record = record_force(force_revolution(cut, sensor.samples_per_revolution), sensor, profile_revolutions);
    const IndexProfile profile = flute_average(record, sensor, table.flutes, resultant_N);
    const double pitch_deg = 360.0 / static_cast<double>(table.flutes);
    Plot plot{.title = fmt::format("Raw and flute-averaged resultant, type {}, mill {}, test {} (Fig. 16{})",
                                   std::array{"I", "II", "III"}[type], mill + 1, test + 1, letter),
              .x_label = "rotation, °",
              .y_label = "resultant force, N",
              .caption =
                  "One revolution as sampled shows runout and noise; the average over flutes and 20 revolutions, "
                  "repeated each pitch, shows neither. PT_doc is read between its corners.",
              .series = {}};
    Plot::Series raw{.name = "as sampled, one revolution", .style = Style::line, .x = {}, .y = {}};
    Plot::Series average{.name = "flute average", .style = Style::line, .x = {}, .y = {}};
    constexpr int every = 12;
    for (int i = 0; i < sensor.samples_per_revolution; i += every) {
        raw.x.push_back(i * 360.0 / sensor.samples_per_revolution);
        raw.y.push_back(resultant_N(record[static_cast<std::size_t>(i)]));
        const double share = std::fmod(raw.x.back(), pitch_deg) / pitch_deg;
        average.x.push_back(raw.x.back());
        average.y.push_back(static_cast<double>(profile.mean[static_cast<std::size_t>(share * index_bins)][0]));
    }
    plot.series = {raw, average};
    return plot;
}

/// Error of both depths over the 30 tests, published and ours.
Plot published_errors(const std::vector<Series>& all) {
    Plot plot{.title = "Errors over the published tests (Tables 5–7)",
              .x_label = "test (I, II, III; mill 1, 2 each)",
              .y_label = "larger absolute error, % of nominal",
              .caption = "Published results, Table 1 on our simulated resultant, and the fit of the whole profile.",
              .series = {{.name = "published", .style = Style::points, .x = {}, .y = {}},
                         {.name = "Table 1 on the resultant", .style = Style::points, .x = {}, .y = {}},
                         {.name = "profile fit", .style = Style::points, .x = {}, .y = {}}}};
    constexpr std::array<Method, 3> methods = {as_published, against_nominal, profile_fit};
    double number = 1.0;
    for (const Series& series : all) {
        for (const Test& test : series.tests) {
            for (std::size_t m = 0; m < methods.size(); ++m) {
                const Variation& estimate = test.estimate[methods[m]];
                const double error = std::max(std::abs(estimate.axial - test.truth.axial),
                                              std::abs(estimate.radial - test.truth.radial));
                if (std::isfinite(error)) {
                    plot.series[m].x.push_back(number);
                    plot.series[m].y.push_back(error);
                }
            }
            number += 1.0;
        }
    }
    return plot;
}

Plot random_errors(const std::vector<RandomCutOutcome>& outcomes) {
    std::vector<double> errors;
    for (const RandomCutOutcome& o : outcomes) {
        const double error = std::max(std::abs(o.axial_error_percent), std::abs(o.radial_error_percent));
        if (std::isfinite(o.axial_error_percent) && std::isfinite(o.radial_error_percent)) {
            errors.push_back(error);
        }
    }
    std::sort(errors.begin(), errors.end());
    Plot::Series series{.name = "profile fit", .style = Style::line, .x = {}, .y = {}};
    constexpr std::size_t every = 5;
    for (std::size_t i = 0; i < errors.size(); i += every) {
        series.x.push_back(errors[i]);
        series.y.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(outcomes.size()));
    }
    return {.title = "Random cuts: share of cuts below an error",
            .x_label = "larger error of the two depths, % of nominal",
            .y_label = "share of all cuts, %",
            .caption = "The curve ends below 100 %: the rest has no estimate of one depth.",
            .series = {series}};
}

}  // namespace

std::vector<Plot> plots(const std::vector<Series>& all, const std::vector<RandomCutOutcome>& outcomes) {
    std::vector<Plot> all_plots{single_flute(0), single_flute(1), single_flute(2)};
    for (Plot& plot : shape_plots()) {
        all_plots.push_back(std::move(plot));
    }
    all_plots.push_back(flute_average_plot("a", 0, 0, 3));
    all_plots.push_back(flute_average_plot("b", 0, 1, 4));
    all_plots.push_back(flute_average_plot("c", 1, 2, 3));
    all_plots.push_back(published_errors(all));
    all_plots.push_back(random_errors(outcomes));
    return all_plots;
}

}  // namespace millforce::sim::yang
