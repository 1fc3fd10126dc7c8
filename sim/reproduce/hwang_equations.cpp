// SPDX-License-Identifier: Apache-2.0
#include "reproduce/hwang_equations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cutting/angle_units.hpp"

namespace millforce::sim {

namespace {

using Judged = Figure::Judged;

constexpr double published_a = 0.50465;  // section 3.2.1
constexpr std::array<double, 5> drawn_ratios{0.0, 0.25, 0.5, 0.75, 1.0};

/// Eq. 5: F_Y/F_X of one insert at the angle φ.
double force_ratio(double phi_rad, double r) {
    return (r - std::tan(phi_rad)) / (1.0 + r * std::tan(phi_rad));
}

/// Eq. 6 as printed: φ_s within −90 and 90°.
double printed_swept_angle_rad(double r, double F_Y_over_F_X) {
    return std::atan((r - F_Y_over_F_X) / (1.0 + r * F_Y_over_F_X));
}

/// Eq. 6 as a difference of two arctangents, which goes on past 90°.
double swept_angle_rad(double r, double F_Y_over_F_X) {
    return std::atan(r) - std::atan(F_Y_over_F_X);
}

/// The two angle terms of Eqs. 10 and 11.
struct MeanTerms {
    explicit MeanTerms(double phi_rad)
        : radial(2.0 * phi_rad - std::sin(2.0 * phi_rad)), tangential(1.0 - std::cos(2.0 * phi_rad)) {}
    double radial;
    double tangential;
};

/// Eq. 10: F_aY/F_aX.
double mean_force_ratio(double phi_rad, double r_av) {
    const MeanTerms terms(phi_rad);
    return (r_av * terms.tangential - terms.radial) / (terms.tangential + r_av * terms.radial);
}

/// Eq. 11.
double mean_ratio(double phi_rad, double F_aY_over_F_aX) {
    const MeanTerms terms(phi_rad);
    return (terms.radial + F_aY_over_F_aX * terms.tangential) / (terms.tangential - F_aY_over_F_aX * terms.radial);
}

/// Eq. 13: dφ_s/dr of Eq. 6 at constant F_Y/F_X.
double slope_by_equation_13(double r) {
    return 1.0 / (1.0 + r * r);
}

/// Eq. 14, derived: dφ_s/dr of Eqs. 11 and 12 at constant F_aY/F_aX. Eq. 11 is r_av = tan(α(φ_s) + const) with tan α
/// the quotient of the two terms, so dr_av/dφ_s = (1 + r_av²) dα/dφ_s.
double slope_by_equation_14(double phi_rad, double r_av, double a) {
    const MeanTerms terms(phi_rad);
    const double radial_slope = 2.0 * terms.tangential;
    const double tangential_slope = 2.0 * std::sin(2.0 * phi_rad);
    const double alpha_slope = (radial_slope * terms.tangential - terms.radial * tangential_slope) /
                               (terms.radial * terms.radial + terms.tangential * terms.tangential);
    return 1.0 / (a * (1.0 + r_av * r_av) * alpha_slope);
}

template <typename Function>
double difference_quotient(const Function& function, double at) {
    constexpr double step = 1e-5;
    return (function(at + step) - function(at - step)) / (2.0 * step);
}

struct SlopeCheck {
    double smallest_difference = 1e9;  ///< of Eq. 14 and Eq. 13 at a = 1
    double error_of_13 = 0.0;          ///< against difference quotients
    double error_of_14 = 0.0;
};

SlopeCheck check_slopes() {
    SlopeCheck check;
    for (int degrees = 5; degrees <= 175; degrees += 5) {
        const double phi = degrees * degree;
        for (int tenth = 0; tenth <= 10; ++tenth) {
            const double r = 0.1 * tenth;
            const double slope_13 = slope_by_equation_13(r);
            const double slope_14 = slope_by_equation_14(phi, r, 1.0);
            check.smallest_difference = std::min(check.smallest_difference, slope_14 - slope_13);
            const double ratio = force_ratio(phi, r);
            const double mean = mean_force_ratio(phi, r);
            const double quotient_13 = difference_quotient([&](double x) { return swept_angle_rad(x, ratio); }, r);
            const double quotient_14 = 1.0 / difference_quotient([&](double x) { return mean_ratio(x, mean); }, phi);
            check.error_of_13 = std::max(check.error_of_13, std::abs(slope_13 / quotient_13 - 1.0));
            check.error_of_14 = std::max(check.error_of_14, std::abs(slope_14 / quotient_14 - 1.0));
        }
    }
    return check;
}

struct IterationCheck {
    int runs = 0;
    int most_steps = 0;    ///< until r moves by less than 1e-6
    int runs_outside = 0;  ///< in which some r is not between the one before and the true one
    double largest_immersion_error = 0.0;
};

/// Section 2.1: r → φ_s (Eq. 6) → r_av (Eq. 11) → r (Eq. 12), on forces that obey the paper's law exactly.
template <typename Equation6>
void iterate(const Equation6& swept_angle, double phi_rad, double true_r, double start_r, IterationCheck& check) {
    constexpr int most_steps = 200;
    constexpr double settled = 1e-6;
    const double true_r_av = 1.1 * true_r;  // any: b makes up for it
    const double b = true_r - published_a * true_r_av;
    const double ratio = force_ratio(phi_rad, true_r);
    const double mean = mean_force_ratio(phi_rad, true_r_av);
    double r = start_r;
    double found_rad = 0.0;
    int steps = 0;
    bool is_outside = false;
    for (double change = 1.0; std::abs(change) >= settled && steps < most_steps; ++steps) {
        found_rad = swept_angle(r, ratio);
        const double next = published_a * mean_ratio(found_rad, mean) + b;
        is_outside = is_outside || next < std::min(r, true_r) - settled || next > std::max(r, true_r) + settled;
        change = next - r;
        r = next;
    }
    ++check.runs;
    check.most_steps = std::max(check.most_steps, steps);
    check.runs_outside += is_outside ? 1 : 0;
    check.largest_immersion_error =
        std::max(check.largest_immersion_error, std::abs(std::cos(found_rad) - std::cos(phi_rad)));
}

template <typename Equation6>
IterationCheck check_iteration(const Equation6& swept_angle) {
    IterationCheck check;
    for (int percent = 20; percent <= 80; percent += 5) {
        const double phi_rad = std::acos(1.0 - 0.01 * percent);
        for (const double true_r : {0.2, 0.4, 0.6, 0.8}) {
            for (const double start_r : {0.0, 1.0}) {
                iterate(swept_angle, phi_rad, true_r, start_r, check);
            }
        }
    }
    return check;
}

std::string ratio_name(const char* symbol, double value) {
    return fmt::format("{} = {:g}", symbol, value);
}

constexpr int smallest_drawn_deg = 5;
constexpr int largest_drawn_deg = 115;  // immersion 1.4

Plot figure_1(const std::vector<estimation::ForceDropCalibrationCut>& cuts) {
    Plot plot{.title = "Angle of immersion over the force ratio of one insert (Fig. 1, Eq. 6)",
              .x_label = "F_Y/F_X",
              .y_label = "φ_s, degrees",
              .caption =
                  "Lines: Eq. 6. Points: the force drops of 21 cuts of known immersion on the simulated bench; the "
                  "r of each is where it lies between the lines.",
              .series = {}};
    constexpr double lowest_ratio = -2.0;
    for (const double r : drawn_ratios) {
        Plot::Series line{ratio_name("r", r), Plot::Series::Style::line, {}, {}};
        for (int k = 0; k <= 100; ++k) {
            const double ratio = lowest_ratio + 0.01 * k * (r - lowest_ratio);
            line.x.push_back(ratio);
            line.y.push_back(swept_angle_rad(r, ratio) / degree);
        }
        plot.series.push_back(line);
    }
    Plot::Series points{"known cuts", Plot::Series::Style::points, {}, {}};
    for (const estimation::ForceDropCalibrationCut& cut : cuts) {
        points.x.push_back(cut.measured.tooth_y_N.value / cut.measured.tooth_x_N.value);
        points.y.push_back(std::acos(1.0 - cut.radial_immersion) / degree);
    }
    plot.series.push_back(points);
    return plot;
}

Plot figure_2(const std::vector<estimation::ForceDropCalibrationCut>& cuts) {
    Plot plot{.title = "Angle of immersion over the ratio of the average forces (Fig. 2, Eq. 10)",
              .x_label = "F_aY/F_aX",
              .y_label = "φ_s, degrees",
              .caption = "Lines: Eq. 10. Points: the average forces of the same 21 cuts.",
              .series = {}};
    for (const double r_av : drawn_ratios) {
        Plot::Series line{ratio_name("r_av", r_av), Plot::Series::Style::line, {}, {}};
        for (int degrees = smallest_drawn_deg; degrees <= largest_drawn_deg; ++degrees) {
            line.x.push_back(mean_force_ratio(degrees * degree, r_av));
            line.y.push_back(degrees);
        }
        plot.series.push_back(line);
    }
    Plot::Series points{"known cuts", Plot::Series::Style::points, {}, {}};
    for (const estimation::ForceDropCalibrationCut& cut : cuts) {
        points.x.push_back(cut.measured.mean_y_N.value / cut.measured.mean_x_N.value);
        points.y.push_back(std::acos(1.0 - cut.radial_immersion) / degree);
    }
    plot.series.push_back(points);
    return plot;
}

Plot figure_3() {
    Plot plot{.title = "Slope of Eq. 14 less that of Eq. 13 (Fig. 3)",
              .x_label = "φ_s, degrees",
              .y_label = "difference of dφ_s/dr",
              .caption =
                  "At a = 1, r = r_av. It is positive everywhere: with a ≤ 1 each step of the paper's iteration ends "
                  "between the step before and the solution.",
              .series = {}};
    for (const double r : drawn_ratios) {
        Plot::Series line{ratio_name("r", r), Plot::Series::Style::line, {}, {}};
        for (int degrees = smallest_drawn_deg; degrees <= largest_drawn_deg; ++degrees) {
            line.x.push_back(degrees);
            line.y.push_back(slope_by_equation_14(degrees * degree, r, 1.0) - slope_by_equation_13(r));
        }
        plot.series.push_back(line);
    }
    return plot;
}

}  // namespace

void add_convergence(Reproduction& out) {
    const SlopeCheck slopes = check_slopes();
    out.figures.push_back(
        {"Section 2.2, Fig. 3: smallest difference of the slopes of Eqs. 14 and 13 at a = 1 (in "
         "print: above 0 everywhere)",
         "", 0.0, slopes.smallest_difference, Judged::at_least, 0.0});
    out.checks.push_back(own_check("Eq. 13 against difference quotients of Eq. 6: largest relative deviation", "",
                                   slopes.error_of_13, Judged::at_most, 1e-6));
    out.checks.push_back(
        own_check("Eq. 14, derived here from Eqs. 11 and 12, against difference quotients: largest relative deviation",
                  "", slopes.error_of_14, Judged::at_most, 1e-6));
    const IterationCheck iteration = check_iteration(swept_angle_rad);
    out.checks.push_back(
        own_check("Section 2.1: the paper's iteration with its a of 0.50465, from r = 0 and 1, on forces "
                  "of its own law: largest error of the immersion",
                  "", iteration.largest_immersion_error, Judged::at_most, 1e-5));
    out.checks.push_back(own_check("The same: most steps until r moves by less than 1e-6", "", iteration.most_steps));
    out.checks.push_back(
        own_check(fmt::format("The same: runs of {} in which an r is not between the one before and the "
                              "true one",
                              iteration.runs),
                  "", iteration.runs_outside, Judged::at_most, 0.0));
    out.checks.push_back(own_check("The same with Eq. 6's tan⁻¹ as printed, which jumps at 90°", "",
                                   check_iteration(printed_swept_angle_rad).runs_outside));
}

void add_equation_plots(const std::vector<estimation::ForceDropCalibrationCut>& known_cuts, Reproduction& out) {
    out.plots.push_back(figure_1(known_cuts));
    out.plots.push_back(figure_2(known_cuts));
    out.plots.push_back(figure_3());
}

}  // namespace millforce::sim
