// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/spindle_fit.hpp"

#include "least_squares_in_double.hpp"
#include "minimum_search.hpp"

#include <algorithm>

namespace millforce::estimation {

namespace {

using SpindleSquares = LeastSquares<double, spindle_parameter_count>;

/// A parameter that no row depends on: a prior of any weight holds it at 0 and changes nothing else.
void hold_at_zero(SpindleSquares& fit, int parameter) {
    fit.add_prior(parameter, 0.0, 1.0);
}

/// The fit for a given base speed. Its last parameter is a step of the base speed from there, which is 0 at the best
/// base speed and is fitted only for its standard error. `K_t1_for_step` 0: the base speed is held.
SpindleSquares squares_at(std::span<const SpindleSample> samples, SpindleFitTerms terms, double base_speed_rad_s,
                          double K_t1_for_step) {
    SpindleSquares fit;
    for (const SpindleSample& sample : samples) {
        const double gain = field_weakening_gain(base_speed_rad_s, sample.speed_rad_s);
        const double torque_per_base_speed =
            gain < 1.0 ? K_t1_for_step * sample.current_A / sample.speed_rad_s : 0.0;  // ∂T/∂ω_b
        SpindleSquares::Vector row;
        row << gain * sample.current_A, terms.idle_torque ? 1.0 : 0.0, terms.idle_slope ? -sample.speed_rad_s : 0.0,
            terms.inertia ? -sample.acceleration_rad_s2 : 0.0, torque_per_base_speed;
        fit.add(row, sample.torque_Nm);
    }
    if (!terms.idle_torque) {
        hold_at_zero(fit, spindle_K_t2);
    }
    if (!terms.idle_slope) {
        hold_at_zero(fit, spindle_idle_slope);
    }
    if (!terms.inertia) {
        hold_at_zero(fit, spindle_inertia);
    }
    if (!(K_t1_for_step > 0.0)) {
        hold_at_zero(fit, spindle_base_speed);
    }
    return fit;
}

}  // namespace

double field_weakening_gain(double base_speed_rad_s, double speed_rad_s) {
    return base_speed_rad_s > 0.0 && speed_rad_s > base_speed_rad_s ? base_speed_rad_s / speed_rad_s : 1.0;
}

SpindleFit fit_spindle(std::span<const SpindleSample> samples, SpindleFitTerms terms, double significance) {
    constexpr int scan_steps = 48;    // over the speeds of the samples
    constexpr int always_fitted = 2;  // K_t1, ω_b

    SpindleFit result;
    const SpindleSquares constant = squares_at(samples, terms, 0.0, 0.0);
    result.solution = constant.solve();
    if (!terms.field_weakening || samples.empty()) {
        return result;
    }
    const auto [slowest, fastest] = std::ranges::minmax(samples, {}, &SpindleSample::speed_rad_s);
    const auto squares_of = [&](double rad_s) { return squares_at(samples, terms, rad_s, 0.0); };
    const double best_rad_s =
        place_of_minimum([&](double rad_s) { return squares_of(rad_s).residual_sum_of_squares(); }, slowest.speed_rad_s,
                         fastest.speed_rad_s, scan_steps);
    const SpindleSquares weakened = squares_of(best_rad_s);
    const int free_rows = weakened.rows() - always_fitted - static_cast<int>(terms.idle_torque) -
                          static_cast<int>(terms.idle_slope) - static_cast<int>(terms.inertia);
    const auto is_beaten = [&](const SpindleSquares& other) {
        const double gain = other.residual_sum_of_squares() - weakened.residual_sum_of_squares();
        return free_rows >= 1 && gain * free_rows > significance * weakened.residual_sum_of_squares();
    };
    if (!is_beaten(constant)) {
        return result;
    }
    const SpindleSquares from_slowest = squares_of(slowest.speed_rad_s);
    result.nothing_below_base_speed = !is_beaten(from_slowest);
    const double base_speed = result.nothing_below_base_speed ? slowest.speed_rad_s : best_rad_s;
    const double K_t1_for_step = result.nothing_below_base_speed ? 0.0 : weakened.solve().parameters(spindle_K_t1);
    result.solution = squares_at(samples, terms, base_speed, K_t1_for_step).solve();
    result.solution.parameters(spindle_base_speed) = base_speed;
    return result;
}

}  // namespace millforce::estimation
