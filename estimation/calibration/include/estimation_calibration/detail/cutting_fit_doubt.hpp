// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation_calibration/detail/cutting_fit_solver.hpp"

/// The covariance of six parameters, and the scatter of single cuts, as the four doubts that a CuttingLaw carries.

namespace millforce::estimation::detail {

/// Variance of ln K_s and ln r_1 that reproduces the variance of the tangential and radial force per length of edge,
///   P_t = K_s t + K_te,  P_r = r_1 K_s t + K_re,
/// at u = ln(t/t_ref).
template <typename Scalar>
struct CoefficientVariance {
    Scalar ln_K_s{0};
    Scalar ln_r_1{0};
};

template <typename Scalar>
CoefficientVariance<Scalar> coefficient_variance(const CuttingFit<Scalar>& fit, Scalar u, Scalar tangential_scatter,
                                                 Scalar extra_radial_variance) {
    using std::exp;
    const auto& p = fit.parameters;
    const Scalar cutting = exp(p(cutting_ln_K_s) + (p(cutting_p_s) + Scalar(1)) * u) * fit.reference_chip_thickness_mm;
    const Scalar growth = exp(p(cutting_p_1) * u);
    const Scalar radial = cutting * p(cutting_r_1) * growth;
    Eigen::Matrix<Scalar, cutting_parameter_count, 1> by_t, by_r;
    by_t << cutting, u * cutting, Scalar(0), Scalar(0), Scalar(1), Scalar(0);
    by_r << radial, u * radial, cutting * growth, u * radial, Scalar(0), Scalar(1);
    const Scalar variance_t = by_t.dot(fit.covariance * by_t) / (cutting * cutting);
    const Scalar variance_r = by_r.dot(fit.covariance * by_r) / (radial * radial);
    const Scalar whole = (cutting + p(cutting_K_te)) / cutting;
    CoefficientVariance<Scalar> result;
    result.ln_K_s = variance_t + whole * whole * tangential_scatter * tangential_scatter;
    result.ln_r_1 = (variance_r > variance_t ? variance_r - variance_t : Scalar(0)) + extra_radial_variance;
    return result;
}

/// The doubts grow from the chip thickness that is known best, fast enough to cover the covariance from a third of the
/// thinnest calibrated chip to three times the thickest.
template <typename Scalar>
void CuttingFitSolver<Scalar>::fill_doubts() {
    using std::abs;
    using std::exp;
    using std::log;
    using std::sqrt;
    CuttingLaw<Scalar>& law = result_.law;
    Scalar tangential = result_.tangential.cuts > 0 ? result_.tangential.rms : result_.normal.rms;
    tangential = result_.normal.cuts + result_.tangential.cuts > 0 ? tangential : result_.feed.rms;

    // Where forces in the plane scatter more than torques, the rest belongs to r_1.
    Scalar extra{0};
    Scalar sensitivity{0};
    for_each_row([&](const Row& r) {
        if (r.channel > 0) {
            const Scalar rms = r.channel == 1 ? result_.feed.rms : result_.normal.rms;
            const Scalar by_ln_r_1 = r.derivatives(cutting_r_1) * result_.parameters(cutting_r_1);
            const Scalar more = rms * rms - tangential * tangential;
            extra += more > Scalar(0) ? more * r.model * r.model : Scalar(0);
            sensitivity += by_ln_r_1 * by_ln_r_1;
        }
    });
    extra = sensitivity > Scalar(0) ? extra / sensitivity : Scalar(0);

    constexpr int points = 41;
    const Scalar low = log(thinnest_mm_ / Scalar(3)) - ln_t_ref_;
    const Scalar width = log(thickest_mm_ * Scalar(9) / thinnest_mm_);
    const auto at = [&](int k) { return low + width * static_cast<Scalar>(k) / static_cast<Scalar>(points - 1); };
    const auto variance = [&](Scalar u) { return coefficient_variance(result_, u, tangential, extra); };
    Scalar best = Scalar(0);
    for (int k = 0; k < points; ++k) {
        best = variance(at(k)).ln_K_s < variance(best).ln_K_s ? at(k) : best;
    }
    const CoefficientVariance<Scalar> least = variance(best);
    CoefficientVariance<Scalar> growth;
    for (int k = 0; k < points; ++k) {
        const Scalar distance = at(k) - best;
        if (abs(distance) < Scalar(0.25F)) {
            continue;
        }
        const CoefficientVariance<Scalar> here = variance(at(k));
        const Scalar square_of_distance = distance * distance;
        growth.ln_K_s = -smaller(-growth.ln_K_s, (least.ln_K_s - here.ln_K_s) / square_of_distance);
        growth.ln_r_1 = -smaller(-growth.ln_r_1, (least.ln_r_1 - here.ln_r_1) / square_of_distance);
    }
    law.reference_chip_thickness_mm = exp(ln_t_ref_ + best);
    law.K_s_relative_sd = sqrt(least.ln_K_s);
    law.K_s_exponent_sd = sqrt(growth.ln_K_s);
    law.r_1_relative_sd = sqrt(least.ln_r_1);
    law.r_1_exponent_sd = sqrt(growth.ln_r_1);
}

}  // namespace millforce::estimation::detail
