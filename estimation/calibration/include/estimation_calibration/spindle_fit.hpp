// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/least_squares.hpp"

#include <cmath>
#include <limits>
#include <span>

/// Torque constant of a spindle drive from known torques (cuts with known forces, a brake, and idle running).
///
///   T = K_t1 g(ω) I + K_t2 − k ω − J dω/dt,   g(ω) = 1 up to the base speed ω_b, ω_b/ω above it
///
/// K_t1 I + K_t2 is Kim & Chung Eq. 8 (there as a force: divide by R). Above ω_b a spindle in field weakening delivers
/// power, not torque. For a given ω_b the fit is linear; ω_b is searched, and kept only where it explains the torques
/// significantly better than a constant K_t1.

namespace millforce::estimation {

template <typename Scalar>
struct SpindleSample {
    Scalar current_A{0};
    Scalar speed_rad_s{0};
    Scalar acceleration_rad_s2{0};
    Scalar torque_Nm{0};  ///< known torque of the cut; 0 when idle.
};

/// Which terms beside K_t1 and K_t2 the samples are asked for. A term that is left out is 0.
struct SpindleFitTerms {
    bool idle_slope = false;       ///< k: takes at least two speeds.
    bool inertia = false;          ///< J: takes acceleration.
    bool field_weakening = false;  ///< ω_b: takes cuts at speeds on both sides of it.
};

enum SpindleFitIndex : int {
    spindle_K_t1,        ///< N·m/A
    spindle_K_t2,        ///< N·m
    spindle_idle_slope,  ///< N·m·s
    spindle_inertia,     ///< kg·m²
    spindle_base_speed,  ///< rad/s
    spindle_parameter_count
};

template <typename Scalar>
struct SpindleFit {
    /// In the order of SpindleFitIndex. Base speed 0: no field weakening seen.
    LeastSquaresSolution<Scalar, spindle_parameter_count> solution{};
    /// Field weakening is seen, but no sample lies below the base speed: K_t1 holds at that speed and falls above it,
    /// and nothing is known below.
    bool nothing_below_base_speed = false;
};

namespace detail {

template <typename Scalar>
Scalar spindle_gain(Scalar base_speed_rad_s, Scalar speed_rad_s) {
    return base_speed_rad_s > Scalar(0) && speed_rad_s > base_speed_rad_s ? base_speed_rad_s / speed_rad_s : Scalar(1);
}

template <typename Scalar>
LeastSquares<Scalar, spindle_parameter_count> spindle_rows(std::span<const SpindleSample<Scalar>> samples,
                                                           SpindleFitTerms terms, Scalar base_speed_rad_s,
                                                           Scalar K_t1_for_slope) {
    LeastSquares<Scalar, spindle_parameter_count> fit;
    for (const SpindleSample<Scalar>& sample : samples) {
        const Scalar gain = spindle_gain(base_speed_rad_s, sample.speed_rad_s);
        const bool weakened = gain < Scalar(1);
        Eigen::Matrix<Scalar, spindle_parameter_count, 1> row;
        row << gain * sample.current_A, Scalar(1), terms.idle_slope ? -sample.speed_rad_s : Scalar(0),
            terms.inertia ? -sample.acceleration_rad_s2 : Scalar(0),
            weakened ? K_t1_for_slope * sample.current_A / sample.speed_rad_s : Scalar(0);
        // The last parameter is the base speed's step from base_speed_rad_s: 0 at the optimum.
        fit.add(row, sample.torque_Nm);
    }
    if (!terms.idle_slope) {
        fit.add_prior(spindle_idle_slope, Scalar(0), Scalar(1));
    }
    if (!terms.inertia) {
        fit.add_prior(spindle_inertia, Scalar(0), Scalar(1));
    }
    if (!(K_t1_for_slope > Scalar(0))) {
        fit.add_prior(spindle_base_speed, Scalar(0), Scalar(1));
    }
    return fit;
}

template <typename Scalar>
Scalar spindle_misfit(std::span<const SpindleSample<Scalar>> samples, SpindleFitTerms terms, Scalar base_speed_rad_s) {
    return spindle_rows(samples, terms, base_speed_rad_s, Scalar(0)).residual_sum_of_squares();
}

/// Base speed of least misfit: a scan over the speeds of the samples, then a golden-section search around the best.
template <typename Scalar>
Scalar search_base_speed(std::span<const SpindleSample<Scalar>> samples, SpindleFitTerms terms, Scalar slowest,
                         Scalar fastest) {
    constexpr int steps = 48;
    const Scalar width = (fastest - slowest) / static_cast<Scalar>(steps);
    int best = 0;
    Scalar least = std::numeric_limits<Scalar>::infinity();
    for (int k = 0; k <= steps; ++k) {
        const Scalar misfit = spindle_misfit(samples, terms, slowest + width * static_cast<Scalar>(k));
        if (misfit < least) {
            least = misfit;
            best = k;
        }
    }
    Scalar low = slowest + width * static_cast<Scalar>(best > 0 ? best - 1 : 0);
    Scalar high = slowest + width * static_cast<Scalar>(best < steps ? best + 1 : steps);
    const Scalar golden = Scalar(0.618033988749894848L);
    for (int k = 0; k < 40; ++k) {
        const Scalar left = high - golden * (high - low);
        const Scalar right = low + golden * (high - low);
        if (spindle_misfit(samples, terms, left) <= spindle_misfit(samples, terms, right)) {
            high = right;
        } else {
            low = left;
        }
    }
    return (low + high) / Scalar(2);
}

}  // namespace detail

/// Fits the samples. `significance`: F-ratio by which field weakening must beat a constant K_t1 (12: one chance in a
/// thousand). Cost: some 130 passes over the samples where field weakening is asked for, else 1.
template <typename Scalar>
SpindleFit<Scalar> fit_spindle(std::span<const SpindleSample<Scalar>> samples, SpindleFitTerms terms,
                               Scalar significance = Scalar(12)) {
    SpindleFit<Scalar> result;
    const auto constant = detail::spindle_rows(samples, terms, Scalar(0), Scalar(0));
    result.solution = constant.solve();
    if (!terms.field_weakening || samples.empty()) {
        return result;
    }
    Scalar slowest = samples[0].speed_rad_s;
    Scalar fastest = slowest;
    for (const SpindleSample<Scalar>& sample : samples) {
        slowest = sample.speed_rad_s < slowest ? sample.speed_rad_s : slowest;
        fastest = sample.speed_rad_s > fastest ? sample.speed_rad_s : fastest;
    }
    const Scalar base_speed = detail::search_base_speed(samples, terms, slowest, fastest);
    const auto weakened = detail::spindle_rows(samples, terms, base_speed, Scalar(0));
    const int free_rows = weakened.rows() - 3 - static_cast<int>(terms.idle_slope) - static_cast<int>(terms.inertia);
    const Scalar gain = constant.residual_sum_of_squares() - weakened.residual_sum_of_squares();
    if (free_rows < 1 || !(gain * static_cast<Scalar>(free_rows) > significance * weakened.residual_sum_of_squares())) {
        return result;
    }
    const Scalar K_t1 = weakened.solve().parameters(spindle_K_t1);
    result.nothing_below_base_speed = base_speed < slowest + (fastest - slowest) * Scalar(1e-3);
    const Scalar K_t1_for_slope = result.nothing_below_base_speed ? Scalar(0) : K_t1;
    result.solution = detail::spindle_rows(samples, terms, base_speed, K_t1_for_slope).solve();
    result.solution.parameters(spindle_base_speed) = base_speed;
    return result;
}

}  // namespace millforce::estimation
