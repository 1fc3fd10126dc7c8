// SPDX-License-Identifier: Apache-2.0
#include "reproduce/yang_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "cutting/angle_units.hpp"
#include "cutting/cutting_force.hpp"
#include "reproduce/yang_published.hpp"
#include "reproduce/yang_tables.hpp"

namespace millforce::sim::yang {
namespace {

using estimation::FluteForceType;
using estimation::FluteOverlap;
using PlotSeries = Plot::Series;
using Style = Plot::Series::Style;

constexpr int samples_per_revolution = 1440;
constexpr std::array<const char*, 3> type_names{"I", "II", "III"};
constexpr std::array<const char*, 4> overlap_names{"NO", "LO", "MO", "HO"};

estimation::FluteGeometry<double> geometry_of(const FluteShape& shape) {
    return {static_cast<int>(shape.flutes), 0.5 * yang_mills[0].diameter_mm, yang_mills[0].helix_deg * degree};
}

/// Each flute's force over a revolution.
std::vector<CuttingLoad> loads_of(const SteadyCut& cut) {
    Cutter cutter = cut.cutter;
    cutter.flute_length_mm = cut.axial_depth_mm;
    const CuttingForce force(cutter, cut.coefficients);
    const double engagement_rad = std::acos(1.0 - cut.radial_depth_mm / (0.5 * cutter.diameter_mm));
    const EngagementMap map =
        uniform_engagement(std::numbers::pi - engagement_rad, std::numbers::pi, cut.axial_depth_mm);
    std::vector<CuttingLoad> loads;
    loads.reserve(samples_per_revolution);
    for (int i = 0; i < samples_per_revolution; ++i) {
        loads.push_back(force.load(cut.tip_angle_rad + turn * i / samples_per_revolution, cut.feed_per_tooth_mm, map));
    }
    return loads;
}

/// Over rotation in pitches, relative to the largest force of one flute.
struct ShapeForces {
    std::vector<double> rotation_pitches;
    std::vector<double> one_flute;
    std::vector<double> sum;
};

ShapeForces forces_of(const FluteShape& shape) {
    const SteadyCut cut = cut_of(shape);
    const std::vector<CuttingLoad> loads = loads_of(cut);
    double largest_N = 0.0;
    for (const CuttingLoad& load : loads) {
        largest_N = std::max(largest_N, load.tooth_force_N[0]);
    }
    ShapeForces forces;
    for (std::size_t i = 0; i < loads.size(); ++i) {
        const auto& teeth_N = loads[i].tooth_force_N;
        forces.rotation_pitches.push_back(static_cast<double>(i * shape.flutes) / samples_per_revolution);
        forces.one_flute.push_back(teeth_N[0] / largest_N);
        forces.sum.push_back(std::accumulate(teeth_N.begin(), teeth_N.end(), 0.0) / largest_N);
    }
    return forces;
}

PlotSeries line(const std::string& name, const std::vector<double>& x, const std::vector<double>& y, double last_x) {
    PlotSeries series{name, Style::line, {}, {}};
    for (std::size_t i = 0; i < x.size() && x[i] <= last_x; ++i) {
        series.x.push_back(x[i]);
        series.y.push_back(y[i]);
    }
    return series;
}

bool has_flat_top(const FluteShape& shape) {
    return shape.category.type == FluteForceType::II &&
           (shape.category.overlap == FluteOverlap::none || shape.category.overlap == FluteOverlap::low);
}

/// Where Table 1 puts the peak, or with a flat top its end, after the entry of a flute.
double marked_rad(const FluteShape& shape) {
    const auto angles = angles_of(shape);
    return has_flat_top(shape) ? angles.sweep_rad : estimation::published_peak_angle_rad(angles);
}

/// The four overlaps of a type (Figs. 13–15).
Plot overlaps_of_type(std::size_t type) {
    constexpr double shown_pitches = 2.0;
    Plot plot{
        .title = fmt::format("Four overlaps of type {} (Fig. {})", type_names[type], type + 13),
        .x_label = "rotation in flute pitches",
        .y_label = "sum of the flutes' forces, largest force of one = 1",
        .caption =
            std::array{
                "Forces added as numbers, as the paper adds them. Points: the peak by Table 1, counted "
                "from the entry of a flute (0, 1, 2).",
                "The same. NO and LO have a flat top: there the point is its end. In HO the sum goes on rising past "
                "the point, until the flute before begins to fall, at α_sw − α_T.",
                "The same. In MO and HO the sum does not peak at Table 1's point but at α_sw, the end of the next "
                "flute's entry: why Table 7 is not judged by Table 1."}[type],
        .series = {}};
    PlotSeries points{"by Table 1", Style::points, {}, {}};
    for (std::size_t overlap = 0; overlap < overlap_names.size(); ++overlap) {
        const FluteShape& shape = flute_shapes()[4 * type + overlap];
        const ShapeForces forces = forces_of(shape);
        plot.series.push_back(line(fmt::format("{}: {} flutes, α_en {:g}°, α_sw {:g}°", overlap_names[overlap],
                                               shape.flutes, shape.engagement_deg, shape.sweep_deg),
                                   forces.rotation_pitches, forces.sum, shown_pitches));
        const double at = marked_rad(shape) / angles_of(shape).pitch_rad;
        const auto sample =
            static_cast<std::size_t>(std::lround(at * samples_per_revolution / static_cast<double>(shape.flutes)));
        points.x.push_back(at);
        points.y.push_back(forces.sum[sample]);
    }
    plot.series.push_back(points);
    return plot;
}

/// One flute's force beside the entry of the next (Fig. 10).
Plot overlaps_of_one_flute() {
    constexpr double shown_pitches = 3.0;
    Plot plot{.title = "One flute's force against the entry of the next: four degrees of overlap (Fig. 10)",
              .x_label = "rotation in flute pitches",
              .y_label = "force of one flute, largest = 1",
              .caption =
                  "Type I. The next flute enters at 1. By then the first one is done (NO), is falling (LO), has been "
                  "falling for so long that the next one also peaks while it falls (MO), or still rises (HO).",
              .series = {}};
    for (std::size_t overlap = 0; overlap < overlap_names.size(); ++overlap) {
        const ShapeForces forces = forces_of(flute_shapes()[overlap]);
        plot.series.push_back(line(overlap_names[overlap], forces.rotation_pitches, forces.one_flute, shown_pitches));
    }
    plot.series.push_back({"next flute enters", Style::line, {1.0, 1.0}, {0.0, 1.0}});
    return plot;
}

/// Eq. 2: ADOC_c/R over RDOC/R.
PlotSeries critical_axial_depth(double helix_deg) {
    PlotSeries series{fmt::format("I–II (Eq. 2), helix {:g}°", helix_deg), Style::line, {}, {}};
    for (int k = 0; k <= 100; ++k) {
        series.x.push_back(0.02 * k);
        series.y.push_back(std::acos(1.0 - series.x.back()) / std::tan(helix_deg * degree));
    }
    return series;
}

/// Eq. 3, solved for ADOC/R over RDOC_c/R.
PlotSeries critical_radial_depth(double helix_deg) {
    PlotSeries series{fmt::format("I–III (Eq. 3), helix {:g}°", helix_deg), Style::line, {}, {}};
    for (int k = 0; k <= 100; ++k) {
        series.x.push_back(1.0 + 0.01 * k);
        series.y.push_back(2.0 * std::asin(series.x.back() - 1.0) / std::tan(helix_deg * degree));
    }
    return series;
}

/// The published cuts of one mill and type, nominal and varied, in radii.
PlotSeries published_cuts(std::size_t mill, std::size_t type) {
    const YangMill& table = yang_mills[mill];
    PlotSeries series{fmt::format("mill {}, type {}", mill + 1, type_names[type]), Style::points, {}, {}};
    const auto add = [&](double axial_percent, double radial_percent) {
        const SteadyCut cut = published_cut(mill, type, {axial_percent, radial_percent});
        series.x.push_back(cut.radial_depth_mm / (0.5 * table.diameter_mm));
        series.y.push_back(cut.axial_depth_mm / (0.5 * table.diameter_mm));
    };
    add(0.0, 0.0);
    for (std::size_t t = 0; t < table.axial_variation_percent.size(); ++t) {
        add(table.axial_variation_percent[t], table.radial_variation_percent[t]);
    }
    return series;
}

Plot types_of_one_flute() {
    Plot plot{.title = "Types of one flute's force over both depths, with the published cuts (Fig. 8)",
              .x_label = "RDOC/R",
              .y_label = "ADOC/R",
              .caption =
                  "Type I lies below both lines of a helix, II above the first, III to the right of the second. Mill 1 "
                  "has a helix of 30°, mill 2 of 50°. All published cuts lie in the type of their table.",
              .series = {}};
    for (const double helix_deg : {30.0, 50.0}) {
        plot.series.push_back(critical_axial_depth(helix_deg));
        plot.series.push_back(critical_radial_depth(helix_deg));
    }
    for (std::size_t mill = 0; mill < yang_mills.size(); ++mill) {
        for (std::size_t type = 0; type < type_names.size(); ++type) {
            plot.series.push_back(published_cuts(mill, type));
        }
    }
    return plot;
}

Plot types_and_overlaps() {
    constexpr double helix_deg = 30.0;
    constexpr double pitch_rad = turn / 3.0;
    const double tan_helix = std::tan(helix_deg * degree);
    const double highest = pitch_rad / tan_helix;
    const double width_of_pitch = 1.0 - std::cos(pitch_rad);
    PlotSeries both{"α_en + α_sw = α_T", Style::line, {}, {}};
    for (int k = 0; k <= 75; ++k) {
        both.x.push_back(0.02 * k);
        both.y.push_back(std::max(0.0, pitch_rad - std::acos(1.0 - both.x.back())) / tan_helix);
    }
    return {.title = "Types and overlaps of three flutes, helix 30° (Fig. 11)",
            .x_label = "RDOC/R",
            .y_label = "ADOC/R",
            .caption =
                "No overlap below the sum's line, low overlap from there on, medium beyond one of the other two "
                "lines, high beyond both.",
            .series = {critical_axial_depth(helix_deg),
                       critical_radial_depth(helix_deg),
                       both,
                       {"α_en = α_T", Style::line, {width_of_pitch, width_of_pitch}, {0.0, 6.0}},
                       {"α_sw = α_T", Style::line, {0.0, 2.0}, {highest, highest}}}};
}

}  // namespace

const std::array<FluteShape, 12>& flute_shapes() {
    using enum FluteForceType;
    static const std::array<FluteShape, 12> shapes{{
        {{I, FluteOverlap::none}, 3, 78.0, 26.0},
        {{I, FluteOverlap::low}, 4, 78.0, 26.0},
        {{I, FluteOverlap::medium}, 6, 78.0, 26.0},
        {{I, FluteOverlap::high}, 6, 80.0, 70.0},
        {{II, FluteOverlap::none}, 4, 26.0, 50.0},
        {{II, FluteOverlap::low}, 4, 43.0, 70.0},
        {{II, FluteOverlap::medium}, 4, 43.0, 115.0},
        {{II, FluteOverlap::high}, 6, 65.0, 85.0},
        {{III, FluteOverlap::none}, 2, 120.0, 30.0},
        {{III, FluteOverlap::low}, 3, 115.0, 20.0},
        {{III, FluteOverlap::medium}, 4, 120.0, 30.0},
        {{III, FluteOverlap::high}, 6, 150.0, 40.0},
    }};
    return shapes;
}

estimation::FluteAngles<double> angles_of(const FluteShape& shape) {
    return {shape.engagement_deg * degree, shape.sweep_deg * degree, turn / static_cast<double>(shape.flutes)};
}

SteadyCut cut_of(const FluteShape& shape) {
    SteadyCut cut = published_cut(0, 0, {0.0, 0.0});
    const auto angles = angles_of(shape);
    const auto depths = estimation::depths_of_cut(geometry_of(shape), angles);
    cut.cutter.teeth = shape.flutes;
    cut.cutter.runout_mm = 0.0;
    cut.axial_depth_mm = depths.axial_mm;
    cut.radial_depth_mm = depths.radial_mm;
    cut.tip_angle_rad = std::numbers::pi - angles.engagement_rad;
    return cut;
}

std::string name_of(const FluteShape& shape) {
    return fmt::format("{}/{}", type_names[static_cast<std::size_t>(shape.category.type)],
                       overlap_names[static_cast<std::size_t>(shape.category.overlap)]);
}

bool peaks_by_table_1(const FluteShape& shape) {
    const ShapeForces forces = forces_of(shape);
    const auto end_of_pitch = forces.sum.begin() + samples_per_revolution / static_cast<std::ptrdiff_t>(shape.flutes);
    const auto peak = std::max_element(forces.sum.begin(), end_of_pitch);
    auto marked = peak;
    if (has_flat_top(shape)) {
        constexpr double flat = 0.999;
        marked = std::find_if(peak, end_of_pitch, [&](double force) { return force < flat * *peak; });
    }
    const double peak_rad = turn * static_cast<double>(marked - forces.sum.begin()) / samples_per_revolution;
    return std::abs(peak_rad - marked_rad(shape)) <= 1.0 * degree;
}

int flutes_in_cut_of_plant(const SteadyCut& cut) {
    std::ptrdiff_t most = 0;
    for (const CuttingLoad& load : loads_of(cut)) {
        most = std::max(most, std::count_if(load.tooth_force_N.begin(), load.tooth_force_N.end(),
                                            [](double force_N) { return force_N > 0.0; }));
    }
    return static_cast<int>(most);
}

std::vector<Plot> shape_plots() {
    return {types_of_one_flute(), overlaps_of_one_flute(), types_and_overlaps(),
            overlaps_of_type(0),  overlaps_of_type(1),     overlaps_of_type(2)};
}

}  // namespace millforce::sim::yang
