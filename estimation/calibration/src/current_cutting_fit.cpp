// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/current_cutting_fit.hpp"

#include <cmath>
#include <vector>

namespace millforce::estimation {

namespace {

/// How far the parameters of `fit` move where the gains of the drives are larger by these shares.
CuttingParameters step_of_parameters(const CuttingFit& fit, std::span<const CuttingMeasurement> cuts,
                                     const CuttingFitOptions& options, double tangential_share, double feed_share) {
    if (!(tangential_share > 0.0) && !(feed_share > 0.0)) {
        return CuttingParameters::Zero();
    }
    std::vector<CuttingMeasurement> moved(cuts.begin(), cuts.end());
    for (CuttingMeasurement& cut : moved) {
        cut.tangential_N *= 1.0 + tangential_share;
        cut.feed_N *= 1.0 + feed_share;
        cut.normal_N *= 1.0 + feed_share;
    }
    return fit_cutting_law(moved, options).parameters - fit.parameters;
}

}  // namespace

CuttingFit fit_cutting_law_from_currents(std::span<const CuttingMeasurement> cuts, const DriveGainDoubt& doubt,
                                         const CuttingFitOptions& options) {
    CuttingFit fit = fit_cutting_law(cuts, options);
    if (fit.undetermined != 0U) {
        return fit;
    }
    CuttingCovariance of_gains = CuttingCovariance::Zero();
    const auto add_gain_error = [&](double tangential_share, double feed_share) {
        const CuttingParameters step = step_of_parameters(fit, cuts, options, tangential_share, feed_share);
        of_gains += step * step.transpose();
    };
    add_gain_error(doubt.tangential_relative_sd, 0.0);
    add_gain_error(0.0, doubt.feed_relative_sd);
    add_gain_error(doubt.shared_relative_sd, doubt.shared_relative_sd);
    fit.covariance += of_gains;
    const double r_1 = fit.parameters(cutting_r_1);
    CuttingLaw<double>& law = fit.law;
    law.K_s_relative_sd = std::hypot(law.K_s_relative_sd, std::sqrt(of_gains(cutting_ln_K_s, cutting_ln_K_s)));
    law.r_1_relative_sd = std::hypot(law.r_1_relative_sd, std::sqrt(of_gains(cutting_r_1, cutting_r_1)) / r_1);
    return fit;
}

}  // namespace millforce::estimation
