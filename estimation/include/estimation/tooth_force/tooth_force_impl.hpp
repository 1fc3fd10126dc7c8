// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/engagement/side_choice.hpp"
#include "estimation/number/elementary.hpp"
#include "estimation/tooth_force/tooth_force.hpp"

#include <cmath>

namespace millforce::estimation {

template <typename Scalar>
ToothForce<Scalar>::ToothForce(const CutEstimatorSettings<Scalar>& settings, const CuttingLaw<Scalar>& law)
    : teeth_(settings.teeth),
      cutter_radius_mm_(settings.cutter_radius_mm),
      feed_exponent_(Scalar(1) + law.p_s),
      load_is_held_(settings.load_is_held) {}

template <typename Scalar>
void ToothForce<Scalar>::fill(CutEstimate<Scalar>& e, const EngagementPeaks<Scalar>& peaks, const Table& table,
                              Scalar runout_mm) {
    using std::sqrt;
    const auto feed = table.feed(e.feed_per_tooth_mm);
    const auto model = table.forces(peaks.here_node(), feed);
    const bool has_model = model.tangential_N > Scalar(0) && e.feed_per_tooth_mm > Scalar(0);
    const Scalar per_model_N = has_model ? Scalar(1) / model.tangential_N : Scalar(0);
    e.cutting_share = has_model ? model.cutting_tangential_N * per_model_N : Scalar(1);
    e.feed_exponent = feed_exponent_;
    force_exponent_ = e.feed_exponent * e.cutting_share;
    e.runout_mm = runout_mm;
    if (!e.tangential_N.valid) {
        return;
    }
    e.runout_factor = runout_factor(e);
    const Scalar newest_N = follow_growth(e);
    estimate_tooth_force(e, peaks.factors(), newest_N);
    if (!has_model) {
        return;
    }
    const Scalar width_per_F_mm_N = peaks.now().radial_immersion * cutter_radius_mm_ * per_model_N;
    const Scalar averaged_out_N2 = e.tangential_N.variance - e.steady_tangential_N.variance;
    e.section_mm2 = e.steady_tangential_N.value * width_per_F_mm_N;
    e.section_noise_mm2 = sqrt(e.tangential_N.noise - averaged_out_N2) * width_per_F_mm_N;
    const Scalar now_N = model.tangential_N * peaks.factors().now;
    if (peaks.surge_is_wider()) {
        e.surge = change_to(table.forces(peaks.surge_node(), feed), peaks.factors().surge, now_N);
    }
    if (peaks.turn_is_wider()) {
        e.turn = change_to(table.forces(peaks.turn_node(), feed), peaks.factors().turn, now_N);
    }
}

/// F_at, and how fast it grows. Taken are the revolutions in which the cut stayed the same; the window or the last
/// tooth where these are higher, less what their noise may have added: else each of its peaks would lower the feed at
/// once. A tooth has risen by what it carries more than a revolution ago, but for what a higher feed has added: else
/// each rise of the override would be answered as a cut that grows. That some teeth carry more than others is runout,
/// which has its own factor: only what a tooth carries beyond that counts.
template <typename Scalar>
Scalar ToothForce<Scalar>::follow_growth(CutEstimate<Scalar>& e) const {
    using std::sqrt;
    constexpr Scalar clear_deviations{3};
    const auto higher = [](Scalar a, Scalar b) { return a > b ? a : b; };
    const Measurement<Scalar>& window = e.tangential_N;
    const Measurement<Scalar>& tooth = e.tooth_tangential_N;
    const Measurement<Scalar>& change = e.tooth_change.tangential_N;
    e.newest_tangential_N = higher(e.steady_tangential_N.value, window.value - sqrt(window.noise));
    if (!tooth.valid) {
        return e.newest_tangential_N;
    }
    const Scalar beyond_runout_N = (tooth.value - clear_deviations * sqrt(tooth.noise)) / e.runout_factor;
    e.newest_tangential_N = higher(e.newest_tangential_N, beyond_runout_N);
    const Scalar by_feed_N = force_exponent_ * e.tooth_change.feed_growth * tooth.value;
    const Scalar rise_N = change.value - by_feed_N - clear_deviations * sqrt(change.variance);
    if (change.valid && rise_N > Scalar(0)) {
        const Scalar above_window_N = tooth.value - window.value;
        e.newest_tangential_N =
            higher(e.newest_tangential_N, window.value + (rise_N < above_window_N ? rise_N : above_window_N));
        // A forecast multiplies the noise, and a load that comes seldom says nothing of one revolution.
        e.tangential_growth_N_per_s =
            load_is_held_ ? Scalar(0) : rise_N * turns_per_rad<Scalar> * e.spindle_speed_rad_s;
    }
    return e.newest_tangential_N;
}

template <typename Scalar>
void ToothForce<Scalar>::estimate_tooth_force(CutEstimate<Scalar>& e, const Factors& factors, Scalar newest_N) const {
    const EngagementEstimate<Scalar>& cut = e.engagement;
    const Scalar force_variance = e.steady_tangential_N.variance + square(e.tangential_gain_doubt * newest_N);
    const Scalar runout = e.runout_factor;
    e.worst_tooth_force_N = newest_N * factors.now * runout;
    // Of the widest cut, whose teeth share the load, or of the narrowest, whose long edge comes in bit by bit.
    e.certain_tooth_force_N = newest_N * (factors.at_low < factors.at_high ? factors.at_low : factors.at_high) * runout;
    e.least_tooth_force_N = newest_N * factors.slot;
    const auto bound_by = [&](Scalar bound) {
        const Scalar ratio = runout * (bound > factors.now ? bound : factors.now);
        e.tooth_force_N = {true, newest_N * ratio, square(ratio) * force_variance, Scalar(0)};
        e.tooth_force_is_bound = true;
    };
    if (cut.immersion_valid) {
        // At the narrow end of a wide interval the force is nearly the most that it can be: a quarter above the middle
        // of what the interval's ends give.
        constexpr Scalar nearly_the_most{1.25F};
        const Scalar of_middle = halved(factors.at_low + factors.at_high);
        e.tooth_force_is_bound = factors.now > nearly_the_most * of_middle;
        const Scalar factor_sd = (factors.at_low - factors.at_high) / width_of_95_percent<Scalar>;
        const Scalar by_factor = square(newest_N) * (square(factor_sd) + square(factors.by_K_s));
        e.tooth_force_N = {true, e.worst_tooth_force_N,
                           square(runout) * (square(factors.now) * force_variance + by_factor), Scalar(0)};
    } else if (cut.solved || (!e.x_N.valid && !e.y_N.valid) || e.tangential_gain_doubt > Scalar(0)) {
        // No estimate of the immersion, but a bound. Where even that is far from the limit, the force is known well
        // enough.
        bound_by(factors.bound);
    }
}

/// Where the chip of a mean tooth is thickest, f_z sin φ, the tooth with the largest radius takes e more.
template <typename Scalar>
Scalar ToothForce<Scalar>::runout_factor(const CutEstimate<Scalar>& e) const {
    using elementary::exp;
    using elementary::log;
    using std::sqrt;
    if (!(e.runout_mm > Scalar(0)) || !(e.feed_per_tooth_mm > Scalar(0))) {
        return Scalar(1);
    }
    const Scalar immersion = e.engagement.radial_immersion;
    const bool is_below_middle = e.engagement.immersion_valid && immersion < Scalar(1);
    const Scalar sine = is_below_middle ? sqrt(immersion * (Scalar(2) - immersion)) : Scalar(1);
    // One tooth cannot take more than the chips of all teeth together.
    const Scalar chip = clamp(Scalar(1) + e.runout_mm / (e.feed_per_tooth_mm * sine), Scalar(1), teeth_);
    return Scalar(1) + e.cutting_share * (exp(e.feed_exponent * log(chip)) - Scalar(1));
}

template <typename Scalar>
typename CutEstimate<Scalar>::Change ToothForce<Scalar>::change_to(const typename Table::Forces& forces_then,
                                                                   Scalar factor, Scalar tooth_N_per_mm_now) {
    return {forces_then.tangential_N * factor / tooth_N_per_mm_now,
            forces_then.cutting_tangential_N / forces_then.tangential_N};
}

}  // namespace millforce::estimation
