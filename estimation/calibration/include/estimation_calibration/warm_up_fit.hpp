// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

/// Warm-up of an idling spindle: T(t) = T_warm + T_cold e^(−t/τ), the calibration of WarmUpTracker.
///
/// For a given τ the fit is linear; τ is searched from a twentieth of the record to five times its length, and its
/// standard error follows from the derivative there. Time 0 is where the record begins: a spindle that is half warm
/// then gives half of T_cold.
///
/// A record must show the curve bend: what falls for less than 1.5 τ looks like a straight line, and T_cold and τ grow
/// together without limit. `lack` reports it.
/// Cost: some 110 passes over the samples.

namespace millforce::estimation {

struct IdleTorque {
    double time_s = 0.0;
    double torque_Nm = 0.0;
};

/// What the record lacks for a fit.
enum class WarmUpLack : unsigned char {
    nothing,
    samples,   ///< fewer than 20
    excess,    ///< the torque does not fall beyond its noise
    duration,  ///< the record is shorter than 1.5 τ, or the standard error of τ is above a fifth of τ
};

struct WarmUpFit {
    WarmUpLack lack = WarmUpLack::nothing;  ///< unless `nothing`, the values must not be used
    double excess_Nm = 0.0;                 ///< T_cold
    double excess_se_Nm = 0.0;
    double time_constant_s = 0.0;  ///< τ
    double time_constant_se_s = 0.0;
    double warm_Nm = 0.0;  ///< T_warm
    double warm_se_Nm = 0.0;
    double residual_Nm = 0.0;  ///< standard deviation of a sample about the curve
    double duration_s = 0.0;
};

/// Fits the samples, in the order of time.
[[nodiscard]] WarmUpFit fit_warm_up(std::span<const IdleTorque> samples);

}  // namespace millforce::estimation
