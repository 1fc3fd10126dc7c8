// SPDX-License-Identifier: Apache-2.0
#include "reproduce/guan_checks.hpp"

#include "cutting/chip_thickness.hpp"
#include "cutting/revolution_load.hpp"
#include "reproduce/fine_integration.hpp"
#include "reproduce/guan_cuts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace millforce::sim::guan_reproduction {
namespace {

using Series = Plot::Series;
using Judged = Figure::Judged;

/// Angle over which points of the periphery lie in a strip of this width, by counting.
double counted_engagement_deg(double radial_width_mm) {
    constexpr int points = 360000;
    int inside = 0;
    for (int k = 0; k < points; ++k) {
        const double phi = std::numbers::pi * (k + 0.5) / points;  // the half in front of the axis
        inside += radius_mm - radius_mm * std::cos(phi) < radial_width_mm ? 1 : 0;
    }
    return 180.0 * inside / points;
}

}  // namespace

void check_geometry(Reproduction& out) {
    Cutter cutter;
    cutter.diameter_mm = 2.0 * radius_mm;
    cutter.helix_rad = helix_rad;
    double lag_error_deg = 0.0;
    for (const double depth_mm : {1.0, 2.5}) {
        const double printed_rad = depth_mm * std::tan(helix_rad) / radius_mm;
        lag_error_deg = std::max(lag_error_deg, std::abs(helix_lag_rad(cutter, depth_mm) - printed_rad) / degree);
    }
    out.checks.push_back(own_check("Section 3: lag ψ_a at a_p 1 and 2.5 mm: deviation of the plant's", "°",
                                   lag_error_deg, Judged::at_most, 1e-9));
    const auto by_case_1_deg = [](double width_mm) { return 90.0 - std::asin(1.0 - width_mm / radius_mm) / degree; };
    double engagement_error_deg = 0.0;
    for (const double width_mm : {2.0, 3.0, 6.0}) {
        engagement_error_deg =
            std::max(engagement_error_deg, std::abs(by_case_1_deg(width_mm) - counted_engagement_deg(width_mm)));
    }
    out.checks.push_back(
        own_check("3.1.2 (1): engaged angle θ_ex − ψ_a − π at a_e 2, 3 and (beyond its range) 6 mm: deviation from the "
                  "counted one",
                  "°", engagement_error_deg, Judged::at_most, 0.001));
    const double by_case_3_deg = 90.0 + std::asin(1.0 - 6.0 / radius_mm) / degree;
    out.checks.push_back(own_check(
        fmt::format("3.1.2 (3) as printed gives {:.1f}° at a_e 6 mm, its sign slipped; counted", by_case_3_deg), "°",
        counted_engagement_deg(6.0)));
    out.checks.push_back(
        own_check("Section 4: a_e 12 mm, wider than the cutter: deviation of the engaged angle from a "
                  "slot's 180°",
                  "°", std::abs(counted_engagement_deg(12.0) - 180.0), Judged::at_most, 0.001));
}

void check_law_of_cosines(Reproduction& out) {
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
    out.checks.push_back(
        own_check("3.1.1: law of cosines, the lost signs put back, against the plant's two circles, of f_z", "%",
                  100.0 * largest, Judged::at_most, 1e-9));
}

namespace {

/// The largest error of a chip model over a slot, in feeds per tooth, against the true path.
double chip_error(ChipModel model, double feed_in_radii) {
    FineCut cut = fine_cut(figure_6[1]);
    cut.feed_per_tooth_mm = feed_in_radii * radius_mm;
    const double pitch = turn / teeth;
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

}  // namespace

void check_chip_models(Reproduction& out) {
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
    out.plots.push_back(plot);
    constexpr double papers_ratio = feed_per_tooth_mm / radius_mm;
    const auto show = [&](const char* name, double value) {
        out.checks.push_back(own_check(name, "%", 100.0 * value));
    };
    show("3.1.1: circle, largest error of the thickness at f_z/R 0.02, of f_z",
         chip_error(ChipModel::circular, papers_ratio));
    show("3.1.1: two circles (the paper), the same", chip_error(ChipModel::offset_circle, papers_ratio));
    show("3.1.1: circle, error of the mean force of case 3 at f_z/R 0.02",
         force_error(ChipModel::circular, papers_ratio));
    show("3.1.1: two circles (the paper), the same", force_error(ChipModel::offset_circle, papers_ratio));
    out.checks.push_back(
        own_check("The plant's true path against bisection on the path, f_z/R from 0.001 to 0.3, of f_z", "%",
                  100.0 * worst_trochoid, Judged::at_most, 0.1));
}

namespace {

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
        fine.push_back(fine_force(cut, (k + 0.5) * turn / (cut.teeth * angles), axial_steps));
        size_N = std::max(size_N, largest_component(fine.back()));
        size_Nm = std::max(size_Nm, fine.back().torque_Nm);
    }
    double largest = 0.0;
    for (int k = 0; k < angles; ++k) {
        const CuttingLoad load = plant.load((k + 0.5) * turn / (cut.teeth * angles), cut.feed_per_tooth_mm, map);
        largest = std::max(largest, difference_of(fine[static_cast<std::size_t>(k)], load.fx_N, load.fy_N, load.fz_N,
                                                  load.spindle_torque_Nm, size_N, size_Nm));
    }
    return largest;
}

void check_integration_of_cases(Reproduction& out) {
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
        out.checks.push_back(
            own_check(fmt::format("Plant against fine integration, five cases, {}: mean forces and torque", edges), "%",
                      100.0 * average, Judged::at_most, 0.1));
        out.checks.push_back(own_check(
            fmt::format("Plant against fine integration, five cases, {}: at 90 angles of a pitch, of the peak", edges),
            "%", 100.0 * momentary, Judged::at_most, 0.1));
    }
}

/// Cuts at random: the agreement is none of the five cases' luck.
void check_integration_at_random(Reproduction& out) {
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
        cut.entry_rad = up ? 0.0 : std::numbers::pi - sweep;
        cut.exit_rad = up ? sweep : std::numbers::pi;
        cut.flank = {between(300.0, 900.0), between(20.0, 40.0) * degree, between(10.0, 35.0) * degree,
                     between(-5.0, 15.0) * degree};
        cut.bottom_width_mm = 0.0;
        largest = std::max(largest, average_difference(cut, false));
    }
    out.checks.push_back(
        own_check(fmt::format("Plant against fine integration, {} cuts at random: mean forces and torque", cuts), "%",
                  100.0 * largest, Judged::at_most, 0.1));
}

}  // namespace

void check_integration(Reproduction& out) {
    check_integration_of_cases(out);
    check_integration_at_random(out);
}

}  // namespace millforce::sim::guan_reproduction
