// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of cut_states.hpp. Only src/cut_states.cpp includes them.

#include "control/cut_states.hpp"
#include "estimation/number/finite.hpp"

namespace millforce::control {

template <typename Scalar>
static bool is_in_contact(const FeedControllerParameters<Scalar>& parameters,
                          const CutEstimateForControl<Scalar>& cut) {
    return cut.force_valid && cut.tangential_N > contact_level_N(parameters, cut.tangential_sd_N);
}

template <typename Scalar>
static bool has_lost_contact(const FeedControllerParameters<Scalar>& parameters,
                             const CutEstimateForControl<Scalar>& cut) {
    constexpr Scalar hysteresis = Scalar(0.5F);  // a force at the contact level must not toggle the state
    return cut.force_valid && cut.tangential_N < hysteresis * contact_level_N(parameters, cut.tangential_sd_N);
}

template <typename Scalar>
void CutStates<Scalar>::step(const Parameters& parameters, const ControlInput<Scalar>& input,
                             const StepMotion<Scalar>& motion) {
    watch_input(parameters, input);
    watch_spindle(parameters, input, motion);
    watch_overload(parameters, input.cut);
    if (state_ == CutState::fault) {
        return;
    }
    travel_in_state_mm_ += motion.travel_mm;
    watch_force(input, motion);
    if (input.cut.fresh) {
        follow_contact(parameters, input);
    }
    if (lacks_estimate(parameters)) {
        go_to(CutState::hold);
        is_blind_ = true;
    } else if (input.feed_hold) {
        const bool stops_in_cut = state_ == CutState::in_cut;
        go_to(CutState::hold);
        may_stand_in_cut_ = may_stand_in_cut_ || stops_in_cut;
        travel_in_state_mm_ = Scalar(0);
    }
    watch_rest(input, motion);
    if (motion.turned && state_ == CutState::exit) {
        go_to(CutState::air);  // what was cut before the turn says nothing about what lies ahead now
    }
}

template <typename Scalar>
void CutStates<Scalar>::follow_contact(const Parameters& parameters, const ControlInput<Scalar>& input) {
    const bool contact = is_in_contact(parameters, input.cut);
    const bool lost = has_lost_contact(parameters, input.cut);
    tooth_periods_in_state_ += input.cut.tooth_periods;
    switch (state_) {
        case CutState::air:
            // For one tooth the current of a spindle that begins to run up looks like a cut.
            if (contact && was_in_contact_) {
                go_to(CutState::entry);
            }
            break;
        case CutState::entry:
            if (lost) {
                go_to(CutState::exit);
            } else if (has_entered(parameters)) {
                go_to(CutState::in_cut);
            }
            break;
        case CutState::in_cut:
            if (lost) {
                go_to(CutState::exit);
            }
            break;
        case CutState::exit:
            if (contact) {
                go_to(CutState::entry);
            } else if (input.cut.force_valid && travel_in_state_mm_ > parameters.exit_travel_mm) {
                go_to(CutState::air);
            }
            break;
        case CutState::hold:
            leave_hold(parameters, input, contact);
            break;
        case CutState::fault:
            break;
    }
    was_in_contact_ = contact;
}

/// A tool that stands in its cut shows no contact until the axes feed again.
template <typename Scalar>
void CutStates<Scalar>::leave_hold(const Parameters& parameters, const ControlInput<Scalar>& input, bool contact) {
    if (!input.cut.force_valid || input.feed_hold) {
        return;
    }
    is_blind_ = false;
    if (contact) {
        go_to(may_stand_in_cut_ ? CutState::in_cut : CutState::entry);
    } else if (!may_stand_in_cut_ || travel_in_state_mm_ > parameters.exit_travel_mm) {
        go_to(CutState::exit);
    }
}

template <typename Scalar>
bool CutStates<Scalar>::has_entered(const Parameters& parameters) const {
    return tooth_periods_in_state_ >= parameters.entry_revolutions * parameters.teeth &&
           travel_in_state_mm_ >= parameters.entry_travel_mm;
}

template <typename Scalar>
void CutStates<Scalar>::watch_force(const ControlInput<Scalar>& input, const StepMotion<Scalar>& motion) {
    without_force_s_ = input.cut.force_valid ? Scalar(0) : without_force_s_ + motion.dt_s;
    const bool may_meet_the_workpiece = !input.rapid && !input.feed_hold && !input.cut.spindle_does_not_mill;
    if (input.cut.force_valid || !may_meet_the_workpiece) {
        fed_without_force_mm_ = Scalar(0);
        return;
    }
    const bool moves_as_programmed = input.motion_is_unseen && is_known(input.programmed_feed_mm_s);
    fed_without_force_mm_ += moves_as_programmed ? input.programmed_feed_mm_s * motion.dt_s : motion.travel_mm;
}

template <typename Scalar>
bool CutStates<Scalar>::lacks_estimate(const Parameters& parameters) const {
    const bool may_be_in_air = is_out_of_cut(state_) || state_ == CutState::hold;
    return (is_cutting(state_) && without_force_s_ > parameters.no_estimate_hold_s) ||
           (may_be_in_air && fed_without_force_mm_ > parameters.exit_travel_mm);
}

template <typename Scalar>
void CutStates<Scalar>::go_to(CutState state) {
    if (state == state_) {
        return;
    }
    is_blind_ = false;
    may_stand_in_cut_ = false;
    has_cut_ = state == CutState::in_cut || (has_cut_ && state != CutState::air);
    state_ = state;
    travel_in_state_mm_ = Scalar(0);
    tooth_periods_in_state_ = Scalar(0);
}

template <typename Scalar>
void CutStates<Scalar>::enter_fault(Fault fault) {
    if (state_ != CutState::fault) {
        fault_ = fault;
        state_ = CutState::fault;
    }
}

template <typename Scalar>
void CutStates<Scalar>::resume() {
    *this = {};
    state_ = CutState::hold;
    may_stand_in_cut_ = true;
}

template <typename Scalar>
void CutStates<Scalar>::watch_input(const Parameters& parameters, const ControlInput<Scalar>& input) {
    if (!estimation::is_finite(input.time_since_sample_s) || input.time_since_sample_s > parameters.stale_s) {
        enter_fault(Fault::stale_input);
    }
    if (input.implausible != Fault::none) {
        enter_fault(input.implausible);
    }
}

template <typename Scalar>
void CutStates<Scalar>::watch_spindle(const Parameters& parameters, const ControlInput<Scalar>& input,
                                      const StepMotion<Scalar>& motion) {
    const bool cuts = is_cutting(state_) || input.cut.spindle_loaded_at_rest;
    const bool rubs = cuts && !input.cut.spindle_turning && motion.path_speed_mm_s > Scalar(0);
    spindle_at_rest_s_ = rubs ? spindle_at_rest_s_ + motion.dt_s : Scalar(0);
    if (spindle_at_rest_s_ > parameters.stale_s) {
        enter_fault(Fault::spindle_stopped);
    }
}

/// Spindle and axes have stood for so long that the cut is over: what comes next may be a move without the spindle.
template <typename Scalar>
void CutStates<Scalar>::watch_rest(const ControlInput<Scalar>& input, const StepMotion<Scalar>& motion) {
    constexpr Scalar cut_is_over_s = Scalar(2);
    const bool rests = !input.cut.spindle_turning && !(motion.path_speed_mm_s > Scalar(0));
    at_rest_s_ = rests ? at_rest_s_ + motion.dt_s : Scalar(0);
    if (state_ == CutState::hold && !input.feed_hold && !(at_rest_s_ < cut_is_over_s)) {
        go_to(CutState::air);
    }
}

template <typename Scalar>
void CutStates<Scalar>::watch_overload(const Parameters& parameters, const Estimate& cut) {
    if (!cut.fresh || parameters.monitor_only) {
        return;
    }
    const bool is_estimate = cut.force_valid && cut.tooth_force_valid && !cut.tooth_force_is_bound;
    const Scalar most_N = parameters.overload_share * parameters.tooth_force_limit_N;
    const bool over = is_estimate && cut.certain_tooth_force_N > most_N;  // what is forecast or only possible is none
    if (!over) {
        overload_tooth_periods_ = Scalar(0);
        return;
    }
    // An estimate is that of one revolution, however long ago the last one was.
    overload_tooth_periods_ += cut.tooth_periods < parameters.teeth ? cut.tooth_periods : parameters.teeth;
    const Scalar until_feed_falls =
        is_known(cut.spindle_speed_rad_s)
            ? parameters.reaction_s * cut.spindle_speed_rad_s * estimation::turns_per_rad<Scalar>
            : Scalar(0);
    if (overload_tooth_periods_ > (parameters.overload_revolutions + until_feed_falls) * parameters.teeth) {
        enter_fault(Fault::overload);
    }
}

}  // namespace millforce::control
