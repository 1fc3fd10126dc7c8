// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation_calibration/cutting_fit.hpp"

#include <cmath>
#include <span>

/// k_s, p_s, k_1, p_1 of an unknown tool and workpiece from cuts whose forces come from motor currents alone (Kim &
/// Chung, section 3.3). The cuts are those of fit_cutting_law, with F_at from the spindle and F_ax from the feed drive.
///
/// A dynamometer's errors are of each cut; a drive's gain is wrong for all of them alike, and no number of cuts shows
/// it. So the fit is repeated with all F_at larger by the relative standard deviation of K_t1, and with all F_ax larger
/// by that of K_x4; how far the coefficients move is added to their covariance:
///   cov = cov_fit + Δ_t Δ_tᵀ + Δ_x Δ_xᵀ
/// K_s moves with K_t1 alone, r_1 with the ratio of both gains, and in down milling several times as far, because F_ax
/// is the difference of two larger terms: s + r_1 b, s < 0.
/// Where both gains come from standard cuts with one database, its error moves both alike (`shared_relative_sd`) and
/// leaves r_1 alone.
///
/// Cost: four times fit_cutting_law; `scratch` holds a copy of the cuts. No heap.

namespace millforce::estimation {

template <typename Scalar>
struct DriveGainDoubt {
    Scalar tangential_relative_sd{0};  ///< of K_t1, without what it shares with K_x4
    Scalar feed_relative_sd{0};        ///< of K_x4, likewise
    Scalar shared_relative_sd{0};      ///< of both at once
};

namespace detail {

template <typename Scalar>
void add_gain_doubt(CuttingFit<Scalar>& fit, std::span<const CuttingMeasurement<Scalar>> cuts,
                    std::span<CuttingMeasurement<Scalar>> scratch, const CuttingFitOptions<Scalar>& options,
                    Scalar tangential_share, Scalar feed_share) {
    if (!(tangential_share > Scalar(0)) && !(feed_share > Scalar(0))) {
        return;
    }
    for (std::size_t k = 0; k < cuts.size(); ++k) {
        scratch[k] = cuts[k];
        scratch[k].tangential_N *= Scalar(1) + tangential_share;
        scratch[k].feed_N *= Scalar(1) + feed_share;
        scratch[k].normal_N *= Scalar(1) + feed_share;
    }
    const std::span<const CuttingMeasurement<Scalar>> moved_cuts(scratch.data(), cuts.size());
    const auto moved = fit_cutting_law<Scalar>(moved_cuts, options);
    const auto step = (moved.parameters - fit.parameters).eval();
    fit.covariance += step * step.transpose();
}

}  // namespace detail

/// As fit_cutting_law, and with the doubt of the drives' gains in the covariance and in the law. `scratch` is at least
/// as long as `cuts`.
template <typename Scalar>
CuttingFit<Scalar> fit_cutting_law_from_currents(std::span<const CuttingMeasurement<Scalar>> cuts,
                                                 std::span<CuttingMeasurement<Scalar>> scratch,
                                                 const DriveGainDoubt<Scalar>& doubt,
                                                 const CuttingFitOptions<Scalar>& options) {
    using std::sqrt;
    CuttingFit<Scalar> fit = fit_cutting_law<Scalar>(cuts, options);
    if (fit.undetermined != 0U || scratch.size() < cuts.size()) {
        return fit;
    }
    const Scalar ln_K_s_variance = fit.covariance(cutting_ln_K_s, cutting_ln_K_s);
    const Scalar r_1_variance = fit.covariance(cutting_r_1, cutting_r_1);
    detail::add_gain_doubt(fit, cuts, scratch, options, doubt.tangential_relative_sd, Scalar(0));
    detail::add_gain_doubt(fit, cuts, scratch, options, Scalar(0), doubt.feed_relative_sd);
    detail::add_gain_doubt(fit, cuts, scratch, options, doubt.shared_relative_sd, doubt.shared_relative_sd);
    const Scalar r_1 = fit.parameters(cutting_r_1);
    const Scalar more_in_ln_K_s = fit.covariance(cutting_ln_K_s, cutting_ln_K_s) - ln_K_s_variance;
    const Scalar more_in_r_1 = (fit.covariance(cutting_r_1, cutting_r_1) - r_1_variance) / (r_1 * r_1);
    CuttingLaw<Scalar>& law = fit.law;
    law.K_s_relative_sd = sqrt(law.K_s_relative_sd * law.K_s_relative_sd + more_in_ln_K_s);
    law.r_1_relative_sd = sqrt(law.r_1_relative_sd * law.r_1_relative_sd + more_in_r_1);
    return fit;
}

}  // namespace millforce::estimation
