// SPDX-License-Identifier: Apache-2.0
#include "cutting_fit_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millforce::estimation {

namespace {

/// ρ of the first step, about that of a good dynamometer; measure_scatter replaces it.
constexpr double first_scale = 0.05;

/// Forces without errors, as in a test, would give an infinite weight.
constexpr double least_scale = 1e-5;

/// A prior of this weight (1/sd) holds a parameter at its mean: its sd, 1e-5, is far below any standard error that cuts
/// can give an exponent or an edge force.
constexpr double holding_weight = 1e5;

/// Largest condition number of the six-parameter fits. Priors make it large without harm; which parameters the cuts
/// determine is for find_undetermined to judge.
constexpr double largest_condition_of_six = 1e6;

/// Largest share of the rows that counts as used up by the parameters: with as many parameters as rows there would be
/// nothing left to estimate the scatter from.
constexpr double largest_spent_share = 0.9;

using CuttingSquares = LeastSquares<double, cutting_parameter_count>;

bool is_usable(const CutConditions<double>& cut) {
    const double t_mm = mean_chip_thickness_mm(cut.feed_per_tooth_mm, cut.engagement);
    return std::isfinite(t_mm) && t_mm > 0.0 && std::isfinite(cut.axial_depth_mm) && cut.axial_depth_mm > 0.0 &&
           std::isfinite(cut.teeth) && cut.teeth > 0.0;
}

/// E[min(z², k²)] of a standard normal z: what Huber's proposal 2 expects of a row. 0.7102 for k = 1.345.
double expected_clipped_square(double k) {
    const double outside = std::erfc(k / std::numbers::sqrt2);
    const double density = std::exp(-k * k / 2.0) * std::sqrt(2.0 / std::numbers::pi);
    return 1.0 - outside - k * density + k * k * outside;
}

}  // namespace

CuttingFitSolver::CuttingFitSolver(std::span<const CuttingMeasurement> cuts, const CuttingFitOptions& options)
    : options_(options) {
    int usable_cuts = 0;
    for (const CuttingMeasurement& measurement : cuts) {
        if (!is_usable(measurement.cut)) {
            continue;
        }
        const double f_z = measurement.cut.feed_per_tooth_mm;
        const double t_mm = mean_chip_thickness_mm(f_z, measurement.cut.engagement);
        const bool first = usable_cuts == 0;
        thinnest_mm_ = first ? t_mm : std::min(t_mm, thinnest_mm_);
        thickest_mm_ = first ? t_mm : std::max(t_mm, thickest_mm_);
        result_.minimum_feed_per_tooth_mm = first ? f_z : std::min(f_z, result_.minimum_feed_per_tooth_mm);
        result_.maximum_feed_per_tooth_mm = first ? f_z : std::max(f_z, result_.maximum_feed_per_tooth_mm);
        ln_t_ref_ += std::log(t_mm);
        ++usable_cuts;
        take(measurement);
    }
    for (Channel& channel : channels_) {
        channel.scale = first_scale;
        channel.floor_N *= channel.cuts > 0 ? options_.error_floor / channel.cuts : 0.0;
    }
    ln_t_ref_ /= std::max(usable_cuts, 1);
    result_.reference_chip_thickness_mm = std::exp(ln_t_ref_);
}

/// Adds the measured forces of a usable cut.
void CuttingFitSolver::take(const CuttingMeasurement& measurement) {
    const CutConditions<double>& cut = measurement.cut;
    const EngagementIntegrals<double> i = engagement_integrals(cut.engagement);
    const std::array<double, channel_count> forces_N{measurement.tangential_N, measurement.feed_N,
                                                     measurement.normal_N};
    const std::array<double, channel_count> per_K{i.c, i.s, -i.b};
    const std::array<double, channel_count> per_r{0.0, i.b, i.s};
    const std::array<double, channel_count> per_K_te{i.delta_rad, i.d, -i.c};
    const std::array<double, channel_count> per_K_re{0.0, i.c, i.d};
    for (std::size_t c = 0; c < channel_count; ++c) {
        if (std::isfinite(forces_N[c])) {
            forces_.push_back(
                {c, forces_N[c], cut.feed_per_tooth_mm, cut.axial_depth_mm * cut.teeth / (2.0 * std::numbers::pi),
                 std::log(cut.feed_per_tooth_mm * i.mean_sine), per_K[c], per_r[c], per_K_te[c], per_K_re[c]});
            channels_[c].floor_N += std::abs(forces_N[c]);
            ++channels_[c].cuts;
        }
    }
}

ModelForce CuttingFitSolver::model(const MeasuredForce& m) const {
    const CuttingParameters& p = result_.parameters;
    const double u = m.ln_thickness - ln_t_ref_;
    const double r_1_growth = std::exp(p(cutting_p_1) * u);
    const double r_1 = p(cutting_r_1) * r_1_growth;
    const double G = std::exp(p(cutting_ln_K_s) + p(cutting_p_s) * u) * m.feed_per_tooth_mm * m.depth_per_pitch_mm;
    const double cutting_N = G * (m.per_K + r_1 * m.per_r);
    ModelForce result;
    result.force_N = cutting_N + m.depth_per_pitch_mm * (p(cutting_K_te) * m.per_K_te + p(cutting_K_re) * m.per_K_re);
    result.derivatives << cutting_N, u * cutting_N, G * m.per_r * r_1_growth, u * G * m.per_r * r_1,
        m.depth_per_pitch_mm * m.per_K_te, m.depth_per_pitch_mm * m.per_K_re;
    return result;
}

/// Standard deviation of a measured force, in units of its channel's ρ.
double CuttingFitSolver::relative_sd(const MeasuredForce& measured, double model_N) const {
    const double floor_N = channels_[measured.channel].floor_N;
    return std::sqrt(model_N * model_N + floor_N * floor_N);
}

/// Initial values: with the exponents at their prior means, and no edge forces, the law is linear in K_s and K_s r_1.
/// Returns whether the forces grow with the chip at all.
bool CuttingFitSolver::start() {
    const bool linear_edge = options_.form == CuttingLawForm::linear_edge;
    prior_mean_(cutting_p_s) = linear_edge ? 0.0 : options_.p_s_mean;
    prior_mean_(cutting_p_1) = linear_edge ? 0.0 : options_.p_1_mean;
    result_.parameters = prior_mean_;
    result_.parameters(cutting_r_1) = 1.0;
    LeastSquares<double, 2> linear;
    for (const MeasuredForce& m : forces_) {
        const CuttingParameters derivatives = model(m).derivatives;  // at K_s = r_1 = 1
        const double per_K_s_r_1 = derivatives(cutting_r_1);
        const double per_K_s = derivatives(cutting_ln_K_s) - per_K_s_r_1;
        linear.add({per_K_s, per_K_s_r_1}, m.force_N, 1.0 / channels_[m.channel].floor_N);
    }
    const auto solution = linear.solve();
    const double K_s = solution.parameters(0);
    if (!(K_s > 0.0)) {
        return false;
    }
    result_.parameters(cutting_ln_K_s) = std::log(K_s);
    result_.parameters(cutting_r_1) = solution.determined(1) ? solution.parameters(1) / K_s : 0.0;
    set_prior_weights(K_s);
    return true;
}

/// Must come after the initial values: a parameter that is held starts at its mean.
void CuttingFitSolver::set_prior_weights(double K_s) {
    if (options_.form == CuttingLawForm::linear_edge) {
        prior_weight_(cutting_p_s) = prior_weight_(cutting_p_1) = holding_weight;
    } else if (options_.form == CuttingLawForm::power) {
        prior_weight_(cutting_K_te) = prior_weight_(cutting_K_re) = holding_weight;
    } else {
        prior_weight_(cutting_K_te) = prior_weight_(cutting_K_re) = 1.0 / (options_.edge_thickness_sd_mm * K_s);
        prior_weight_(cutting_p_s) = 1.0 / options_.p_s_sd;
        prior_weight_(cutting_p_1) = 1.0 / options_.p_1_sd;
    }
    for (const int j : {cutting_p_s, cutting_p_1, cutting_K_te, cutting_K_re}) {
        if (((options_.held_at_zero >> static_cast<unsigned>(j)) & 1U) != 0U) {
            prior_mean_(j) = result_.parameters(j) = 0.0;
            prior_weight_(j) = holding_weight;
        }
    }
}

/// `steps_from_here`: the fit is one of a step from the present parameters, not of the parameters themselves.
void CuttingFitSolver::add_priors(CuttingSquares& fit, bool steps_from_here) const {
    for (int j = 0; j < cutting_parameter_count; ++j) {
        if (prior_weight_(j) > 0.0) {
            fit.add_prior(j, steps_from_here ? prior_mean_(j) - result_.parameters(j) : 0.0, prior_weight_(j));
        }
    }
}

/// Share of a parameter that the cuts, and not its prior, decide.
double CuttingFitSolver::decided_by_cuts(int parameter) const {
    const double weight = prior_weight_(parameter);
    return std::max(0.0, 1.0 - result_.covariance(parameter, parameter) * weight * weight);
}

/// How many parameters the cuts, and not the priors, decide.
double CuttingFitSolver::free_parameters() const {
    double sum = 0.0;
    for (int j = 0; j < cutting_parameter_count; ++j) {
        sum += decided_by_cuts(j);
    }
    return sum;
}

/// ρ of each channel by Huber's proposal 2: Σ min(z², k²) = E[min(z², k²)] (n − p).
void CuttingFitSolver::measure_scatter() {
    constexpr double odd_beyond_limit = 3.0;
    const double k = options_.huber_limit;
    const double expected = expected_clipped_square(k);
    for (Channel& channel : channels_) {
        channel.clipped_squares = channel.relative_squares = 0.0;
        channel.unclipped = channel.odd = 0;
    }
    for (const MeasuredForce& m : forces_) {
        Channel& channel = channels_[m.channel];
        const double model_N = model(m).force_N;
        const double error = std::abs(m.force_N - model_N) / relative_sd(m, model_N);
        const double z = error / channel.scale;
        channel.relative_squares += error * error;
        channel.clipped_squares += z < k ? z * z : k * k;
        channel.unclipped += z < k ? 1 : 0;
        channel.odd += z > k + odd_beyond_limit ? 1 : 0;
    }
    const double spent = std::min(free_parameters() / static_cast<double>(forces_.size()), largest_spent_share);
    for (Channel& channel : channels_) {
        if (channel.cuts > 0) {
            channel.scale *= std::sqrt(channel.clipped_squares / (expected * channel.cuts * (1.0 - spent)));
            channel.scale = std::max(channel.scale, least_scale);
        }
    }
}

/// One Gauss–Newton step with Huber weights. Returns its length in standard errors.
double CuttingFitSolver::step() {
    constexpr double longest_step = 0.5;  // of an exponent or a logarithm: within it the model is nearly linear
    CuttingSquares fit;
    for (const MeasuredForce& m : forces_) {
        const ModelForce here = model(m);
        const double sd = relative_sd(m, here.force_N) * channels_[m.channel].scale;
        const double z = std::abs(m.force_N - here.force_N) / sd;
        const double huber = z > options_.huber_limit ? std::sqrt(options_.huber_limit / z) : 1.0;
        fit.add(here.derivatives, m.force_N - here.force_N, huber / sd);
    }
    add_priors(fit, true);
    const auto solution = fit.solve(largest_condition_of_six);
    double shrink = 1.0;
    for (const int exponent : {cutting_ln_K_s, cutting_p_s, cutting_p_1}) {
        const double move = std::abs(solution.parameters(exponent));
        shrink = move * shrink > longest_step ? longest_step / move : shrink;
    }
    result_.parameters += shrink * solution.parameters;
    // The rows are weighted by their standard deviations: their variance is 1, whatever the residuals are.
    const double residual_variance = solution.residual_sd * solution.residual_sd;
    double square_of_length = 0.0;
    for (int j = 0; j < cutting_parameter_count; ++j) {
        const double variance = solution.covariance(j, j) / residual_variance;
        if (variance > 0.0) {
            square_of_length = std::max(solution.parameters(j) * solution.parameters(j) / variance, square_of_length);
            result_.covariance(j, j) = variance;
        }
    }
    return std::sqrt(square_of_length);
}

/// Covariance of the estimates: (e JᵀJ + priors)⁻¹, e = (share of rows within the limit)²/E[ψ²] of Huber's estimator.
void CuttingFitSolver::conclude() {
    double clipped_squares = 0.0;
    int unclipped = 0;
    for (const Channel& channel : channels_) {
        clipped_squares += channel.clipped_squares;
        unclipped += channel.unclipped;
    }
    const auto n = static_cast<double>(forces_.size());
    const double spent = std::min(free_parameters() / n, largest_spent_share);
    const double within = unclipped / n;
    const double efficiency = std::min(1.0, within * within * (1.0 - spent) * n / clipped_squares);
    CuttingSquares fit;
    for (const MeasuredForce& m : forces_) {
        const ModelForce here = model(m);
        const double sd = relative_sd(m, here.force_N) * channels_[m.channel].scale;
        fit.add(here.derivatives, m.force_N - here.force_N, std::sqrt(efficiency) / sd);
    }
    add_priors(fit, false);
    const auto solution = fit.solve(largest_condition_of_six);
    result_.covariance = solution.covariance / (solution.residual_sd * solution.residual_sd);
    result_.undetermined |= solution.undetermined;
}

CuttingFit CuttingFitSolver::run() {
    constexpr int fewest_steps = 6;  // each step also corrects the scale of the errors, which lags
    constexpr int most_steps = 60;
    constexpr double converged_length = 0.01;  // in standard errors
    if (forces_.empty() || !start()) {
        result_.undetermined = (1U << static_cast<unsigned>(cutting_parameter_count)) - 1U;
        return result_;
    }
    for (int k = 0; k < most_steps && !(k >= fewest_steps && result_.converged); ++k) {
        result_.converged = step() < converged_length;
        measure_scatter();
    }
    conclude();
    find_undetermined();
    fill_law();
    fill_standard_deviations();
    return result_;
}

}  // namespace millforce::estimation
