// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/cutting_fit.hpp"

#include "cutting_fit_solver.hpp"

#include <cmath>

namespace millforce::estimation {

double CuttingFit::standard_error(int j) const {
    return std::sqrt(covariance(j, j));
}

double CuttingFit::k_s_standard_error() const {
    const double x = -std::log(reference_chip_thickness_mm);
    const double ln_variance = covariance(cutting_ln_K_s, cutting_ln_K_s) +
                               x * x * covariance(cutting_p_s, cutting_p_s) +
                               2.0 * x * covariance(cutting_ln_K_s, cutting_p_s);
    return law.k_s_N_per_mm2 * std::sqrt(ln_variance);
}

double CuttingFit::k_1_standard_error() const {
    const double x = -std::log(reference_chip_thickness_mm);
    const double to_one_mm = std::exp(x * parameters(cutting_p_1));
    const double by_exponent = x * parameters(cutting_r_1);
    const double variance = covariance(cutting_r_1, cutting_r_1) +
                            by_exponent * by_exponent * covariance(cutting_p_1, cutting_p_1) +
                            2.0 * by_exponent * covariance(cutting_r_1, cutting_p_1);
    return to_one_mm * std::sqrt(variance);
}

CuttingFit fit_cutting_law(std::span<const CuttingMeasurement> cuts, const CuttingFitOptions& options) {
    return CuttingFitSolver(cuts, options).run();
}

}  // namespace millforce::estimation
