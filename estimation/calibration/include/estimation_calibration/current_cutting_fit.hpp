// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation_calibration/cutting_fit.hpp"

/// k_s, p_s, k_1, p_1 of an unknown tool and workpiece from cuts whose forces come from motor currents alone (Kim &
/// Chung, section 3.3). The cuts are those of fit_cutting_law, with F_at from the spindle and F_ax from the feed drive.
///
/// A dynamometer's errors differ from cut to cut; a drive's gain is wrong for all of them alike, and no number of cuts
/// shows it. So the fit is repeated with all F_at larger by the relative standard deviation of K_t1, and with all F_ax
/// larger by that of K_x4; how far the coefficients move is added to their covariance:
///   cov = cov_fit + Δ_t Δ_tᵀ + Δ_x Δ_xᵀ
/// K_s moves with K_t1 alone, r_1 with the ratio of both gains, and in down milling several times as far, because F_ax
/// is the difference of two larger terms: s + r_1 b, s < 0.
/// Where both gains come from standard cuts with one database, its error moves both alike (`shared_relative_sd`) and
/// leaves r_1 alone.
///
/// Cost: up to four times fit_cutting_law.

namespace millforce::estimation {

/// How well the gains are known that the forces were calculated with.
struct DriveGainDoubt {
    double tangential_relative_sd = 0.0;  ///< deviation of K_t1, without what it shares with K_x4
    double feed_relative_sd = 0.0;        ///< deviation of K_x4, likewise without the shared part
    double shared_relative_sd = 0.0;      ///< deviation that both share
};

/// As fit_cutting_law, with the uncertainty of the gains in the covariance and in the law.
[[nodiscard]] CuttingFit fit_cutting_law_from_currents(std::span<const CuttingMeasurement> cuts,
                                                       const DriveGainDoubt& doubt, const CuttingFitOptions& options);

}  // namespace millforce::estimation
