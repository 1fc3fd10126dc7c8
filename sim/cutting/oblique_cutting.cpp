// SPDX-License-Identifier: Apache-2.0
#include "cutting/oblique_cutting.hpp"

#include <cmath>

#include "cutting/angle_units.hpp"
#include "cutting/checked_value.hpp"

namespace millforce::sim {
namespace {

double normal_friction_angle(const ObliqueCut& cut) {
    const double chip_flow_rad = cut.inclination_rad;
    return std::atan(std::tan(cut.friction_angle_rad) * std::cos(chip_flow_rad));
}

void validate(const ObliqueCut& cut) {
    constexpr double little = 1e-6;
    check_range("oblique_cut.shear_stress_N_mm2", cut.shear_stress_N_mm2, little, 1e5);
    check_range("oblique_cut.shear_angle_rad", cut.shear_angle_rad, little, 90.0 * degree - little);
    check_range("oblique_cut.friction_angle_rad", cut.friction_angle_rad, 0.0, 85.0 * degree);
    check_range("oblique_cut.rake_rad", cut.rake_rad, -60.0 * degree, 60.0 * degree);
    check_range("oblique_cut.inclination_rad", cut.inclination_rad, 0.0, 70.0 * degree);
    check_range("oblique_cut: shear angle + friction angle - rake, in the normal plane",
                cut.shear_angle_rad + normal_friction_angle(cut) - cut.rake_rad, -90.0 * degree + little,
                90.0 * degree - little);
}

}  // namespace

CuttingCoefficients oblique_cutting(const ObliqueCut& cut) {
    validate(cut);
    const double phi_n = cut.shear_angle_rad;
    const double beta_n = normal_friction_angle(cut);
    const double alpha_n = cut.rake_rad;
    const double tan_i = std::tan(cut.inclination_rad);
    const double tan_eta = tan_i;  // Stabler's rule
    const double across = tan_eta * std::sin(beta_n);
    const double c = std::hypot(std::cos(phi_n + beta_n - alpha_n), across);
    const double pressure = cut.shear_stress_N_mm2 / (c * std::sin(phi_n));
    CuttingCoefficients coefficients;
    coefficients.K_tc_N_mm2 = pressure * (std::cos(beta_n - alpha_n) + tan_i * across);
    coefficients.K_rc_N_mm2 = pressure * std::sin(beta_n - alpha_n) / std::cos(cut.inclination_rad);
    coefficients.K_ac_N_mm2 = pressure * (std::cos(beta_n - alpha_n) * tan_i - across);
    return coefficients;
}

ObliqueAngles oblique_angles(const ObliqueCut& cut) {
    validate(cut);
    const double chip_flow_rad = cut.inclination_rad;
    ObliqueAngles angles;
    angles.theta_n_rad = normal_friction_angle(cut) - cut.rake_rad;
    angles.theta_i_rad = std::asin(std::sin(cut.friction_angle_rad) * std::sin(chip_flow_rad));
    angles.phi_i_rad = std::atan(std::tan(angles.theta_i_rad) / std::cos(angles.theta_n_rad + cut.shear_angle_rad));
    return angles;
}

ObliqueForce oblique_force(const ObliqueCut& cut, const ObliqueAngles& angles, double width_mm,
                           double chip_thickness_mm) {
    validate(cut);
    const double phi_n = cut.shear_angle_rad;
    const double i = cut.inclination_rad;
    const double theta_n = angles.theta_n_rad;
    const double theta_i = angles.theta_i_rad;
    const double phi_i = angles.phi_i_rad;
    const double along_shear =
        std::cos(theta_n + phi_n) * std::cos(theta_i) * std::cos(phi_i) + std::sin(theta_i) * std::sin(phi_i);
    const double F =
        cut.shear_stress_N_mm2 * width_mm * chip_thickness_mm / (along_shear * std::cos(i) * std::sin(phi_n));
    return {.cutting_N = F * (std::cos(theta_i) * std::cos(theta_n) * std::cos(i) + std::sin(theta_i) * std::sin(i)),
            .feed_N = F * std::cos(theta_i) * std::sin(theta_n),
            .passive_N = F * (std::sin(theta_i) * std::cos(i) - std::cos(theta_i) * std::cos(theta_n) * std::sin(i))};
}

}  // namespace millforce::sim
