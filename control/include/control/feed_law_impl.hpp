// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of feed_law.hpp. Only src/feed_law.cpp includes them.

#include "control/feed_law.hpp"
#include "estimation/number/elementary.hpp"
#include "estimation/number/finite.hpp"

namespace millforce::control {

template <typename Scalar>
bool FeedLaw<Scalar>::applies_to(const Estimate& cut) {
    using estimation::is_finite;
    return cut.force_valid && cut.tooth_force_N > Scalar(0) && cut.feed_mm_s > Scalar(0) &&
           cut.feed_exponent > Scalar(0) && is_finite(cut.tooth_force_N) && is_finite(cut.feed_mm_s) &&
           is_finite(cut.feed_exponent) && is_finite(cut.cutting_share) && is_finite(cut.surge_ratio) &&
           is_finite(cut.surge_cutting_share);
}

template <typename Scalar>
bool FeedLaw<Scalar>::knows_turn(const Estimate& cut) {
    return applies_to(cut) && estimation::is_finite(cut.turn_ratio) && estimation::is_finite(cut.turn_cutting_share);
}

template <typename Scalar>
Scalar FeedLaw<Scalar>::override_for(const Parameters& parameters, const ControlInput<Scalar>& input, Target target) {
    using estimation::elementary::exp;
    using estimation::elementary::log;
    // Where nearly all is edge force the feed hardly matters, and 1/c would make a great feed of a small error of F.
    constexpr Scalar least_cutting_share = literal<Scalar>(0.05L);
    const Scalar c = target.cutting_share > least_cutting_share ? target.cutting_share : least_cutting_share;
    const Scalar target_N = target.share_of_limit * parameters.tooth_force_limit_N;
    const Scalar growth = (target_N / target.force_N - (Scalar(1) - c)) / c;  // (f*/f)^(1+p_s)
    if (!(growth > Scalar(0))) {
        return Scalar(0);
    }
    return input.cut.feed_mm_s * exp(log(growth) / input.cut.feed_exponent) / input.programmed_feed_mm_s;
}

template <typename Scalar>
void FeedLaw<Scalar>::follow(const Parameters& parameters, const ControlInput<Scalar>& input, CutState state,
                             Scalar contact_feed_mm) {
    const Estimate& cut = input.cut;
    if (is_out_of_cut(state)) {
        demand_ = parameters.override_max;
        speed_of_demand_rad_s_ = Scalar(0);
        return;
    }
    if (!cut.fresh || !applies_to(cut)) {
        slow_down_with(cut.spindle_speed_rad_s);
        return;
    }
    speed_of_demand_rad_s_ = cut.spindle_speed_rad_s;
    const Scalar share = input.way.known ? parameters.setpoint_share : share_before_a_step(parameters);
    demand_ = override_for(parameters, input, {share, cut.tooth_force_N, cut.cutting_share});
    if (state == CutState::entry) {
        const SafeFeed contact{safe_contact(parameters, input, contact_feed_mm), cut.least_tooth_force_N};
        demand_ = not_below_safe_feed(parameters, input, demand_, contact);
        return;
    }
    const bool guards = guards_against_a_step(parameters, input);
    if (cut.tooth_force_is_bound) {
        const bool is_safe = parameters.safe_override > parameters.proven_override;
        const Scalar steady = is_safe ? parameters.safe_override : parameters.proven_override;
        demand_ = not_below_safe_feed(parameters, input, demand_, {steady, cut.least_tooth_force_N});
    } else if (guards) {
        demand_ = not_below_safe_feed(parameters, input, demand_, {safe_entry(parameters, input), cut.tooth_force_N});
    }
    if (guards) {
        const Scalar of_heaviest = override_before_heaviest(parameters, input, contact_feed_mm);
        demand_ = demand_ < of_heaviest ? demand_ : of_heaviest;
    }
}

template <typename Scalar>
void FeedLaw<Scalar>::slow_down_with(Scalar spindle_speed_rad_s) {
    constexpr Scalar tolerated_share = literal<Scalar>(0.95L);
    if (spindle_speed_rad_s < tolerated_share * speed_of_demand_rad_s_) {
        const Scalar share = spindle_speed_rad_s / speed_of_demand_rad_s_;
        demand_ = share > Scalar(0) ? share * demand_ : Scalar(0);
        speed_of_demand_rad_s_ = spindle_speed_rad_s;
    }
}

/// At the contact feed a step from the heaviest cut of the program is survived, so at depth_step_ratio times that feed
/// a step to the heaviest cut is: no force grows faster than the feed.
template <typename Scalar>
Scalar FeedLaw<Scalar>::override_before_heaviest(const Parameters& parameters, const ControlInput<Scalar>& input,
                                                 Scalar contact_feed_mm) {
    if (!(contact_feed_mm > Scalar(0))) {
        return parameters.override_max;
    }
    const Scalar of_heaviest =
        parameters.depth_step_ratio * override_of_feed_per_tooth(contact_feed_mm, parameters.teeth, input);
    const Scalar entry = safe_entry(parameters, input);
    return of_heaviest > entry ? of_heaviest : entry;
}

template <typename Scalar>
bool FeedLaw<Scalar>::guards_against_a_step(const Parameters& parameters, const ControlInput<Scalar>& input) {
    return !input.way.known && share_before_a_step(parameters) < parameters.setpoint_share;
}

template <typename Scalar>
Scalar FeedLaw<Scalar>::share_before_a_step(const Parameters& parameters) {
    return parameters.depth_step_share < parameters.setpoint_share * parameters.depth_step_ratio
               ? parameters.depth_step_share / parameters.depth_step_ratio
               : parameters.setpoint_share;
}

/// The arc of a cutter that enters follows no law, an unknown immersion allows any tooth force, and a step of the depth
/// need not come. None of these pushes the demand below a feed that is safe at contact; only a force that is present
/// can.
template <typename Scalar>
Scalar FeedLaw<Scalar>::not_below_safe_feed(const Parameters& parameters, const ControlInput<Scalar>& input,
                                            Scalar demand, SafeFeed safe) {
    if (!(demand < safe.override_ratio)) {
        return demand;
    }
    if (!(safe.present_force_N > Scalar(0))) {
        return safe.override_ratio;
    }
    const Scalar certain =
        override_for(parameters, input, {parameters.setpoint_share, safe.present_force_N, input.cut.cutting_share});
    const Scalar floor = safe.override_ratio < certain ? safe.override_ratio : certain;
    return demand > floor ? demand : floor;
}

template <typename Scalar>
void FeedLaw<Scalar>::approach(const Parameters& parameters, const ControlInput<Scalar>& input,
                               const StepMotion<Scalar>& motion, CutState state, Scalar wanted) {
    since_estimate_s_ = input.cut.fresh ? Scalar(0) : since_estimate_s_ + motion.dt_s;
    if (wanted < override_ratio_) {
        const Scalar lowest = override_ratio_ - parameters.slew_down_per_s * motion.dt_s;
        override_ratio_ = bounded(parameters, wanted < lowest ? lowest : wanted);
        return;
    }
    const Scalar revolution_s = parameters.teeth * motion.tooth_period_s;
    if (is_cutting(state) && since_estimate_s_ > revolution_s) {
        return;
    }
    const Scalar share = is_cutting(state) ? recovery_in(parameters, input, motion) : Scalar(1);
    const Scalar distance = wanted - override_ratio_;
    const Scalar rise = share < Scalar(1) ? distance * share : distance;
    const Scalar highest_rise = parameters.slew_up_per_s * motion.dt_s;
    const bool is_too_fast = rise > highest_rise && !input.way.known;
    override_ratio_ = bounded(parameters, override_ratio_ + (is_too_fast ? highest_rise : rise));
}

/// The share of the way up that this step's part of a revolution goes; 0 for a spindle that turns backwards.
template <typename Scalar>
Scalar FeedLaw<Scalar>::recovery_in(const Parameters& parameters, const ControlInput<Scalar>& input,
                                    const StepMotion<Scalar>& motion) {
    const Scalar per_rad = parameters.recovery_per_rev * estimation::turns_per_rad<Scalar>;
    const Scalar share = per_rad * input.cut.spindle_speed_rad_s * motion.dt_s;
    return share > Scalar(0) ? share : Scalar(0);
}

}  // namespace millforce::control
