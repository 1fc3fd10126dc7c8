// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace millforce::sim {

/// How the specific cutting pressure grows on thin chips: K(h) = K_c (h/h_ref)^exponent, h the instantaneous chip
/// thickness, never taken below the floor. Exponents 0 (the default): K does not depend on h.
struct SizeEffect {
    double tangential_exponent = 0.0;  ///< −1…1, usually −0.4…−0.2
    double radial_exponent = 0.0;
    double axial_exponent = 0.0;
    double reference_mm = 1.0;  ///< h_ref > 0: the thickness at which K = K_c
    double floor_mm = 1e-3;     ///< below it K stays as it is at the floor; > 0
};

/// Force per unit of chip section (c) and per unit of edge length (e), tangential, radial and axial:
/// dF_t = K_tc h db + K_te db and so on. On the workpiece: tangential along the edge's motion, radial away from the
/// axis, axial along the edge, upwards (+z): a right-hand helix lifts the workpiece.
/// Ranges: each finite, |K| ≤ 1e6; K_tc > 0.
struct CuttingCoefficients {
    double K_tc_N_mm2 = 0.0;
    double K_rc_N_mm2 = 0.0;
    double K_ac_N_mm2 = 0.0;
    double K_te_N_mm = 0.0;
    double K_re_N_mm = 0.0;
    double K_ae_N_mm = 0.0;
    SizeEffect size_effect{};
};

/// Throws InputError with one line that names the field, its value and what was expected.
void validate(const CuttingCoefficients& coefficients);

/// Pressure as a power law of the AVERAGE chip thickness of a cut (Kim & Chung): K_s = k_s t_a^p_s tangentially, and
/// the ratio r_1 = k_1 t_a^p_1 radially; t_a in mm, K_s in N/mm².
struct AverageChipLaw {
    double k_s = 0.0;
    double p_s = 0.0;
    double k_1 = 0.0;
    double p_1 = 0.0;
};

/// The law at one average chip thickness (> 0 mm, a plain number of the caller), as coefficients for one cut.
/// Throws InputError where t_a is not positive and finite.
CuttingCoefficients coefficients_at(const AverageChipLaw& law, double average_chip_thickness_mm);

}  // namespace millforce::sim
