// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

/// A helical end mill's plane force by summing discs, for the tests of the profile estimators: no closed form, no code
/// of theirs.

namespace millforce::tests {

struct FluteCut {
    int teeth = 4;
    double radius_mm = 9.525;
    double helix_rad = 30.0 * std::numbers::pi / 180.0;
    double axial_mm = 7.62;
    double radial_mm = 7.62;
    bool up = false;
    double tip_angle_rad = 0.2;
    double K_t = 1800.0;  ///< per feed
    double K_r = 600.0;
    double edge_t = 400.0;
    double edge_r = 500.0;
    double size_exponent = -0.2;  ///< of the chip's force
};

/// F_x + iF_y at a spindle angle.
inline std::complex<double> plane_force(const FluteCut& cut, double spindle_rad) {
    constexpr int discs = 240;
    constexpr double turn = 2.0 * std::numbers::pi;
    const double engagement = std::acos(1.0 - cut.radial_mm / cut.radius_mm);
    const double entry = cut.up ? 0.0 : std::numbers::pi - engagement;
    const double exit = cut.up ? engagement : std::numbers::pi;
    std::complex<double> sum = 0.0;
    for (int tooth = 0; tooth < cut.teeth; ++tooth) {
        for (int disc = 0; disc < discs; ++disc) {
            const double lag = (disc + 0.5) / discs * cut.axial_mm * std::tan(cut.helix_rad) / cut.radius_mm;
            const double angle = spindle_rad + cut.tip_angle_rad - tooth * turn / cut.teeth - lag;
            const double phi = angle - turn * std::floor(angle / turn);
            if (phi < entry || phi > exit) {
                continue;
            }
            const double chip = std::sin(phi);
            const double pressed = chip > 0.0 ? std::pow(chip, 1.0 + cut.size_exponent) : 0.0;
            const double F_t = cut.K_t * pressed + cut.edge_t;
            const double F_r = cut.K_r * pressed + cut.edge_r;
            sum += std::complex<double>(F_t * std::cos(phi) + F_r * std::sin(phi),
                                        -F_t * std::sin(phi) + F_r * std::cos(phi));
        }
    }
    return sum * (cut.axial_mm / discs);
}

/// One pitch, `samples` values from spindle angle 0 on. It repeats itself.
inline std::vector<std::complex<double>> pitch_force(const FluteCut& cut, std::size_t samples) {
    std::vector<std::complex<double>> force;
    for (std::size_t i = 0; i < samples; ++i) {
        force.push_back(plane_force(cut, 2.0 * std::numbers::pi * static_cast<double>(i) /
                                             (static_cast<double>(cut.teeth) * static_cast<double>(samples))));
    }
    return force;
}

}  // namespace millforce::tests
