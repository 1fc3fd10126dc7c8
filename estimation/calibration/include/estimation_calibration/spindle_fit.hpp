// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/least_squares.hpp"

#include <cstddef>
#include <span>
#include <vector>

/// Torque constant of a spindle drive from known torques (cuts with known forces, a brake, and idle running).
///
///   T = K_t1 g(ω) I + K_t2 − k ω − J dω/dt,   g(ω) = 1 up to the base speed ω_b, ω_b/ω above it
///
/// K_t1 I + K_t2 is Kim & Chung Eq. 8 (there as a force: divide by R). Above ω_b a spindle in field weakening delivers
/// power, not torque. For a given ω_b the fit is linear; ω_b is searched, and kept only where it explains the torques
/// significantly better than a constant K_t1.

namespace millforce::estimation {

struct SpindleSample {
    double current_A = 0.0;
    double speed_rad_s = 0.0;
    double acceleration_rad_s2 = 0.0;
    double torque_Nm = 0.0;  ///< known torque of the cut; 0 when idle
};

/// Which terms are fitted besides K_t1. A term that is not fitted is 0.
struct SpindleFitTerms {
    bool idle_slope = false;       ///< k: needs at least two speeds
    bool inertia = false;          ///< J: needs acceleration
    bool field_weakening = false;  ///< ω_b: needs cuts at speeds on both sides of it
    bool idle_torque = true;       ///< K_t2
};

enum SpindleFitIndex : int {
    spindle_K_t1,        ///< N·m/A
    spindle_K_t2,        ///< N·m
    spindle_idle_slope,  ///< N·m·s
    spindle_inertia,     ///< kg·m²
    spindle_base_speed,  ///< rad/s
    spindle_parameter_count
};

struct SpindleFit {
    /// In the order of SpindleFitIndex. Base speed 0: no field weakening seen.
    LeastSquaresSolution<double, spindle_parameter_count> solution{};
    /// Field weakening is seen, but the samples show no base speed above their slowest (by the same F-ratio):
    /// K_t1 holds at the slowest speed and falls above it, and nothing is known below.
    bool nothing_below_base_speed = false;
};

/// g(ω). Base speed 0: no field weakening, always 1.
[[nodiscard]] double field_weakening_gain(double base_speed_rad_s, double speed_rad_s);

/// F-ratio of one more parameter that chance alone exceeds once in a thousand fits.
inline constexpr double field_weakening_significance = 12.0;

/// Fits the samples. `significance`: F-ratio by which field weakening must beat a constant K_t1. Cost: some 130 passes
/// over the samples where field weakening is to be fitted, else one.
[[nodiscard]] SpindleFit fit_spindle(std::span<const SpindleSample> samples, SpindleFitTerms terms,
                                     double significance = field_weakening_significance);

/// K_t1 g(ω) I + K_t2 − k ω − J dω/dt by the parameters of a fit.
[[nodiscard]] double spindle_torque_Nm(const SpindleFit& fit, const SpindleSample& sample);

struct TrimmedSpindleFit {
    SpindleFit fit{};
    std::vector<std::size_t> outliers;  ///< places of the samples that were left out, in rising order
    int passes = 0;
};

/// The fit without the samples that lie further from it than six robust standard deviations (1.4826 times the median
/// of the distances, idle running and cuts apart). Where it starts, a tenth of the samples may be anything: it is the
/// best of the fits to six samples each, drawn with a fixed seed, judged by the distance that 85 % of the samples keep
/// to. Cost: a few hundred passes over 2000 of the samples, then some three times fit_spindle.
[[nodiscard]] TrimmedSpindleFit fit_spindle_without_outliers(std::span<const SpindleSample> samples,
                                                             SpindleFitTerms terms);

}  // namespace millforce::estimation
