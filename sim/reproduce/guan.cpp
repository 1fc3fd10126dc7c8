// SPDX-License-Identifier: Apache-2.0
#include "reproduce/fine_integration.hpp"
#include "reproduce/reproduction.hpp"

#include "cutting/chip_thickness.hpp"
#include "cutting/oblique_cutting.hpp"
#include "cutting/revolution_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

/// Guan et al.: the plant's force model. What the paper prints, the five cases of its Fig. 6, flank and bottom edge
/// separately, three models of the chip, and the plant against the fine integration of fine_integration.hpp.

namespace millforce::sim {
namespace guan_reproduction {
namespace {

using Series = Plot::Series;
using Judged = Figure::Judged;

constexpr double not_printed = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = std::numbers::pi;
constexpr double degree = pi / 180.0;

// Section 4.
constexpr int teeth = 4;
constexpr double radius_mm = 5.0;
constexpr double helix_rad = 55.0 * degree;
constexpr double feed_per_tooth_mm = 0.1;

// Section 3.2. The rake is not printed: 5° is what the printed shear angle follows from.
constexpr double chip_compression = 1.8;
constexpr double rake_rad = 5.0 * degree;
constexpr double friction_rad = 19.8 * degree;
constexpr double resultant_N = 68.0;

// Not printed, and the scale of all curves: shear stress of die steel of 42 HRC.
constexpr double assumed_shear_stress_N_mm2 = 800.0;

struct Case {
    const char* name;
    double axial_depth_mm;
    double radial_width_mm;
    bool up;
};

/// Fig. 6, curves 1 to 5. 12 mm is more than the cutter is wide: a slot.
constexpr std::array<Case, 5> figure_6{{
    {"1: a_p 2.5, a_e 6 mm, up", 2.5, 6.0, true},
    {"2: a_p 1, a_e 12 mm, climb (slot)", 1.0, 12.0, false},
    {"3: a_p 1, a_e 3 mm, up", 1.0, 3.0, true},
    {"4: a_p 1, a_e 2 mm, up", 1.0, 2.0, true},
    {"5: a_p 1, a_e 2 mm, climb", 1.0, 2.0, false},
}};

double swept_rad(double radial_width_mm) {
    return std::acos(std::max(-1.0, 1.0 - radial_width_mm / radius_mm));
}

BottomEdge bottom_edge() {
    BottomEdge edge{.shear_stress_N_mm2 = assumed_shear_stress_N_mm2,
                    .chip_compression = chip_compression,
                    .friction_angle_rad = friction_rad,
                    .rake_rad = rake_rad,
                    .width_mm = 1.0};
    // As wide as gives the printed resultant at the thickest chip, h = f_z.
    edge.width_mm = resultant_N / orthogonal_resultant_N(edge, feed_per_tooth_mm);
    return edge;
}

FineCut fine_cut(const Case& cut) {
    const double sweep = swept_rad(cut.radial_width_mm);
    const BottomEdge bottom = bottom_edge();
    const ShearedEdge edge{assumed_shear_stress_N_mm2, fine_shear_angle_rad(rake_rad, chip_compression), friction_rad,
                           rake_rad};
    return {teeth,
            radius_mm,
            helix_rad,
            cut.axial_depth_mm,
            feed_per_tooth_mm,
            cut.up ? 0.0 : pi - sweep,
            cut.up ? sweep : pi,
            edge,
            edge,
            bottom.width_mm};
}

/// The plant of the same cut; with or without the bottom edge.
CuttingForce plant_of(const FineCut& cut, bool with_bottom, ChipModel model = ChipModel::trochoidal) {
    Cutter cutter;
    cutter.teeth = static_cast<std::size_t>(cut.teeth);
    cutter.diameter_mm = 2.0 * cut.radius_mm;
    cutter.flute_length_mm = std::max(cut.axial_depth_mm, 1.0);
    cutter.helix_rad = cut.helix_rad;
    const ObliqueCut oblique{.shear_stress_N_mm2 = cut.flank.shear_stress_N_mm2,
                             .shear_angle_rad = cut.flank.shear_angle_rad,
                             .friction_angle_rad = cut.flank.friction_angle_rad,
                             .rake_rad = cut.flank.rake_rad,
                             .inclination_rad = cut.helix_rad};
    CuttingForceOptions options{.chip_model = model};
    if (with_bottom) {
        BottomEdge bottom = bottom_edge();
        bottom.width_mm = cut.bottom_width_mm;
        options.bottom_edge = bottom;
    }
    return CuttingForce(cutter, oblique_cutting(oblique), options);
}

EngagementMap map_of(const FineCut& cut) {
    return uniform_engagement(cut.entry_rad, cut.exit_rad, cut.axial_depth_mm);
}

void add_chisel_edge(Reproduction& result) {
    const BottomEdge edge = bottom_edge();
    const BottomEdgeForce force = orthogonal_components(edge, resultant_N);
    const double shear_rad = orthogonal_shear_angle_rad(rake_rad, chip_compression);
    auto& figures = result.figures;
    figures.push_back({"3.2: shear angle φ_c at a chip compression of 1.8 (γ 5°, not printed)", "°", 30.2,
                       shear_rad / degree, Judged::difference, 0.05});
    figures.push_back({"3.2: friction angle by Lee & Shaffer, 45° + γ − φ_c (where it comes from is not printed)", "°",
                       19.8, 45.0 + rake_rad / degree - shear_rad / degree, Judged::difference, 0.05});
    figures.push_back(
        {"3.2: chip edge F_x, of F = 68 N (printed to ± 0.5 N)", "N", 65.6, force.cutting_N, Judged::difference, 0.2});
    figures.push_back({"3.2: chip edge F_z, of F = 68 N", "N", 17.5, force.thrust_N, Judged::difference, 0.2});
    figures.push_back(
        {"3.2: resultant of the two printed components", "N", 68.0, std::hypot(65.6, 17.5), Judged::difference, 0.5});
    figures.push_back({"3.2: τ_s times the section, which F = 68 N takes (neither is printed)", "N", not_printed,
                       resultant_N * edge.shear_stress_N_mm2 / orthogonal_resultant_N(edge, 1.0), Judged::shown});
}

/// Angle over which points of the periphery lie in a strip of this width, by counting.
double counted_engagement_deg(double radial_width_mm) {
    constexpr int points = 360000;
    int inside = 0;
    for (int k = 0; k < points; ++k) {
        const double phi = pi * (k + 0.5) / points;  // the half in front of the axis
        inside += radius_mm - radius_mm * std::cos(phi) < radial_width_mm ? 1 : 0;
    }
    return 180.0 * inside / points;
}

void add_geometry(Reproduction& result) {
    Cutter cutter;
    cutter.diameter_mm = 2.0 * radius_mm;
    cutter.helix_rad = helix_rad;
    for (const double depth_mm : {1.0, 2.5}) {
        result.figures.push_back({fmt::format("3: lag ψ_a at a_p {:g} mm, Ø10, helix 55°", depth_mm), "°",
                                  depth_mm * std::tan(helix_rad) / radius_mm / degree,
                                  helix_lag_rad(cutter, depth_mm) / degree, Judged::difference, 1e-9});
    }
    for (const double width_mm : {2.0, 3.0}) {
        const double printed = 90.0 - std::asin(1.0 - width_mm / radius_mm) / degree;
        result.figures.push_back(
            {fmt::format("3.1.2 (1): engaged angle θ_ex − ψ_a − π at a_e {:g} mm, ours counted", width_mm), "°",
             printed, counted_engagement_deg(width_mm), Judged::difference, 0.001});
    }
    const double printed = 90.0 + std::asin(1.0 - 6.0 / radius_mm) / degree;
    const double counted = counted_engagement_deg(6.0);
    result.figures.push_back(
        {"3.1.2 (3): the same at a_e 6 mm as printed, with its sign slipped", "°", printed, counted, Judged::shown});
    result.figures.push_back({"3.1.2 (1) used for a_e 6 mm as well: the formula holds for all widths", "°",
                              90.0 - std::asin(1.0 - 6.0 / radius_mm) / degree, counted, Judged::difference, 0.001});
    result.figures.push_back({"4: a_e 12 mm, wider than the cutter: engaged angle", "°", 180.0,
                              counted_engagement_deg(12.0), Judged::difference, 0.001});
}

/// F_x of the five cases over a revolution (Fig. 6).
void add_curves(Reproduction& result) {
    constexpr int points = 360;
    Plot all{
        "F_x of the five cases over one revolution (Fig. 6)",
        "rotation of the spindle in °",
        "F_x in N",
        "On the workpiece, along the feed; flank and bottom edge together. The scale follows from an assumed shear "
        "stress of 800 N/mm², which the paper does not print. In cuts 3 to 5 the teeth take turns and the force "
        "returns to nothing; in 1 and 2 the next tooth is there before.",
        {}};
    for (const Case& c : figure_6) {
        const FineCut cut = fine_cut(c);
        const CuttingForce plant = plant_of(cut, true);
        const EngagementMap map = map_of(cut);
        Series curve{c.name, Series::Style::line, {}, {}};
        for (int k = 0; k <= points; ++k) {
            curve.x.push_back(k);
            curve.y.push_back(plant.load(k * degree, feed_per_tooth_mm, map).fx_N);
        }
        all.series.push_back(curve);
    }
    result.plots.push_back(all);
}

/// F_x and F_z of case 4 by flank and by bottom edge.
void add_edges_apart(Reproduction& result) {
    const FineCut cut = fine_cut(figure_6[3]);
    const EngagementMap map = map_of(cut);
    const CuttingForce flank = plant_of(cut, false);
    const CuttingForce both = plant_of(cut, true);
    Plot parts{
        "Flank and bottom edge of case 4 (section 3)",
        "rotation of the spindle in °",
        "force in N",
        "a_p 1 mm, a_e 2 mm, up milling, one tooth pitch. The bottom edge cuts only while the tip is in the arc of "
        "cut, and presses the workpiece down; the flank's helix lifts it, and stays in cut until the top has left.",
        {{"flank, F_x", Series::Style::line, {}, {}},
         {"bottom edge, F_x", Series::Style::line, {}, {}},
         {"flank, F_z", Series::Style::line, {}, {}},
         {"bottom edge, F_z", Series::Style::line, {}, {}}}};
    for (int k = 0; k <= 180; ++k) {
        const double angle = 0.5 * k;
        const CuttingLoad one = flank.load(angle * degree, feed_per_tooth_mm, map);
        const CuttingLoad two = both.load(angle * degree, feed_per_tooth_mm, map);
        const std::array<double, 4> values{one.fx_N, two.fx_N - one.fx_N, one.fz_N, two.fz_N - one.fz_N};
        for (std::size_t j = 0; j < values.size(); ++j) {
            parts.series[j].x.push_back(angle);
            parts.series[j].y.push_back(values[j]);
        }
    }
    result.plots.push_back(parts);
}

/// What section 4 says about curve 4: low while only a part of the edge cuts, highest with all of it, 0 at last.
void add_shape_of_curve_4(Reproduction& result) {
    const FineCut cut = fine_cut(figure_6[3]);
    const CuttingForce plant = plant_of(cut, true);
    const EngagementMap map = map_of(cut);
    const double sweep_deg = cut.axial_depth_mm * std::tan(helix_rad) / radius_mm / degree;
    double peak_N = 0.0;
    double peak_at_deg = 0.0;
    for (int k = 0; k < 1800; ++k) {
        const double angle = 0.05 * k;
        const double force_N = std::abs(plant.load(angle * degree, feed_per_tooth_mm, map).fx_N);
        if (force_N > peak_N) {
            peak_N = force_N;
            peak_at_deg = angle;
        }
    }
    result.figures.push_back(
        {"4, curve 4: the peak of F_x comes while the whole edge cuts (bound: from ψ_a to the exit)", "°", not_printed,
         peak_at_deg, Judged::within, cut.exit_rad / degree, sweep_deg});
    const double gone_deg = cut.exit_rad / degree + sweep_deg + 0.01;
    result.figures.push_back({fmt::format("4, curve 4: F_x after the edge has left, at {:.1f}° of 90°", gone_deg), "N",
                              0.0, plant.load(gone_deg * degree, feed_per_tooth_mm, map).fx_N, Judged::difference,
                              0.0});
}

double largest_component(const FineForce& force) {
    return std::max({std::abs(force.fx_N), std::abs(force.fy_N), std::abs(force.fz_N)});
}

/// The largest difference of any component, relative to the force's size; of the torque relative to itself.
double difference_of(const FineForce& fine, double fx_N, double fy_N, double fz_N, double torque_Nm, double size_N,
                     double size_Nm) {
    return std::max({std::abs(fx_N - fine.fx_N) / size_N, std::abs(fy_N - fine.fy_N) / size_N,
                     std::abs(fz_N - fine.fz_N) / size_N, std::abs(torque_Nm - fine.torque_Nm) / size_Nm});
}

double average_difference(const FineCut& cut, bool with_bottom) {
    const FineForce fine = fine_average(cut, 100, 50);
    const RevolutionLoad plant =
        revolution_load(plant_of(cut, with_bottom), cut.feed_per_tooth_mm, map_of(cut), 0.25 * degree);
    const double size_N = std::hypot(fine.fx_N, fine.fy_N, fine.fz_N);
    return difference_of(fine, plant.mean_fx_N, plant.mean_fy_N, plant.mean_fz_N, plant.mean_torque_Nm, size_N,
                         fine.torque_Nm);
}

double momentary_difference(const FineCut& cut, bool with_bottom) {
    constexpr int angles = 90;
    constexpr int axial_steps = 200;
    const CuttingForce plant = plant_of(cut, with_bottom);
    const EngagementMap map = map_of(cut);
    double size_N = 0.0;
    double size_Nm = 0.0;
    std::vector<FineForce> fine;
    for (int k = 0; k < angles; ++k) {
        fine.push_back(fine_force(cut, (k + 0.5) * 2.0 * pi / (cut.teeth * angles), axial_steps));
        size_N = std::max(size_N, largest_component(fine.back()));
        size_Nm = std::max(size_Nm, fine.back().torque_Nm);
    }
    double largest = 0.0;
    for (int k = 0; k < angles; ++k) {
        const CuttingLoad load = plant.load((k + 0.5) * 2.0 * pi / (cut.teeth * angles), cut.feed_per_tooth_mm, map);
        largest = std::max(largest, difference_of(fine[static_cast<std::size_t>(k)], load.fx_N, load.fy_N, load.fz_N,
                                                  load.spindle_torque_Nm, size_N, size_Nm));
    }
    return largest;
}

void add_integration_of_cases(Reproduction& result) {
    for (const bool with_bottom : {false, true}) {
        double average = 0.0;
        double momentary = 0.0;
        for (const Case& c : figure_6) {
            FineCut cut = fine_cut(c);
            cut.bottom_width_mm = with_bottom ? cut.bottom_width_mm : 0.0;
            average = std::max(average, average_difference(cut, with_bottom));
            momentary = std::max(momentary, momentary_difference(cut, with_bottom));
        }
        const char* edges = with_bottom ? "flank and bottom edge" : "flank alone";
        result.figures.push_back(
            {fmt::format("Plant against fine integration, five cases, {}: mean forces and torque", edges), "%",
             not_printed, 100.0 * average, Judged::at_most, 0.1});
        result.figures.push_back(
            {fmt::format("Plant against fine integration, five cases, {}: at 90 angles of a pitch, of the peak", edges),
             "%", not_printed, 100.0 * momentary, Judged::at_most, 0.1});
    }
}

/// Cuts at random: the agreement is none of the five cases' luck.
void add_integration_at_random(Reproduction& result) {
    std::mt19937 engine(1);
    const auto between = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(engine()) / 4294967296.0;
    };
    constexpr int cuts = 40;
    double largest = 0.0;
    for (int k = 0; k < cuts; ++k) {
        FineCut cut = fine_cut(figure_6[0]);
        cut.teeth = 1 + static_cast<int>(between(0.0, 6.0));
        cut.radius_mm = between(2.0, 25.0);
        cut.helix_rad = between(0.0, 55.0) * degree;
        cut.axial_depth_mm = between(0.1, 2.0) * cut.radius_mm;
        cut.feed_per_tooth_mm = between(0.002, 0.05) * cut.radius_mm;
        const double sweep = std::acos(1.0 - between(0.05, 1.95));
        const bool up = engine() % 2U == 0U;
        cut.entry_rad = up ? 0.0 : pi - sweep;
        cut.exit_rad = up ? sweep : pi;
        cut.flank = {between(300.0, 900.0), between(20.0, 40.0) * degree, between(10.0, 35.0) * degree,
                     between(-5.0, 15.0) * degree};
        cut.bottom_width_mm = 0.0;
        largest = std::max(largest, average_difference(cut, false));
    }
    result.figures.push_back(
        {fmt::format("Plant against fine integration, {} cuts at random: mean forces and torque", cuts), "%",
         not_printed, 100.0 * largest, Judged::at_most, 0.1});
}

/// The largest error of a chip model over a slot, in feeds per tooth, against the true path.
double chip_error(ChipModel model, double feed_in_radii) {
    FineCut cut = fine_cut(figure_6[1]);
    cut.feed_per_tooth_mm = feed_in_radii * radius_mm;
    const double pitch = 2.0 * pi / teeth;
    const EdgePass pass{radius_mm, radius_mm, cut.feed_per_tooth_mm / pitch, pitch};
    double largest = 0.0;
    for (int k = 0; k <= 180; ++k) {
        const double phi = k * degree;
        const double h = std::max(0.0, chip_thickness_mm(model, pass, std::sin(phi), std::cos(phi)));
        largest = std::max(largest, std::abs(h - fine_chip_mm(cut, phi)) / cut.feed_per_tooth_mm);
    }
    return largest;
}

/// The largest error of the mean force in the plane, of case 3, by the plant with another chip model.
double force_error(ChipModel model, double feed_in_radii) {
    FineCut cut = fine_cut(figure_6[2]);
    cut.feed_per_tooth_mm = feed_in_radii * radius_mm;
    const auto mean = [&](ChipModel m) {
        return revolution_load(plant_of(cut, false, m), cut.feed_per_tooth_mm, map_of(cut), 1.0 * degree);
    };
    const RevolutionLoad truth = mean(ChipModel::trochoidal);
    const RevolutionLoad other = mean(model);
    return std::hypot(other.mean_fx_N - truth.mean_fx_N, other.mean_fy_N - truth.mean_fy_N) /
           std::hypot(truth.mean_fx_N, truth.mean_fy_N);
}

void add_chip_models(Reproduction& result) {
    Plot plot{
        "Three models of the chip over f_z/R (section 3.1.1)",
        "f_z/R",
        "error in %",
        "Largest error of the thickness over a slot, of f_z, and error of the mean force of case 3. The circle "
        "(h = f_z sin φ) errs by 0.65 f_z/R; the paper's two circles by half of that, since they too keep the axis "
        "still while the tooth turns; in the mean force of this cut the circle's errors happen to cancel better. "
        "The plant uses the true path.",
        {{"circle, thickness", Series::Style::line, {}, {}},
         {"two circles (the paper), thickness", Series::Style::line, {}, {}},
         {"circle, mean force", Series::Style::line, {}, {}},
         {"two circles (the paper), mean force", Series::Style::line, {}, {}}}};
    double worst_trochoid = 0.0;
    for (const double ratio : {0.001, 0.002, 0.005, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3}) {
        const std::array<double, 4> errors{
            chip_error(ChipModel::circular, ratio), chip_error(ChipModel::offset_circle, ratio),
            force_error(ChipModel::circular, ratio), force_error(ChipModel::offset_circle, ratio)};
        for (std::size_t j = 0; j < errors.size(); ++j) {
            plot.series[j].x.push_back(ratio);
            plot.series[j].y.push_back(100.0 * errors[j]);
        }
        worst_trochoid = std::max(worst_trochoid, chip_error(ChipModel::trochoidal, ratio));
    }
    result.plots.push_back(plot);
    constexpr double papers_ratio = feed_per_tooth_mm / radius_mm;
    const auto show = [&](const char* name, double value) {
        result.figures.push_back({name, "%", not_printed, 100.0 * value, Judged::shown});
    };
    show("3.1.1: circle, largest error of the thickness at f_z/R 0.02, of f_z",
         chip_error(ChipModel::circular, papers_ratio));
    show("3.1.1: two circles (the paper), the same", chip_error(ChipModel::offset_circle, papers_ratio));
    show("3.1.1: circle, error of the mean force of case 3 at f_z/R 0.02",
         force_error(ChipModel::circular, papers_ratio));
    show("3.1.1: two circles (the paper), the same", force_error(ChipModel::offset_circle, papers_ratio));
    result.figures.push_back({"The plant's true path against bisection on the path, f_z/R from 0.001 to 0.3, of f_z",
                              "%", not_printed, 100.0 * worst_trochoid, Judged::at_most, 0.1});
}

/// The paper's law of cosines, with the missing "+" and "cos" restored, equals the plant's two circles.
void add_law_of_cosines(Reproduction& result) {
    double largest = 0.0;
    for (int k = 0; k <= 180; ++k) {
        const double theta = k * degree;
        const double f = feed_per_tooth_mm;
        const double angle_BOC = std::acos(f * std::cos(theta) / radius_mm) - theta;
        const double BC = std::sqrt(radius_mm * radius_mm + f * f - 2.0 * radius_mm * f * std::cos(angle_BOC));
        const EdgePass pass{radius_mm, radius_mm, f, 1.0};
        const double h = offset_circle_chip_mm(pass, std::sin(theta), std::cos(theta));
        largest = std::max(largest, std::abs(radius_mm - BC - h) / f);
    }
    result.figures.push_back({"3.1.1: law of cosines, the lost signs put back, against the plant's two circles, of f_z",
                              "%", not_printed, 100.0 * largest, Judged::at_most, 1e-9});
}

void add_deviations(std::vector<std::string>& deviations) {
    deviations.emplace_back(
        "Chip thickness: |BC|² is printed as R² f_z² − 2 R f_z ∠BOC. The law of cosines has R² + f_z² − 2 R f_z cos "
        "∠BOC. The paper takes the axis to stand still between E and C; the plant solves for the true path.");
    deviations.emplace_back(
        "Eq. 1: the text calls θ_i the inclination of the cutting speed and i the angle of the shear plane. i is the "
        "inclination of the edge (the helix), θ_i that of the resultant out of the normal plane. The angles that the "
        "paper leaves open are closed by Stabler's rule.");
    deviations.emplace_back(
        "3.1.2 (3) and 3.1.3 (3), widths between r and 2r: at a_e 6 mm the printed signs give 78.5° of engagement in "
        "up milling, where it is 101.5°, and in climb milling an entry behind the exit. The formulas of case (1) "
        "hold for all widths; a_e 12 mm on Ø10, which none of the four cases covers, is a slot.");
    deviations.emplace_back(
        "3.1.2 (1)c: the upper limit is θ_ex − ψ_a, not θ_ex, in which ψ_a is already counted. The test between (1) "
        "and (2) must be made without ψ_a as well: as printed, (2) never occurs.");
    deviations.emplace_back(
        "3.1.3 (1)b is printed from π + ψ_a to θ_ex − ψ_a = π, an empty range: it begins at θ_st + ψ_a. 3.1.3 (2)b "
        "is integrated from π to π: the lower limit is θ_st. One rule replaces all cases: an element cuts while its "
        "own angle lies in [φ_st, φ_ex].");
    deviations.emplace_back(
        "Section 4 explains the fall of curve 4 by the chip growing thinner. It is the up-milling curve, whose chip "
        "grows until the exit: it falls because the edge leaves, from the tip up.");
    deviations.emplace_back(
        "The rake of the bottom edge is not printed: 5° is what the printed shear angle needs. With it the printed "
        "friction angle is Lee & Shaffer's 45° + γ − φ_c. F_x and F_z are printed from an F rounded to 68 N.");
    deviations.emplace_back(
        "τ_s, the friction and shear angles of the flank and the section of the bottom edge are not printed. Here: "
        "the bottom edge's angles for both, 800 N/mm², and a bottom edge as wide as gives 68 N at h = f_z. So the "
        "curves have the paper's shape, not its scale.");
    deviations.emplace_back(
        "The published 7.38 % is the largest difference between the paper's model and its measurement. Neither the "
        "measured values nor τ_s are printed: it cannot be reproduced, and no figure here stands for it.");
}

constexpr const char* summary =
    "A model of the force on a flat end mill: what its helical flanks and its bottom edges cut, from the material's "
    "shear stress and the tool's angles. The simulation of this project mills with it, and tests its estimators "
    "against "
    "it. Here its force over a revolution is drawn for the paper's five cuts, the numbers that the paper prints are "
    "checked, and the simulated force is held against a far finer integration of the same model.";

}  // namespace
}  // namespace guan_reproduction

Reproduction reproduce_guan() {
    using namespace guan_reproduction;
    Reproduction result;
    result.name = "guan";
    result.title = "The cutting force of a flat end mill, flank and bottom edge (Guan et al.)";
    result.summary = summary;
    add_chisel_edge(result);
    add_geometry(result);
    add_law_of_cosines(result);
    add_curves(result);
    add_edges_apart(result);
    add_shape_of_curve_4(result);
    add_chip_models(result);
    add_integration_of_cases(result);
    add_integration_at_random(result);
    add_deviations(result.deviations);
    return result;
}

}  // namespace millforce::sim
