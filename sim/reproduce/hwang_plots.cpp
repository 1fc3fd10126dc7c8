// SPDX-License-Identifier: Apache-2.0
#include "reproduce/hwang_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace millforce::sim {

namespace {

Plot::Series diagonal_line() {
    return {"true", Plot::Series::Style::line, {0.2, 0.8}, {0.2, 0.8}};
}

}  // namespace

void add_table_plots(const std::vector<TableRow>& rows, const std::vector<TableResult>& results, Reproduction& out) {
    int paper_figure = 9;
    for (std::size_t k = 0; k < rows.size();) {
        Plot plot{.title = fmt::format("Estimated immersion by {} (Fig. {})", rows[k].group, paper_figure),
                  .x_label = "true immersion",
                  .y_label = "estimated immersion",
                  .caption = "Each point is one estimate from four revolutions; the line is the truth.",
                  .series = {diagonal_line()}};
        const std::string group = rows[k].group;
        for (; k < rows.size() && rows[k].group == group; ++k) {
            Plot::Series series{describe(rows[k].cut), Plot::Series::Style::points, {}, {}};
            for (const TableCut& cut : results[k]) {
                for (const ForceDropRun& run : cut.runs) {
                    if (run.estimate.valid()) {
                        series.x.push_back(cut.immersion);
                        series.y.push_back(static_cast<double>(run.estimate.radial_immersion));
                    }
                }
            }
            plot.series.push_back(std::move(series));
        }
        out.plots.push_back(std::move(plot));
        ++paper_figure;
    }
}

void add_varying_plot(const std::vector<ForceDropRun>& runs, Reproduction& out) {
    Plot::Series truth{"true", Plot::Series::Style::line, {}, {}};
    Plot::Series estimate{"estimate", Plot::Series::Style::points, {}, {}};
    Plot::Series low{"two standard deviations below", Plot::Series::Style::band_low, {}, {}};
    Plot::Series high{"two standard deviations above", Plot::Series::Style::band_high, {}, {}};
    for (const ForceDropRun& run : runs) {
        truth.x.push_back(run.revolution);
        truth.y.push_back(run.immersion);
        if (run.estimate.valid()) {
            const double ours = static_cast<double>(run.estimate.radial_immersion);
            const double sd = static_cast<double>(run.estimate.radial_immersion_sd);
            for (Plot::Series* series : {&estimate, &low, &high}) {
                series->x.push_back(run.revolution);
            }
            estimate.y.push_back(ours);
            low.y.push_back(ours - 2.0 * sd);
            high.y.push_back(ours + 2.0 * sd);
        }
    }
    out.plots.push_back({.title = "Continuously varying immersion (Fig. 15)",
                         .x_label = "revolution",
                         .y_label = "immersion",
                         .caption = "One estimate per revolution. About immersion 0.5 one tooth enters where another "
                                    "leaves: the deviation grows there, or there is no estimate.",
                         .series = {low, high, truth, estimate}});
}

void add_edge_plot(const std::vector<TableResult>& ours, const std::vector<TableResult>& without, Reproduction& out) {
    Plot plot{.title = "The edge force at work: the paper's equations with and without it",
              .x_label = "true immersion",
              .y_label = "estimated immersion",
              .caption =
                  "Rows 1 to 10 by Eqs. 6, 11 and 12 alone. Left in, the edge force spreads the estimates, most at "
                  "small immersion, where its share is largest.",
              .series = {diagonal_line()}};
    const auto add = [&](const char* name, const std::vector<TableResult>& results) {
        Plot::Series series{name, Plot::Series::Style::points, {}, {}};
        for (std::size_t k = 0; k < 10 && k < results.size(); ++k) {
            for (const TableCut& cut : results[k]) {
                for (const ForceDropRun& run : cut.runs) {
                    if (run.estimate.by_direction.valid) {
                        series.x.push_back(cut.immersion);
                        series.y.push_back(static_cast<double>(run.estimate.by_direction.immersion()));
                    }
                }
            }
        }
        plot.series.push_back(std::move(series));
    };
    add("edge force left in", without);
    add("edge force taken out", ours);
    out.plots.push_back(std::move(plot));
}

void add_drive_plot(const std::vector<TableCut>& cuts, Reproduction& out) {
    Plot::Series series{"from the feed drives", Plot::Series::Style::points, {}, {}};
    for (const TableCut& cut : cuts) {
        for (const ForceDropRun& run : cut.runs) {
            if (run.estimate.valid()) {
                series.x.push_back(cut.immersion);
                series.y.push_back(static_cast<double>(run.estimate.radial_immersion));
            }
        }
    }
    out.plots.push_back({.title = "Immersion from feed-drive currents, 200 rpm, 3 inserts",
                         .x_label = "true immersion",
                         .y_label = "estimated immersion",
                         .caption = "No force sensor: current and velocity of both axes, feed along the diagonal.",
                         .series = {diagonal_line(), series}});
}

void add_signal_plots(std::uint64_t seed, Reproduction& out) {
    const auto add = [&](const BenchCut& cut, const char* title, const char* caption) {
        Plot::Series x{"F_x", Plot::Series::Style::line, {}, {}};
        Plot::Series y{"F_y", Plot::Series::Style::line, {}, {}};
        for (const BenchSample& sample : bench_samples(cut, {.seed = seed}, 1.0)) {
            for (Plot::Series* series : {&x, &y}) {
                series->x.push_back(360.0 * sample.angle_rev);
            }
            x.y.push_back(sample.fx_N);
            y.y.push_back(sample.fy_N);
        }
        out.plots.push_back({.title = title,
                             .x_label = "spindle angle, degrees",
                             .y_label = "force, N",
                             .caption = caption,
                             .series = {x, y}});
    };
    add({.material = steel_SM45C(), .immersion = 0.5},
        "One insert in cut: one revolution at immersion 0.5, as the estimator gets it (Fig. 4)",
        "Three inserts, behind the 300 Hz low-pass, with noise and runout. Each sudden end is a tooth that leaves: its "
        "height is that tooth's force.");
    add({.teeth = 6, .axial_depth_mm = 1.0, .material = steel_SM45C(), .immersion = 0.8},
        "Two inserts in cut: one revolution at immersion 0.8 (Fig. 5)",
        "Six inserts: the next one is in cut before a tooth leaves, so the force falls by that tooth's part, and not "
        "to nothing.");
}

void add_slope_plot(const HwangLaws& laws, Reproduction& out) {
    Plot::Series points{"known cuts", Plot::Series::Style::points, {}, {}};
    double mean_r_av = 0.0;
    double mean_r = 0.0;
    for (const ForceRatioPoint& point : force_ratio_points(laws.steel_cuts)) {
        points.x.push_back(point.r_av);
        points.y.push_back(point.r);
        mean_r_av += point.r_av;
        mean_r += point.r;
    }
    mean_r_av /= static_cast<double>(points.x.size());
    mean_r /= static_cast<double>(points.x.size());
    const double low = *std::min_element(points.x.begin(), points.x.end());
    const double high = *std::max_element(points.x.begin(), points.x.end());
    const auto line = [&](const char* name, double slope) {
        const auto at = [&](double r_av) { return mean_r + slope * (r_av - mean_r_av); };
        return Plot::Series{name, Plot::Series::Style::line, {low, high}, {at(low), at(high)}};
    };
    out.plots.push_back(
        {.title = "Force ratio of a tooth over that of the average forces (Fig. 7, Eq. 12)",
         .x_label = "r_av",
         .y_label = "r",
         .caption =
             "21 cuts of known immersion on the simulated bench, edge force left in, and the line through them. The "
             "paper prints its slope, 0.50465, but no b: drawn through the mean of our points.",
         .series = {points, line("our line", laws.steel_without_edges.law.a), line("slope as printed", 0.50465)}});
}

void add_threshold_plot(const std::vector<ThresholdPoint>& points, Reproduction& out) {
    Plot::Series ours{"from the estimated immersion", Plot::Series::Style::points, {}, {}};
    Plot::Series truth{"plant", Plot::Series::Style::line, {}, {}};
    for (const ThresholdPoint& point : points) {
        ours.x.push_back(point.immersion);
        ours.y.push_back(point.estimated);
        truth.x.push_back(point.immersion);
        truth.y.push_back(point.truth);
    }
    out.plots.push_back({.title = "Threshold against immersion, 6 inserts (introduction)",
                         .x_label = "true immersion",
                         .y_label = "allowed total force per allowed tooth force",
                         .caption = "With more teeth in cut the total may be larger without a tooth bearing more.",
                         .series = {truth, ours}});
}

}  // namespace millforce::sim
