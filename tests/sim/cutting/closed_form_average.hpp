// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include "cutting/cutter.hpp"
#include "cutting/cutting_coefficients.hpp"

namespace millforce::sim {

/// Averages over a revolution in closed form, for the circular chip h = f_z sin φ and constant coefficients, straight
/// from the integrals ∫ F dφ over [φ_st, φ_ex] (Kim & Chung, with edge forces added). The plant contains none of this.
struct ClosedFormAverage {
    double tangential_N;
    double fx_N;
    double fy_N;
    double fz_N;
    double torque_Nm;
};

inline ClosedFormAverage closed_form_average(const Cutter& cutter, const CuttingCoefficients& K, double entry_rad,
                                             double exit_rad, double axial_depth_mm, double feed_per_tooth_mm) {
    const double sin_in = std::sin(entry_rad);
    const double sin_out = std::sin(exit_rad);
    const double c = std::cos(entry_rad) - std::cos(exit_rad);
    const double s = 0.5 * (sin_out * sin_out - sin_in * sin_in);
    const double b = 0.5 * ((exit_rad - entry_rad) - 0.5 * (std::sin(2.0 * exit_rad) - std::sin(2.0 * entry_rad)));
    const double per_turn = static_cast<double>(cutter.teeth) * axial_depth_mm / (2.0 * std::numbers::pi);
    const double f = feed_per_tooth_mm;
    const double width_rad = exit_rad - entry_rad;
    ClosedFormAverage average{};
    average.tangential_N = per_turn * (K.K_tc_N_mm2 * f * c + K.K_te_N_mm * width_rad);
    average.fx_N =
        per_turn * (K.K_tc_N_mm2 * f * s + K.K_rc_N_mm2 * f * b + K.K_te_N_mm * (sin_out - sin_in) + K.K_re_N_mm * c);
    average.fy_N =
        per_turn * (-K.K_tc_N_mm2 * f * b + K.K_rc_N_mm2 * f * s - K.K_te_N_mm * c + K.K_re_N_mm * (sin_out - sin_in));
    average.fz_N = per_turn * (K.K_ac_N_mm2 * f * c + K.K_ae_N_mm * width_rad);
    average.torque_Nm = 1e-3 * 0.5 * cutter.diameter_mm * average.tangential_N;
    return average;
}

}  // namespace millforce::sim
