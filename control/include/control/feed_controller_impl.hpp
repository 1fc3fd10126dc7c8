// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of feed_controller.hpp. Only src/feed_controller.cpp includes them.

#include "control/feed_controller.hpp"
#include "estimation/number/finite.hpp"

namespace millforce::control {

template <typename Scalar>
static bool is_positive(Scalar value) {
    return estimation::is_finite(value) && value > Scalar(0);
}

template <typename Scalar>
static bool is_not_negative(Scalar value) {
    return estimation::is_finite(value) && value >= Scalar(0);
}

template <typename Scalar>
static bool is_sound(const FeedControllerParameters<Scalar>& p) {
    using estimation::is_finite;
    constexpr Scalar absurd_override = Scalar(10);  // a percentage was meant
    return is_positive(p.tooth_force_limit_N) && is_positive(p.setpoint_share) && is_not_negative(p.caution_sd) &&
           is_not_negative(p.override_min) && is_finite(p.override_max) && p.override_max > p.override_min &&
           p.override_max < absurd_override && is_positive(p.recovery_per_rev) && is_positive(p.slew_up_per_s) &&
           is_positive(p.slew_down_per_s) && is_positive(p.entry_feed_per_tooth_mm) &&
           is_positive(p.air_feed_per_tooth_mm) && is_positive(p.max_feed_per_tooth_mm) &&
           is_not_negative(p.highest_programmed_feed_mm_s) && is_not_negative(p.entry_revolutions) &&
           is_not_negative(p.entry_travel_mm) && is_not_negative(p.exit_travel_mm) && is_positive(p.contact_force_N) &&
           is_not_negative(p.contact_significance) && is_not_negative(p.surge_radial_immersion) &&
           is_positive(p.surge_share) && is_finite(p.depth_step_ratio) && p.depth_step_ratio >= Scalar(1) &&
           is_positive(p.depth_step_share) && is_not_negative(p.proven_override) && is_not_negative(p.safe_override) &&
           is_not_negative(p.turn_radial_immersion) && is_not_negative(p.turn_travel_mm) &&
           is_positive(p.overload_share) && is_not_negative(p.overload_revolutions) && is_not_negative(p.reaction_s) &&
           is_not_negative(p.no_estimate_hold_s) && is_not_negative(p.Ra_limit_um) && is_positive(p.stale_s) &&
           is_finite(p.teeth) && p.teeth >= Scalar(1);
}

template <typename Scalar>
FeedController<Scalar>::FeedController(const Parameters& parameters)
    : parameters_(parameters), law_(parameters.override_min) {
    if (!is_sound(parameters)) {
        states_.enter_fault(Fault::bad_configuration);
        parameters_.override_min = Scalar(0);
        parameters_.override_max = Scalar(0);
        law_ = FeedLaw<Scalar>(Scalar(0));
    }
}

template <typename Scalar>
void FeedController<Scalar>::reset() {
    *this = FeedController(parameters_);  // refused parameters have been left with a range that is refused as well
    if (states_.state() != CutState::fault) {
        states_.resume();
    }
}

template <typename Scalar>
ControlOutput<Scalar> FeedController<Scalar>::step(const ControlInput<Scalar>& input) {
    if (input.rapid || is_known(input.programmed_feed_mm_s)) {
        return step_at_feed(input);
    }
    ControlInput<Scalar> at_highest_feed = input;
    at_highest_feed.programmed_feed_mm_s = ceilings_.highest_programmed_feed_mm_s();
    at_highest_feed.feed_is_assumed = true;
    return step_at_feed(at_highest_feed);
}

template <typename Scalar>
ControlOutput<Scalar> FeedController<Scalar>::step_at_feed(const ControlInput<Scalar>& input) {
    const StepMotion<Scalar> motion = motion_of(input);
    const CutState last_state = states_.state();
    states_.step(parameters_, input, motion);
    spindle_.follow(input.cut, states_.state(), motion.dt_s);
    if (spindle_.stalls() && motion.path_speed_mm_s > Scalar(0)) {
        states_.enter_fault(Fault::spindle_stopped);
    }
    if (states_.state() != last_state) {
        ceilings_.enter_state(law_.override_ratio());
    }
    const Ceiling<Scalar> lowest = wanted(input, motion);
    limit_ = lowest.limit;
    law_.approach(parameters_, input, motion, states_.state(), lowest.override_ratio);
    return output_of(input);
}

template <typename Scalar>
StepMotion<Scalar> FeedController<Scalar>::motion_of(const ControlInput<Scalar>& input) {
    constexpr Scalar longest_step_s = Scalar(1);  // of a controller that still runs
    StepMotion<Scalar> motion;
    motion.dt_s = input.dt_s > Scalar(0) && input.dt_s < longest_step_s ? input.dt_s : Scalar(0);
    motion.path_speed_mm_s = estimation::is_finite(input.path_speed_mm_s) ? input.path_speed_mm_s : Scalar(0);
    motion.travel_mm = motion.path_speed_mm_s * motion.dt_s;
    motion.tooth_period_s = tooth_period_s(parameters_.teeth, input.cut.spindle_speed_rad_s);
    motion.turned =
        turn_.update({motion.dt_s, input.velocity_x_mm_s, input.velocity_y_mm_s, motion.path_speed_mm_s,
                      motion.travel_mm, law_.override_ratio(), input.programmed_feed_mm_s, motion.tooth_period_s});
    return motion;
}

template <typename Scalar>
Ceiling<Scalar> FeedController<Scalar>::wanted(const ControlInput<Scalar>& input, const StepMotion<Scalar>& motion) {
    if (states_.state() == CutState::fault) {
        return {parameters_.override_min, limit_};
    }
    contact_feed_.follow(input, motion.dt_s);
    if (feed_and_speed_are_known(input)) {
        follow_law(input);
    }
    const typename Ceilings<Scalar>::Situation situation{states_.state(),
                                                         states_.has_cut(),
                                                         law_.override_ratio(),
                                                         law_.demand(),
                                                         contact_feed_.feed_per_tooth_mm(),
                                                         spindle_.is_slow(),
                                                         spindle_.largest_tangential_N()};
    ceilings_.follow(parameters_, input, motion, situation);
    return ceilings_.lowest(parameters_, input, situation);
}

template <typename Scalar>
void FeedController<Scalar>::follow_law(const ControlInput<Scalar>& input) {
    if (input.cut.fresh && states_.state() == CutState::in_cut && !ceilings_.is_fading()) {
        contact_feed_.learn(parameters_, input);
    }
    law_.follow(parameters_, input, states_.state(), contact_feed_.feed_per_tooth_mm());
}

template <typename Scalar>
ControlOutput<Scalar> FeedController<Scalar>::output_of(const ControlInput<Scalar>& input) const {
    const bool has_failed = states_.state() == CutState::fault;
    ControlOutput<Scalar> output;
    output.state = states_.state();
    output.fault = states_.fault();
    output.limit = limit_;
    output.fading = ceilings_.is_fading();
    output.hold = has_failed || input.feed_hold || (states_.is_blind() && !input.rapid && !parameters_.monitor_only);
    output.ratio =
        parameters_.monitor_only && !has_failed ? bounded(parameters_, input.operator_override) : law_.override_ratio();
    return output;
}

}  // namespace millforce::control
