// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/least_squares.hpp"

#include <cmath>
#include <limits>
#include <span>

/// Warm-up of an idling spindle: T(t) = T_warm + T_cold e^(−t/τ), the calibration of WarmUpTracker.
///
/// For a given τ the fit is linear; τ is searched from a twentieth of the record to five times its length, and its
/// standard error follows from the derivative there. Time 0 is where the record begins: a spindle that is half warm
/// then gives half of T_cold.
///
/// A record must show the curve bend: what falls for less than 1.5 τ looks like a straight line, and T_cold and τ grow
/// together without limit. `lack` says so.
/// Cost: some 90 passes over the samples. No heap.

namespace millforce::estimation {

template <typename Scalar>
struct IdleTorque {
    Scalar time_s{0};
    Scalar torque_Nm{0};
};

enum class WarmUpLack : unsigned char {
    nothing,
    samples,   ///< fewer than 20
    excess,    ///< the torque does not fall beyond its noise
    duration,  ///< the record is shorter than 1.5 τ, or τ is known to no better than a fifth
};

template <typename Scalar>
struct WarmUpFit {
    WarmUpLack lack = WarmUpLack::nothing;  ///< beside `nothing` the values are not to be used
    Scalar excess_Nm{0};                    ///< T_cold
    Scalar excess_se_Nm{0};
    Scalar time_constant_s{0};  ///< τ
    Scalar time_constant_se_s{0};
    Scalar warm_Nm{0};  ///< T_warm
    Scalar warm_se_Nm{0};
    Scalar residual_Nm{0};  ///< standard deviation of a sample about the curve
    Scalar duration_s{0};
};

namespace detail {

enum WarmUpIndex : int { warm_up_warm, warm_up_cold, warm_up_slope };

/// `cold_for_slope` 0: τ is held, and its step has no column.
template <typename Scalar>
LeastSquares<Scalar, 3> warm_up_rows(std::span<const IdleTorque<Scalar>> samples, Scalar tau_s, Scalar cold_for_slope) {
    using std::exp;
    LeastSquares<Scalar, 3> fit;
    for (const auto& sample : samples) {
        const Scalar t = (sample.time_s - samples.front().time_s) / tau_s;
        const Scalar left = exp(-t);
        fit.add({Scalar(1), left, cold_for_slope * left * t}, sample.torque_Nm);  // ∂/∂ln τ
    }
    if (cold_for_slope == Scalar(0)) {
        fit.add_prior(warm_up_slope, Scalar(0), Scalar(1));
    }
    return fit;
}

template <typename Scalar>
Scalar warm_up_misfit(std::span<const IdleTorque<Scalar>> samples, Scalar ln_tau) {
    using std::exp;
    return warm_up_rows(samples, exp(ln_tau), Scalar(0)).residual_sum_of_squares();
}

template <typename Scalar>
Scalar search_warm_up_time(std::span<const IdleTorque<Scalar>> samples, Scalar low, Scalar high) {
    using std::exp;
    constexpr int steps = 24;
    const Scalar width = (high - low) / Scalar(steps);
    int best = 0;
    Scalar least = std::numeric_limits<Scalar>::infinity();
    for (int k = 0; k <= steps; ++k) {
        const Scalar misfit = warm_up_misfit(samples, low + width * Scalar(k));
        if (misfit < least) {
            least = misfit;
            best = k;
        }
    }
    Scalar left = low + width * Scalar(best > 0 ? best - 1 : 0);
    Scalar right = low + width * Scalar(best < steps ? best + 1 : steps);
    const Scalar golden = static_cast<Scalar>(0.618033988749894848L);
    for (int k = 0; k < 30; ++k) {
        const Scalar a = right - golden * (right - left);
        const Scalar b = left + golden * (right - left);
        if (warm_up_misfit(samples, a) <= warm_up_misfit(samples, b)) {
            right = b;
        } else {
            left = a;
        }
    }
    return exp((left + right) / Scalar(2));
}

}  // namespace detail

/// Fits the samples, in the order of time.
template <typename Scalar>
WarmUpFit<Scalar> fit_warm_up(std::span<const IdleTorque<Scalar>> samples) {
    using std::log;
    WarmUpFit<Scalar> result;
    constexpr std::size_t fewest = 20;
    if (samples.size() < fewest || !(samples.back().time_s > samples.front().time_s)) {
        result.lack = WarmUpLack::samples;
        return result;
    }
    result.duration_s = samples.back().time_s - samples.front().time_s;
    const Scalar tau =
        detail::search_warm_up_time(samples, log(result.duration_s / Scalar(20)), log(result.duration_s * Scalar(5)));
    const Scalar cold = detail::warm_up_rows(samples, tau, Scalar(0)).solve().parameters(detail::warm_up_cold);
    const auto solution = detail::warm_up_rows(samples, tau, cold).solve(Scalar(1e6F));
    result.excess_Nm = cold;
    result.excess_se_Nm = solution.standard_error(detail::warm_up_cold);
    result.time_constant_s = tau;
    result.time_constant_se_s = tau * solution.standard_error(detail::warm_up_slope);
    result.warm_Nm = solution.parameters(detail::warm_up_warm);
    result.warm_se_Nm = solution.standard_error(detail::warm_up_warm);
    result.residual_Nm = solution.residual_sd;
    const bool long_enough = result.duration_s >= Scalar(1.5F) * tau && result.time_constant_se_s < tau / Scalar(5);
    const bool falls =
        cold > Scalar(3) * detail::warm_up_rows(samples, tau, Scalar(0)).solve().standard_error(detail::warm_up_cold);
    result.lack = !falls ? WarmUpLack::excess : (!long_enough ? WarmUpLack::duration : WarmUpLack::nothing);
    return result;
}

}  // namespace millforce::estimation
