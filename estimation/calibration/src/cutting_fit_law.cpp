// SPDX-License-Identifier: Apache-2.0
// What a CuttingFit reports: the law, its standard deviations, and the parameters that the cuts leave open.
#include "cutting_fit_solver.hpp"

#include "estimation/number/student_t.hpp"

#include <algorithm>
#include <cmath>

namespace millforce::estimation {

namespace {

/// Variances of ln K_s and ln r_1, as a CuttingLaw holds them.
struct CoefficientVariance {
    double ln_K_s = 0.0;
    double ln_r_1 = 0.0;
};

/// The variances that reproduce those of the tangential and radial force per length of edge,
///   P_t = K_s t + K_te,  P_r = r_1 K_s t + K_re,
/// at u = ln(t/t_ref). `tangential_scatter`: relative, of the force of a single cut.
CoefficientVariance coefficient_variance(const CuttingFit& fit, double u, double tangential_scatter,
                                         double extra_radial_variance) {
    const CuttingParameters& p = fit.parameters;
    const double cutting = std::exp(p(cutting_ln_K_s) + (p(cutting_p_s) + 1.0) * u) * fit.reference_chip_thickness_mm;
    const double growth = std::exp(p(cutting_p_1) * u);
    const double radial = cutting * p(cutting_r_1) * growth;
    CuttingParameters tangential_derivatives;
    CuttingParameters radial_derivatives;
    tangential_derivatives << cutting, u * cutting, 0.0, 0.0, 1.0, 0.0;
    radial_derivatives << radial, u * radial, cutting * growth, u * radial, 0.0, 1.0;
    const double variance_t = tangential_derivatives.dot(fit.covariance * tangential_derivatives) / (cutting * cutting);
    const double variance_r = radial_derivatives.dot(fit.covariance * radial_derivatives) / (radial * radial);
    const double whole = (cutting + p(cutting_K_te)) / cutting;
    return {variance_t + whole * whole * tangential_scatter * tangential_scatter,
            std::max(0.0, variance_r - variance_t) + extra_radial_variance};
}

}  // namespace

void CuttingFitSolver::find_undetermined() {
    constexpr double largest_standard_error = 0.5;  // of ln K_s and of r_1: a law known worse is of no use
    const auto flag = [this](int j) { result_.undetermined |= 1U << static_cast<unsigned>(j); };
    for (const int j : {cutting_ln_K_s, cutting_r_1}) {
        if (!(result_.standard_error(j) < largest_standard_error)) {
            flag(j);
        }
    }
    if (!result_.determined(cutting_r_1)) {
        flag(cutting_p_1);
        flag(cutting_K_re);
    }
    const bool by_thickness = options_.form == CuttingLawForm::power;
    const double smallest = by_thickness ? thinnest_mm_ : result_.minimum_feed_per_tooth_mm;
    const double largest = by_thickness ? thickest_mm_ : result_.maximum_feed_per_tooth_mm;
    if (!(largest > options_.minimum_feed_ratio * smallest)) {
        for (const int j : {cutting_p_s, cutting_p_1, cutting_K_te, cutting_K_re}) {
            flag(j);
        }
    }
}

void CuttingFitSolver::fill_law() {
    const CuttingParameters& p = result_.parameters;
    CuttingLaw<double>& law = result_.law;
    law.p_s = p(cutting_p_s);
    law.p_1 = p(cutting_p_1);
    law.k_s_N_per_mm2 = std::exp(p(cutting_ln_K_s) - law.p_s * ln_t_ref_);
    law.k_1 = p(cutting_r_1) * std::exp(-law.p_1 * ln_t_ref_);
    law.K_te_N_per_mm = p(cutting_K_te);
    law.K_re_N_per_mm = p(cutting_K_re);
    law.minimum_chip_thickness_mm = thinnest_mm_;
    law.maximum_chip_thickness_mm = thickest_mm_;
    const auto scatter_of = [](const Channel& channel) {
        const double mean_square = channel.cuts > 0 ? channel.relative_squares / channel.cuts : 0.0;
        return CuttingScatter{channel.scale, std::sqrt(mean_square), channel.floor_N, channel.cuts, channel.odd};
    };
    for (int j = 0; j < cutting_parameter_count; ++j) {
        result_.decided_by_cuts(j) = decided_by_cuts(j);
    }
    result_.degrees_of_freedom = static_cast<double>(forces_.size()) - free_parameters();
    result_.tangential = scatter_of(channels_[0]);
    result_.feed = scatter_of(channels_[1]);
    result_.normal = scatter_of(channels_[2]);
}

/// Where forces in the plane scatter more than torques, the rest is taken as scatter of ln r_1: its variance.
double CuttingFitSolver::extra_radial_variance(double tangential_rms) const {
    double extra = 0.0;
    double sensitivity = 0.0;
    for (const MeasuredForce& m : forces_) {
        if (m.channel == 0) {
            continue;
        }
        const double rms = m.channel == 1 ? result_.feed.rms : result_.normal.rms;
        const ModelForce here = model(m);
        const double per_ln_r_1 = here.derivatives(cutting_r_1) * result_.parameters(cutting_r_1);
        extra += std::max(0.0, rms * rms - tangential_rms * tangential_rms) * here.force_N * here.force_N;
        sensitivity += per_ln_r_1 * per_ln_r_1;
    }
    return sensitivity > 0.0 ? extra / sensitivity : 0.0;
}

/// The variance of a parameter if all others were known: no fit can know it better. Relative for r_1.
double CuttingFitSolver::least_variance(int parameter) const {
    double information = 0.0;
    for (const MeasuredForce& m : forces_) {
        const ModelForce here = model(m);
        const double factor = parameter == cutting_r_1 ? result_.parameters(cutting_r_1) : 1.0;
        const double sd = relative_sd(m, here.force_N) * channels_[m.channel].scale;
        information += square(here.derivatives(parameter) * factor / sd);
    }
    return information > 0.0 ? 1.0 / information : 0.0;
}

/// A CuttingLaw holds a variance that is least at one chip thickness and grows with the square of the logarithmic
/// distance from there. It is made to cover the variance of the fit from a third of the thinnest calibrated chip to
/// three times the thickest. The fit may be most certain of chips thicker than any that was cut: the least is sought
/// among those that were.
void CuttingFitSolver::fill_standard_deviations() {
    constexpr double reach = 3.0;
    constexpr int points = 41;
    // Closer to the reference the square of the distance is next to nothing: there the largest variance counts.
    constexpr double least_distance = 0.25;

    const double torque_or_normal_rms = result_.tangential.cuts > 0 ? result_.tangential.rms : result_.normal.rms;
    const bool has_either = result_.tangential.cuts + result_.normal.cuts > 0;
    const double tangential_rms = has_either ? torque_or_normal_rms : result_.feed.rms;
    const double extra = extra_radial_variance(tangential_rms);
    const auto variance = [&](double u) { return coefficient_variance(result_, u, tangential_rms, extra); };

    const double thinnest = std::log(thinnest_mm_) - ln_t_ref_;
    const double thickest = std::log(thickest_mm_) - ln_t_ref_;
    double best = thinnest;
    for (int k = 0; k < points; ++k) {
        const double u = thinnest + (thickest - thinnest) * k / (points - 1);
        best = variance(u).ln_K_s < variance(best).ln_K_s ? u : best;
    }
    const double low = thinnest - std::log(reach);
    const double width = thickest + std::log(reach) - low;
    const auto at = [&](int k) { return low + width * k / (points - 1); };
    CoefficientVariance least = variance(best);
    for (int k = 0; k < points; ++k) {
        if (std::abs(at(k) - best) < least_distance) {
            least.ln_K_s = std::max(least.ln_K_s, variance(at(k)).ln_K_s);
            least.ln_r_1 = std::max(least.ln_r_1, variance(at(k)).ln_r_1);
        }
    }
    CoefficientVariance growth{least_variance(cutting_p_s), least_variance(cutting_p_1)};
    for (int k = 0; k < points; ++k) {
        const double distance = at(k) - best;
        if (std::abs(distance) >= least_distance) {
            const CoefficientVariance here = variance(at(k));
            growth.ln_K_s = std::max(growth.ln_K_s, (here.ln_K_s - least.ln_K_s) / (distance * distance));
            growth.ln_r_1 = std::max(growth.ln_r_1, (here.ln_r_1 - least.ln_r_1) / (distance * distance));
        }
    }
    // With few degrees of freedom the scatter itself is hardly known.
    const double widening = student_t_975(std::max(1.0, std::floor(result_.degrees_of_freedom))) / normal_975<double>;
    CuttingLaw<double>& law = result_.law;
    law.reference_chip_thickness_mm = std::clamp(std::exp(ln_t_ref_ + best), thinnest_mm_, thickest_mm_);
    law.K_s_relative_sd = widening * std::sqrt(std::max(least.ln_K_s, least_variance(cutting_ln_K_s)));
    law.K_s_exponent_sd = widening * std::sqrt(growth.ln_K_s);
    law.r_1_relative_sd = widening * std::sqrt(std::max(least.ln_r_1, least_variance(cutting_r_1)));
    law.r_1_exponent_sd = widening * std::sqrt(growth.ln_r_1);
}

}  // namespace millforce::estimation
