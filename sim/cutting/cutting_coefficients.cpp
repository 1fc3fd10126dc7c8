// SPDX-License-Identifier: Apache-2.0
#include "cutting/cutting_coefficients.hpp"

#include <cmath>

#include "cutting/checked_value.hpp"

namespace millforce::sim {

void validate(const CuttingCoefficients& coefficients) {
    constexpr double largest = 1e6;
    check_range("coefficients.K_tc_N_mm2", coefficients.K_tc_N_mm2, 1e-6, largest);
    check_range("coefficients.K_rc_N_mm2", coefficients.K_rc_N_mm2, -largest, largest);
    check_range("coefficients.K_ac_N_mm2", coefficients.K_ac_N_mm2, -largest, largest);
    check_range("coefficients.K_te_N_mm", coefficients.K_te_N_mm, -largest, largest);
    check_range("coefficients.K_re_N_mm", coefficients.K_re_N_mm, -largest, largest);
    check_range("coefficients.K_ae_N_mm", coefficients.K_ae_N_mm, -largest, largest);
    const SizeEffect& size = coefficients.size_effect;
    check_range("coefficients.size_effect.tangential_exponent", size.tangential_exponent, -1.0, 1.0);
    check_range("coefficients.size_effect.radial_exponent", size.radial_exponent, -1.0, 1.0);
    check_range("coefficients.size_effect.axial_exponent", size.axial_exponent, -1.0, 1.0);
    check_range("coefficients.size_effect.reference_mm", size.reference_mm, 1e-6, 100.0);
    check_range("coefficients.size_effect.floor_mm", size.floor_mm, 1e-9, 10.0);
}

CuttingCoefficients coefficients_at(const AverageChipLaw& law, double average_chip_thickness_mm) {
    check_range("average_chip_thickness_mm", average_chip_thickness_mm, 1e-9, 100.0);
    CuttingCoefficients coefficients;
    coefficients.K_tc_N_mm2 = law.k_s * std::pow(average_chip_thickness_mm, law.p_s);
    coefficients.K_rc_N_mm2 = coefficients.K_tc_N_mm2 * law.k_1 * std::pow(average_chip_thickness_mm, law.p_1);
    validate(coefficients);
    return coefficients;
}

}  // namespace millforce::sim
