// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/warm_up_fit.hpp"

#include "least_squares_in_double.hpp"
#include "minimum_search.hpp"

#include <cmath>

namespace millforce::estimation {

namespace {

constexpr std::size_t fewest_samples = 20;
constexpr double shortest_record_in_tau = 1.5;
constexpr double largest_relative_error_of_tau = 0.2;
constexpr double least_significance = 3.0;  // T_cold over its standard error

/// Largest condition number of the last fit. At 1.5 τ the columns of T_cold and ln τ are nearly parallel: that is for
/// the standard errors to show, and no reason to call either undetermined.
constexpr double largest_condition_of_last_fit = 1e6;

enum WarmUpIndex : int { index_warm, index_cold, index_ln_tau };

/// The fit for a given τ. Its last parameter is a step of ln τ from there, which is 0 at the best τ and is fitted only
/// for its standard error. `cold_for_step` 0: τ is held.
LeastSquares<double, 3> squares_at(std::span<const IdleTorque> samples, double tau_s, double cold_for_step) {
    LeastSquares<double, 3> fit;
    for (const IdleTorque& sample : samples) {
        const double t = (sample.time_s - samples.front().time_s) / tau_s;
        const double cold = std::exp(-t);
        const double per_ln_tau = cold_for_step * cold * t;
        fit.add({1.0, cold, per_ln_tau}, sample.torque_Nm);
    }
    if (cold_for_step == 0.0) {
        fit.add_prior(index_ln_tau, 0.0, 1.0);  // no row depends on it: any weight holds it at 0
    }
    return fit;
}

/// τ of least misfit, searched in its logarithm.
double best_time_constant_s(std::span<const IdleTorque> samples, double duration_s) {
    constexpr double shortest_in_durations = 1.0 / 20.0;
    constexpr double longest_in_durations = 5.0;
    constexpr int scan_steps = 24;  // each a factor of 1.2
    const auto misfit = [&](double ln_tau) {
        return squares_at(samples, std::exp(ln_tau), 0.0).residual_sum_of_squares();
    };
    return std::exp(place_of_minimum(misfit, std::log(duration_s * shortest_in_durations),
                                     std::log(duration_s * longest_in_durations), scan_steps));
}

}  // namespace

WarmUpFit fit_warm_up(std::span<const IdleTorque> samples) {
    WarmUpFit result;
    if (samples.size() < fewest_samples || !(samples.back().time_s > samples.front().time_s)) {
        result.lack = WarmUpLack::samples;
        return result;
    }
    result.duration_s = samples.back().time_s - samples.front().time_s;
    const double tau_s = best_time_constant_s(samples, result.duration_s);
    const auto at_tau = squares_at(samples, tau_s, 0.0).solve();
    const double cold_Nm = at_tau.parameters(index_cold);
    const auto solution = squares_at(samples, tau_s, cold_Nm).solve(largest_condition_of_last_fit);
    result.excess_Nm = cold_Nm;
    result.excess_se_Nm = solution.standard_error(index_cold);
    result.time_constant_s = tau_s;
    result.time_constant_se_s = tau_s * solution.standard_error(index_ln_tau);
    result.warm_Nm = solution.parameters(index_warm);
    result.warm_se_Nm = solution.standard_error(index_warm);
    result.residual_Nm = solution.residual_sd;
    const bool falls = cold_Nm > least_significance * at_tau.standard_error(index_cold);
    const bool bends = result.duration_s >= shortest_record_in_tau * tau_s &&
                       result.time_constant_se_s < largest_relative_error_of_tau * tau_s;
    result.lack = !falls ? WarmUpLack::excess : (!bends ? WarmUpLack::duration : WarmUpLack::nothing);
    return result;
}

}  // namespace millforce::estimation
