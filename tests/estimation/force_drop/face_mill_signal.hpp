// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

/// Forces of a face mill as a sensor behind a low-pass shows them, for tests: Eqs. 1–4 of Hwang et al. with an edge
/// force, tooth by tooth and step by step; no closed form, no code of the estimators.

namespace millforce::tests {

struct FaceMillSignal {
    double revs_per_s = 5.0;
    int teeth = 3;
    double entry_rad = 0.0;
    double exit_rad = std::numbers::pi / 3.0;
    double pressure_N_per_mm = 2400.0;  ///< K a
    double feed_mm = 0.15;
    double r = 0.4;
    double e_t_mm = 0.0;
    double e_r_mm = 0.0;
    double corner_hz = 300.0;  ///< Butterworth, second order; 0: none
    double offset_x_N = 0.0;
    double offset_y_N = 0.0;
    double noise_N = 0.0;          ///< white, after the low-pass
    double tooth_variation = 0.0;  ///< the teeth's chips differ by ± this share
    std::uint64_t seed = 1;

    struct Force {
        double x_N = 0.0;
        double y_N = 0.0;
    };
    struct Sample {
        double angle_rev = 0.0;
        double dt_s = 0.0;
        Force force{};
    };

    [[nodiscard]] Force tooth(double phi) const {
        const double chip = feed_mm * std::sin(phi);
        const double tangential = pressure_N_per_mm * (chip + e_t_mm);
        const double radial = pressure_N_per_mm * (r * chip + e_r_mm);
        return {tangential * std::cos(phi) + radial * std::sin(phi),
                radial * std::cos(phi) - tangential * std::sin(phi)};
    }

    [[nodiscard]] Force at(double rev) const {
        constexpr double turn = 2.0 * std::numbers::pi;
        Force sum{offset_x_N, offset_y_N};
        for (int k = 0; k < teeth; ++k) {
            const double phase = rev - static_cast<double>(k) / teeth;
            const double phi = turn * (phase - std::floor(phase));
            if (phi >= entry_rad && phi <= exit_rad) {
                const double share = 1.0 + tooth_variation * std::cos(turn * k / teeth);
                const Force one = tooth(phi);
                sum.x_N += share * one.x_N;
                sum.y_N += share * one.y_N;
            }
        }
        return sum;
    }

    /// Mean over a revolution, by summation.
    [[nodiscard]] Force mean() const {
        constexpr int steps = 20000;
        Force sum;
        for (int k = 0; k < steps; ++k) {
            const Force now = at((k + 0.5) / steps);
            sum.x_N += now.x_N / steps;
            sum.y_N += now.y_N / steps;
        }
        return sum;
    }

    /// `per_rev` samples a revolution, after one revolution to settle.
    [[nodiscard]] std::vector<Sample> samples(double revolutions, int per_rev = 512) const {
        constexpr int substeps = 40;
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal(0.0, 1.0);
        const double dt_s = 1.0 / (revs_per_s * per_rev * substeps);
        const double omega = 2.0 * std::numbers::pi * corner_hz;
        Force position;
        Force rate;
        std::vector<Sample> out;
        const auto advance = [&](double& value, double& slope, double input) {
            slope += dt_s * (omega * omega * (input - value) - std::numbers::sqrt2 * omega * slope);
            value += dt_s * slope;
        };
        for (int k = -per_rev * substeps; k < static_cast<int>(revolutions * per_rev) * substeps; ++k) {
            const double rev = static_cast<double>(k) / (per_rev * substeps) + 1.0;
            const Force now = at(rev);
            if (corner_hz > 0.0) {
                advance(position.x_N, rate.x_N, now.x_N);
                advance(position.y_N, rate.y_N, now.y_N);
            } else {
                position = now;
            }
            if (k >= 0 && k % substeps == 0) {
                out.push_back({rev - std::floor(rev),
                               1.0 / (revs_per_s * per_rev),
                               {position.x_N + noise_N * normal(random), position.y_N + noise_N * normal(random)}});
            }
        }
        return out;
    }
};

}  // namespace millforce::tests
