// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/surface/roughness.hpp"

#include <array>
#include <span>

/// A roughness model from cutting tests: least squares in logarithms (Tangjitsitcharoen & Senjuntichaj, section 2.2),
///
///   ln R = ln C + a₁ ln V + a₂ ln f + a₃ ln φ + a₄ ln D + a₅ ln ρ + e,   e normal with the same variance in all tests,
///
/// p = 6 parameters, with what the prediction interval needs: s, n − p, M and the largest leverage (roughness.hpp).
///
/// An exponent is not determined where its variable, apart from what the other variables explain of it, varies by less
/// than 2 % (rms): then the tests do not show its effect, and another scatter would give another exponent. A shop with
/// one tool holds its diameter: an exponent that is held is 0 and no parameter, and the model is for that diameter
/// alone.
///
/// Cost: three passes over the tests, one 6 × 6 decomposition.

namespace millforce::estimation {

/// One cutting test: conditions, and R_a or R_z as measured on the surface. All > 0; others are left out.
struct RoughnessTest {
    RoughnessConditions<double> cut{};
    double roughness_um = 0.0;
};

struct RoughnessFit {
    RoughnessModel<double> model{};
    RoughnessValues<double> exponent_standard_error{};
    double constant_ln_standard_error =
        0.0;  ///< standard error of ln C, far outside the tests: R at their middle is known far better
    double reference_um = 0.0;                 ///< R at the geometric means of the tests
    double reference_ln_standard_error = 0.0;  ///< standard error of ln(reference_um): s/√n
    double determination = 0.0;                ///< share of the variance of ln R that the model explains, 0…1
    int tests = 0;
    int degrees_of_freedom = 0;
    int worst_test = -1;          ///< index of the test furthest from the model, by worst_residual; −1: none
    double worst_residual = 0.0;  ///< its residual in standard deviations of that residual, s √(1 − h)
    unsigned undetermined = 0;    ///< bit j: the tests cannot determine exponent j
    std::array<int, static_cast<std::size_t>(roughness_variable_count)> goes_with{};  ///< see variable_it_goes_with

    /// False: too few tests, or an exponent is not determined. `model` must then not be used.
    [[nodiscard]] bool is_determined() const { return degrees_of_freedom > 0 && undetermined == 0U; }
    [[nodiscard]] bool determined(int j) const { return ((undetermined >> static_cast<unsigned>(j)) & 1U) == 0U; }
    /// Why exponent j is not determined: −1: its variable does not vary; else the variable that varies along with it.
    [[nodiscard]] int variable_it_goes_with(int j) const { return goes_with[static_cast<std::size_t>(j)]; }
};

/// `held`: bit j: exponent j is not fitted and stays 0.
[[nodiscard]] RoughnessFit fit_roughness(std::span<const RoughnessTest> tests, unsigned held = 0U);

/// The model as a controller predicts with it.
[[nodiscard]] RoughnessModel<float> in_float(const RoughnessModel<double>& model);

}  // namespace millforce::estimation
