// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation_calibration/roughness_fit.hpp"

#include "estimation/fit_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

/// Cutting tests as a roughness model would give them: the published models, the published conditions, seeded scatter.

namespace millforce::test {

using Cut = estimation::RoughnessConditions<double>;
using RoughnessTests = std::vector<estimation::RoughnessTest>;

inline estimation::RoughnessModel<double> published_Ra() {
    estimation::RoughnessModel<double> model;
    model.constant_um = 7.5e-6;
    model.exponent = {0.964, 0.195, 2.69, 0.917, -2.6};
    return model;
}

inline estimation::RoughnessModel<double> published_Rz() {
    estimation::RoughnessModel<double> model;
    model.measure = estimation::RoughnessMeasure::Rz;
    model.constant_um = 2.91;
    model.exponent = {0.16, 0.438, 1.25, 0.474, -2.84};
    return model;
}

/// R by the power law itself.
inline double roughness_by_power_law_um(const estimation::RoughnessModel<double>& model, const Cut& cut) {
    double R = model.constant_um;
    for (std::size_t j = 0; j < cut.size(); ++j) {
        R *= std::pow(cut[j], model.exponent[j]);
    }
    return R;
}

/// All combinations of the paper's Table 1: 36 cuts. ρ, which the paper does not give, from 0.5 to 1.5.
inline std::vector<Cut> published_cuts(Noise& noise) {
    std::vector<Cut> cuts;
    for (const double V : {8000.0, 10000.0, 12000.0}) {
        for (const double f : {0.01, 0.03}) {
            for (const double phi : {4.0, 6.0, 8.0}) {
                for (const double D : {0.3, 0.5}) {
                    cuts.push_back({V, f, phi, D, noise.uniform(0.5, 1.5)});
                }
            }
        }
    }
    return cuts;
}

inline RoughnessTests made_with(const estimation::RoughnessModel<double>& model, const std::vector<Cut>& cuts,
                                Noise& noise, double ln_sd) {
    RoughnessTests tests;
    for (const Cut& cut : cuts) {
        tests.push_back({cut, roughness_by_power_law_um(model, cut) * std::exp(noise.normal(ln_sd))});
    }
    return tests;
}

inline estimation::RoughnessFit fit(const RoughnessTests& tests, unsigned held = 0U) {
    return estimation::fit_roughness(tests, held);
}

/// A cut within the published conditions, at random.
inline Cut any_cut(Noise& noise) {
    return {noise.uniform(8000, 12000), noise.uniform(0.01, 0.03), noise.uniform(4, 8), noise.uniform(0.3, 0.5),
            noise.uniform(0.5, 1.5)};
}

}  // namespace millforce::test
