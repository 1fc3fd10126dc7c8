// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/force_drop_calibration.hpp"

#include "least_squares_in_double.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace millforce::estimation {

namespace {

using Cut = ForceDropCalibrationCut;
using Result = ForceDropCalibrationResult;
using Squares1 = LeastSquares<double, 1>;

enum EdgeIndex : int { index_K_tc, index_K_te, index_K_rc, index_K_re };

double size_of(const Measurement<double>& x, const Measurement<double>& y) {
    return std::hypot(x.value, y.value);
}

/// A row of the fit for K_tc, K_te, K_rc, K_re; `size_N` is that of the force of which `force` is one part.
void add_row(LeastSquares<double, 4>& fit, const Eigen::Vector4d& regressors, const Measurement<double>& force,
             double size_N) {
    constexpr double linear_law_share = 0.02;  // of the force: what a linear edge law leaves out
    fit.add(regressors, force.value, 1.0 / std::sqrt(force.variance + square(linear_law_share * size_N)));
}

/// Jump and average of a cut: four rows.
void add_cut(LeastSquares<double, 4>& fit, const Cut& cut) {
    const auto& m = cut.measured;
    const double f = m.feed_per_tooth_mm;
    const EngagementAngles<double> engagement = engagement_angles(m.side, cut.radial_immersion);
    const EngagementIntegrals<double> i = engagement_integrals(engagement);
    const double phi = jump_angle_rad(m.side, engagement);
    const double s = std::sin(phi);
    const double c = std::cos(phi);
    const double a_p = cut.axial_depth_mm;
    const double per_pitch = a_p * m.teeth / (2.0 * std::numbers::pi);
    const double jump_N = size_of(m.tooth_x_N, m.tooth_y_N);
    const double mean_N = size_of(m.mean_x_N, m.mean_y_N);
    add_row(fit, Eigen::Vector4d(f * s * c, c, f * s * s, s) * a_p, m.tooth_x_N, jump_N);
    add_row(fit, Eigen::Vector4d(-f * s * s, -s, f * s * c, c) * a_p, m.tooth_y_N, jump_N);
    add_row(fit, Eigen::Vector4d(f * i.s, i.d, f * i.b, i.c) * per_pitch, m.mean_x_N, mean_N);
    add_row(fit, Eigen::Vector4d(-f * i.b, -i.c, f * i.s, i.d) * per_pitch, m.mean_y_N, mean_N);
}

/// Of K_j/K_tc = ratio, with the covariance of both.
double ratio_sd(const LeastSquaresSolution<double, 4>& k, int j, double ratio) {
    const double variance = k.covariance(j, j) + square(ratio) * k.covariance(index_K_tc, index_K_tc) -
                            2.0 * ratio * k.covariance(index_K_tc, j);
    return std::sqrt(std::max(0.0, variance)) / k.parameters(index_K_tc);
}

void fit_edges(std::span<const Cut> cuts, Result& result) {
    constexpr std::size_t fewest_cuts = 3;
    constexpr double least_feed_ratio = 1.5;
    if (cuts.empty()) {
        return;
    }
    LeastSquares<double, 4> fit;
    for (const Cut& cut : cuts) {
        add_cut(fit, cut);
    }
    const auto [smallest, largest] =
        std::ranges::minmax(cuts, {}, [](const Cut& cut) { return cut.measured.feed_per_tooth_mm; });
    const bool feeds_differ =
        largest.measured.feed_per_tooth_mm >= least_feed_ratio * smallest.measured.feed_per_tooth_mm;
    result.coefficients = fit.solve();
    const auto& k = result.coefficients;
    const double K_tc = k.parameters(index_K_tc);
    result.edges_determined = cuts.size() >= fewest_cuts && feeds_differ && k.undetermined == 0U && K_tc > 0.0;
    if (result.edges_determined) {
        ForceDropLaw<double>& law = result.law;
        law.e_t_mm = k.parameters(index_K_te) / K_tc;
        law.e_r_mm = k.parameters(index_K_re) / K_tc;
        law.e_t_sd_mm = ratio_sd(k, index_K_te, law.e_t_mm);
        law.e_r_sd_mm = ratio_sd(k, index_K_re, law.e_r_mm);
    }
}

ForceDropRatios<double> ratios_of(const Cut& cut, const ForceDropLaw<double>& law) {
    const auto& m = cut.measured;
    const ForceDropInputs<double> in{m.tooth_x_N.value, m.tooth_y_N.value, m.mean_x_N.value,
                                     m.mean_y_N.value,  law.e_t_mm,        law.e_r_mm};
    return force_drop_ratios(in, m.feed_per_tooth_mm, m.teeth, m.side, engagement_angles(m.side, cut.radial_immersion));
}

/// r = a r_av + b.
void take_ratio_line(const LeastSquares<double, 2>& sloped, const Squares1& level, Result& result) {
    constexpr double least_significance = 2.0;  // of a − 1, in standard errors
    constexpr int fewest_rows = 4;              // two parameters, and a standard error from two more
    ForceDropLaw<double>& law = result.law;
    const auto line = sloped.solve();
    const double slope = line.parameters(0);
    result.a_determined = line.undetermined == 0U && sloped.rows() >= fewest_rows &&
                          std::abs(slope - 1.0) > least_significance * line.standard_error(0);
    if (result.a_determined) {
        law.a = slope;
        law.b = line.parameters(1);
        law.a_b_covariance = line.covariance;
        law.r_scatter = line.residual_sd;
        law.valid = true;
        return;
    }
    const auto height = level.solve();
    law.a = 1.0;
    law.b = height.parameters(0);
    law.a_b_covariance.setZero();
    law.a_b_covariance(1, 1) = height.covariance(0, 0);
    law.r_scatter = height.residual_sd;
    law.valid = height.undetermined == 0U;
}

/// ln(K/K_av) = c_0 + c_1 (1 − immersion) + c_2 ln(f_z/0.15 mm).
void take_pressure_plane(const LeastSquares<double, 3>& sloped, const Squares1& level, Result& result) {
    constexpr int fewest_rows = 5;  // three parameters, and a standard error from two more
    ForceDropLaw<double>& law = result.law;
    const auto plane = sloped.solve();
    result.c_determined = plane.undetermined == 0U && sloped.rows() >= fewest_rows;
    if (result.c_determined) {
        law.c = plane.parameters;
        law.c_covariance = plane.covariance;
        law.ln_K_scatter = plane.residual_sd;
        return;
    }
    const auto height = level.solve();
    law.c = {height.parameters(0), 0.0, 0.0};
    law.c_covariance.setZero();
    law.c_covariance(0, 0) = height.covariance(0, 0);
    law.ln_K_scatter = height.residual_sd;
}

/// The range of immersions that the law is used in: a little beyond that of the cuts, and within the range in which the
/// equations can be solved (force_drop_immersion.hpp).
void set_range(double smallest, double largest, ForceDropLaw<double>& law) {
    constexpr double beyond = 0.1;
    constexpr double smallest_solvable = 0.1;
    constexpr double largest_solvable = 0.95;
    law.smallest_immersion = std::clamp(smallest - beyond, smallest_solvable, 1.0);
    law.largest_immersion = std::clamp(largest + beyond, 0.0, largest_solvable);
}

void fit_lines(std::span<const Cut> cuts, Result& result) {
    constexpr int fewest_cuts = 3;
    LeastSquares<double, 2> ratio;
    Squares1 ratio_height;
    LeastSquares<double, 3> pressure;
    Squares1 pressure_height;
    Squares1 r_av;
    const Squares1::Vector one(1.0);  // the only regressor of a height
    double smallest = 1.0;
    double largest = 0.0;
    for (const Cut& cut : cuts) {
        const ForceDropRatios<double> at = ratios_of(cut, result.law);
        if (!at.possible) {
            continue;
        }
        const double ln_K = std::log(at.pressure_N_per_mm / at.mean_pressure_N_per_mm);
        ratio.add({at.r_av, 1.0}, at.r);
        ratio_height.add(one, at.r - at.r_av);
        r_av.add(one, at.r_av);
        pressure.add(pressure_regressors(1.0 - cut.radial_immersion, cut.measured.feed_per_tooth_mm), ln_K);
        pressure_height.add(one, ln_K);
        smallest = std::min(cut.radial_immersion, smallest);
        largest = std::max(cut.radial_immersion, largest);
    }
    const auto mean_r_av = r_av.solve();
    result.law.r_av_mean = mean_r_av.parameters(0);
    result.law.r_av_sd = mean_r_av.residual_sd;
    take_ratio_line(ratio, ratio_height, result);
    take_pressure_plane(pressure, pressure_height, result);
    set_range(smallest, largest, result.law);
    result.law.valid = result.law.valid && ratio_height.rows() >= fewest_cuts;
}

void average_other_edge(std::span<const Cut> cuts, ForceDropLaw<double>& law) {
    int measured = 0;
    for (const Cut& cut : cuts) {
        const auto& m = cut.measured;
        const ForceDropRatios<double> at = ratios_of(cut, law);
        if (!m.has_other_edge || !at.possible) {
            continue;
        }
        const double pressure = at.pressure_N_per_mm;
        const double chip_N = (m.side == CutSide::up ? 1.0 : -1.0) * pressure * m.feed_per_tooth_mm;
        ++measured;
        const double share = 1.0 / measured;
        law.other_step_x_mm += (m.other_step_x_N / pressure - law.other_step_x_mm) * share;
        law.other_step_y_mm += (m.other_step_y_N / pressure - law.other_step_y_mm) * share;
        law.other_slope_x += (m.other_slope_x_N_per_rad / chip_N - law.other_slope_x) * share;
        law.other_slope_y += (m.other_slope_y_N_per_rad / chip_N - law.other_slope_y) * share;
    }
}

Measurement<double> in_double(const Measurement<float>& m) {
    return {m.valid, static_cast<double>(m.value), static_cast<double>(m.variance), static_cast<double>(m.noise)};
}

}  // namespace

bool ForceDropCalibration::add(const Cut& cut) {
    const auto& m = cut.measured;
    const bool is_usable = m.tooth_x_N.valid && m.tooth_y_N.valid && m.mean_x_N.valid && m.mean_y_N.valid &&
                           m.feed_per_tooth_mm > 0.0 && cut.axial_depth_mm > 0.0 && cut.radial_immersion > 0.0 &&
                           cut.radial_immersion < 1.0 && (m.side == CutSide::up || m.side == CutSide::down);
    if (is_usable) {
        cuts_.push_back(cut);
    }
    return is_usable;
}

ForceDropCalibration::Result ForceDropCalibration::solve() const {
    Result result;
    result.cuts = static_cast<int>(cuts_.size());
    fit_edges(cuts_, result);
    if (result.edges_determined) {
        fit_lines(cuts_, result);
        average_other_edge(cuts_, result.law);
    }
    return result;
}

ForceDropCalibration::Result ForceDropCalibration::solve_without_edges() const {
    Result result;
    result.cuts = static_cast<int>(cuts_.size());
    fit_lines(cuts_, result);
    return result;
}

ForceDropMeasurement<double> in_double(const ForceDropMeasurement<float>& measured) {
    ForceDropMeasurement<double> result;
    result.tooth_x_N = in_double(measured.tooth_x_N);
    result.tooth_y_N = in_double(measured.tooth_y_N);
    result.mean_x_N = in_double(measured.mean_x_N);
    result.mean_y_N = in_double(measured.mean_y_N);
    result.feed_per_tooth_mm = static_cast<double>(measured.feed_per_tooth_mm);
    result.teeth = static_cast<double>(measured.teeth);
    result.side = measured.side;
    result.has_other_edge = measured.has_other_edge;
    result.other_step_x_N = static_cast<double>(measured.other_step_x_N);
    result.other_step_y_N = static_cast<double>(measured.other_step_y_N);
    result.other_slope_x_N_per_rad = static_cast<double>(measured.other_slope_x_N_per_rad);
    result.other_slope_y_N_per_rad = static_cast<double>(measured.other_slope_y_N_per_rad);
    return result;
}

ForceDropLaw<float> in_float(const ForceDropLaw<double>& law) {
    ForceDropLaw<float> result;
    result.valid = law.valid;
    result.e_t_mm = static_cast<float>(law.e_t_mm);
    result.e_r_mm = static_cast<float>(law.e_r_mm);
    result.e_t_sd_mm = static_cast<float>(law.e_t_sd_mm);
    result.e_r_sd_mm = static_cast<float>(law.e_r_sd_mm);
    result.a = static_cast<float>(law.a);
    result.b = static_cast<float>(law.b);
    result.a_b_covariance = law.a_b_covariance.cast<float>();
    result.r_scatter = static_cast<float>(law.r_scatter);
    result.r_av_mean = static_cast<float>(law.r_av_mean);
    result.r_av_sd = static_cast<float>(law.r_av_sd);
    result.c = law.c.cast<float>();
    result.c_covariance = law.c_covariance.cast<float>();
    result.ln_K_scatter = static_cast<float>(law.ln_K_scatter);
    result.other_step_x_mm = static_cast<float>(law.other_step_x_mm);
    result.other_step_y_mm = static_cast<float>(law.other_step_y_mm);
    result.other_slope_x = static_cast<float>(law.other_slope_x);
    result.other_slope_y = static_cast<float>(law.other_slope_y);
    result.smallest_immersion = static_cast<float>(law.smallest_immersion);
    result.largest_immersion = static_cast<float>(law.largest_immersion);
    return result;
}

}  // namespace millforce::estimation
