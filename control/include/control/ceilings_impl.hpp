// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of ceilings.hpp. Only src/ceilings.cpp includes them.

#include "control/ceilings.hpp"
#include "control/feed_law.hpp"
#include "estimation/number/finite.hpp"

namespace millforce::control {

template <typename Scalar>
static bool predicts_a_ceiling(const SurfaceForControl<Scalar>& surface) {
    return surface.valid && is_known(surface.feed_ceiling_mm_s);
}

// ---- Following -------------------------------------------------------------------------------------------------

template <typename Scalar>
void Ceilings<Scalar>::follow(const Parameters& parameters, const ControlInput<Scalar>& input,
                              const StepMotion<Scalar>& motion, const Situation& situation) {
    follow_program(parameters, input);
    travel_since_estimate_mm_ += motion.travel_mm;
    turn_travel_left_mm_ = motion.turned ? parameters.turn_travel_mm : turn_travel_left_mm_ - motion.travel_mm;
    if (!feed_and_speed_are_known(input)) {
        return;
    }
    if (is_out_of_cut(situation.state)) {
        surge_ceiling_ = parameters.override_max;
        surface_ceiling_ = parameters.override_max;
        spindle_ceiling_ = parameters.override_max;
        override_before_fade_ = Scalar(0);
        trend_.clear();
        return;
    }
    follow_surge(parameters, input, situation);
    follow_turn(parameters, input, motion.turned);
    follow_surface(input);
    follow_spindle(parameters, input, situation);
}

template <typename Scalar>
void Ceilings<Scalar>::follow_program(const Parameters& parameters, const ControlInput<Scalar>& input) {
    const auto raise_to = [this](Scalar feed_mm_s) {
        highest_programmed_feed_mm_s_ =
            feed_mm_s > highest_programmed_feed_mm_s_ ? feed_mm_s : highest_programmed_feed_mm_s_;
    };
    raise_to(parameters.highest_programmed_feed_mm_s);
    if (is_known(input.programmed_feed_mm_s) && !input.rapid) {
        raise_to(input.programmed_feed_mm_s);
    }
    tells_feed_of_rapids_ = tells_feed_of_rapids_ || (input.rapid && is_known(input.programmed_feed_mm_s) &&
                                                      input.programmed_feed_mm_s > highest_programmed_feed_mm_s_);
}

template <typename Scalar>
bool Ceilings<Scalar>::runs_free(const ControlInput<Scalar>& input, CutState state) const {
    const bool is_fast =
        !is_known(input.programmed_feed_mm_s) || input.programmed_feed_mm_s > highest_programmed_feed_mm_s_;
    return input.rapid && state != CutState::entry && (is_fast || !tells_feed_of_rapids_);
}

template <typename Scalar>
void Ceilings<Scalar>::follow_surge(const Parameters& parameters, const ControlInput<Scalar>& input,
                                    const Situation& situation) {
    const CutEstimateForControl<Scalar>& cut = input.cut;
    if (!cut.fresh) {
        return;
    }
    if (FeedLaw<Scalar>::applies_to(cut)) {
        surge_ceiling_ = ceiling_of_surge(parameters, input);
        trend_.update(cut.section_mm2, cut.section_noise_mm2, travel_since_estimate_mm_);
        travel_since_estimate_mm_ = Scalar(0);
        if (situation.state != CutState::in_cut) {
            trend_.forget_growth();  // an entry has its own ceiling
        }
    }
    if (!surge_is_under_way(parameters)) {
        override_before_growth_ = situation.override_ratio;
    }
    if (!trend_.fading()) {
        constexpr Scalar share_per_estimate = Scalar(0.125F);  // a dip as the fade begins hardly counts
        const Scalar fallen = override_before_fade_ - situation.override_ratio;
        override_before_fade_ -= fallen > Scalar(0) ? share_per_estimate * fallen : fallen;
    }
}

/// From an immersion that is not known a surge may be of any size: then the feed is that of an entry.
template <typename Scalar>
Scalar Ceilings<Scalar>::ceiling_of_surge(const Parameters& parameters, const ControlInput<Scalar>& input) {
    const CutEstimateForControl<Scalar>& cut = input.cut;
    if (!(parameters.surge_radial_immersion > Scalar(0))) {
        return parameters.override_max;
    }
    if (cut.tooth_force_is_bound) {
        return safe_entry(parameters, input);
    }
    return cut.surge_ratio > Scalar(1)
               ? FeedLaw<Scalar>::override_for(
                     parameters, input,
                     {parameters.surge_share, cut.tooth_force_N * cut.surge_ratio, cut.surge_cutting_share})
               : parameters.override_max;
}

template <typename Scalar>
void Ceilings<Scalar>::follow_turn(const Parameters& parameters, const ControlInput<Scalar>& input, bool turned) {
    const CutEstimateForControl<Scalar>& cut = input.cut;
    if (!(turn_travel_left_mm_ > Scalar(0)) || !(parameters.turn_radial_immersion > Scalar(0))) {
        turn_ceiling_ = parameters.override_max;
        return;
    }
    if (FeedLaw<Scalar>::knows_turn(cut) && (turned || cut.fresh)) {
        turn_ceiling_ = cut.turn_ratio > Scalar(1)
                            ? FeedLaw<Scalar>::override_for(
                                  parameters, input,
                                  {parameters.surge_share, cut.tooth_force_N * cut.turn_ratio, cut.turn_cutting_share})
                            : parameters.override_max;
    }
}

/// Outside the range of the model's tests its ceiling may fall but not rise.
template <typename Scalar>
void Ceilings<Scalar>::follow_surface(const ControlInput<Scalar>& input) {
    const SurfaceForControl<Scalar>& surface = input.surface;
    if (input.cut.fresh && predicts_a_ceiling(surface)) {
        const Scalar ceiling = surface.feed_ceiling_mm_s / input.programmed_feed_mm_s;
        surface_ceiling_ = surface.in_range || ceiling < surface_ceiling_ ? ceiling : surface_ceiling_;
    }
}

template <typename Scalar>
void Ceilings<Scalar>::follow_spindle(const Parameters& parameters, const ControlInput<Scalar>& input,
                                      const Situation& situation) {
    const CutEstimateForControl<Scalar>& cut = input.cut;
    const Scalar largest_N = situation.largest_tangential_N;
    if (situation.spindle_is_slow) {
        spindle_ceiling_ = parameters.override_min;
    } else if (!(largest_N > Scalar(0))) {
        spindle_ceiling_ = parameters.override_max;
    } else if (cut.fresh && FeedLaw<Scalar>::applies_to(cut)) {
        const Scalar share = cut.tangential_N / largest_N;
        spindle_ceiling_ =
            share > Scalar(0)
                ? FeedLaw<Scalar>::override_for(parameters, input,
                                                {Scalar(1), share * parameters.tooth_force_limit_N, cut.cutting_share})
                : parameters.override_max;
    }
}

// ---- The lowest ------------------------------------------------------------------------------------------------

template <typename Scalar>
Ceiling<Scalar> Ceilings<Scalar>::lowest(const Parameters& parameters, const ControlInput<Scalar>& input,
                                         const Situation& situation) const {
    Ceiling<Scalar> lowest = runs_free(input, situation.state) ? Ceiling<Scalar>{Scalar(1), Limit::none}
                                                               : lowest_in_feed(parameters, input, situation);
    if (situation.state == CutState::hold) {
        lowest.lower_to(situation.override_ratio, Limit::no_estimate);
    }
    if (!estimation::is_finite(input.operator_override)) {
        lowest.lower_to(Scalar(0), Limit::operator_limit);
    } else if (input.operator_override < Scalar(1)) {
        lowest.lower_to(input.operator_override, Limit::operator_limit);
    }
    const bool says_why = lowest.limit == Limit::operator_limit || lowest.limit == Limit::no_estimate;
    if (lowest.override_ratio <= parameters.override_min && !says_why) {
        lowest.limit = may_exceed_the_limit(parameters, input.cut) && is_cutting(situation.state)
                           ? Limit::force_at_minimum
                           : Limit::override_min;
    }
    lowest.override_ratio = bounded(parameters, lowest.override_ratio);
    return lowest;
}

template <typename Scalar>
bool Ceilings<Scalar>::may_exceed_the_limit(const Parameters& parameters, const CutEstimateForControl<Scalar>& cut) {
    return FeedLaw<Scalar>::applies_to(cut) && cut.tooth_force_valid && !cut.tooth_force_is_bound &&
           cut.tooth_force_N > parameters.tooth_force_limit_N;
}

/// The present override comes last, so it is reported as the limit only if it is lower than every other ceiling.
template <typename Scalar>
Ceiling<Scalar> Ceilings<Scalar>::lowest_in_feed(const Parameters& parameters, const ControlInput<Scalar>& input,
                                                 const Situation& situation) const {
    Ceiling<Scalar> lowest{parameters.override_max, Limit::override_max};
    const bool is_fed_blind =
        is_out_of_cut(situation.state) && !input.cut.force_valid && !input.cut.spindle_does_not_mill;
    if (is_fed_blind) {
        lowest.lower_to(parameters.override_min, Limit::no_estimate);
    }
    if (input.way.known && is_known(input.programmed_feed_mm_s)) {
        lowest.lower_to(input.way.feed_mm_s / input.programmed_feed_mm_s, Limit::way_ahead);
    }
    if (is_out_of_cut(situation.state) && !is_known(input.programmed_feed_mm_s)) {
        lowest.lower_to(parameters.override_min, Limit::no_estimate);
    }
    if (input.feed_is_assumed || !feed_and_speed_are_known(input)) {
        lowest.lower_to(situation.override_ratio, Limit::no_estimate);
    }
    if (!feed_and_speed_are_known(input)) {
        return lowest;
    }
    constexpr Scalar surely_too_fast = Scalar(1.25F);
    if (is_faster_than_programmed(input.path_speed_mm_s, input.programmed_feed_mm_s, parameters.override_max,
                                  surely_too_fast)) {
        lowest.lower_to(situation.override_ratio, Limit::feed_mismatch);
    }
    lower_by_state(lowest, parameters, input, situation);
    lowest.lower_to(override_of_feed_per_tooth(parameters.max_feed_per_tooth_mm, parameters.teeth, input),
                    Limit::feed_per_tooth);
    if (!input.cut.force_valid) {
        lowest.lower_to(situation.override_ratio, Limit::no_estimate);
    }
    if (!is_out_of_cut(situation.state)) {
        lower_in_cut(lowest, parameters, input, situation);
    }
    return lowest;
}

template <typename Scalar>
void Ceilings<Scalar>::lower_by_state(Ceiling<Scalar>& lowest, const Parameters& parameters,
                                      const ControlInput<Scalar>& input, const Situation& situation) const {
    const bool is_slower = input.programmed_feed_mm_s < highest_programmed_feed_mm_s_;
    const Scalar of_highest_feed = is_slower ? input.programmed_feed_mm_s / highest_programmed_feed_mm_s_ : Scalar(1);
    const auto at_contact = [&](Scalar feed_per_tooth_mm) {
        return not_below_proven(
            parameters, of_highest_feed * override_of_feed_per_tooth(feed_per_tooth_mm, parameters.teeth, input));
    };
    const Scalar told_mm = parameters.air_feed_per_tooth_mm;
    if (input.plunging) {
        const Scalar plunge = at_contact(told_mm);
        lowest.lower_to(plunge < Scalar(1) ? plunge : Scalar(1), Limit::entry_feed);
    }
    if (input.way.known) {
        return;
    }
    if (situation.state == CutState::air) {
        lowest.lower_to(at_contact(situation.contact_feed_mm > told_mm ? situation.contact_feed_mm : told_mm),
                        Limit::air_feed);
    }
    if (situation.state == CutState::entry) {
        const Scalar entry = safe_contact(parameters, input, situation.contact_feed_mm);
        const bool is_behind_gap = situation.has_cut && override_at_state_entry_ > entry;
        lowest.lower_to(is_behind_gap ? override_at_state_entry_ : entry, Limit::entry_feed);
    }
    if (situation.state == CutState::exit) {
        const Scalar of_cut = not_below_proven(parameters, override_at_state_entry_);
        const Scalar safe = safe_contact(parameters, input, situation.contact_feed_mm);
        lowest.lower_to(of_cut < safe ? of_cut : safe, Limit::no_estimate);
    }
}

template <typename Scalar>
void Ceilings<Scalar>::lower_in_cut(Ceiling<Scalar>& lowest, const Parameters& parameters,
                                    const ControlInput<Scalar>& input, const Situation& situation) const {
    lowest.lower_to(situation.force_demand,
                    FeedLaw<Scalar>::guards_against_a_step(parameters, input) ? Limit::depth_step : Limit::force);
    if (!input.way.known) {
        lower_by_surge(lowest, parameters, input);
    }
    lowest.lower_to(spindle_ceiling_, Limit::spindle_torque);
    if (input.cut.answered_feed_mm_s > Scalar(0)) {
        lowest.lower_to(input.cut.answered_feed_mm_s / input.programmed_feed_mm_s, Limit::load_unanswered);
    }
    if (input.cut.doubted_feed_mm_s > Scalar(0)) {
        const Scalar doubted = input.cut.doubted_feed_mm_s / input.programmed_feed_mm_s;
        lowest.lower_to(not_below_proven(parameters, doubted), Limit::current_in_doubt);
    }
    const bool asks_for_roughness = parameters.Ra_limit_um > Scalar(0);
    if (asks_for_roughness) {
        lowest.lower_to(surface_ceiling_, Limit::roughness);
    }
    const bool has_tooth_force = FeedLaw<Scalar>::applies_to(input.cut) && input.cut.tooth_force_valid;
    const bool has_roughness = predicts_a_ceiling(input.surface) && input.surface.in_range;
    if (input.cut.law_is_refuted) {
        lowest.lower_to(situation.override_ratio, Limit::law_misfit);
    }
    if (!has_tooth_force || (asks_for_roughness && !has_roughness)) {
        lowest.lower_to(situation.override_ratio, Limit::no_estimate);
    }
}

/// What may come without warning.
template <typename Scalar>
void Ceilings<Scalar>::lower_by_surge(Ceiling<Scalar>& lowest, const Parameters& parameters,
                                      const ControlInput<Scalar>& input) const {
    const Scalar safe = safe_entry(parameters, input);
    const auto lower_to = [&](Scalar ceiling) { lowest.lower_to(ceiling > safe ? ceiling : safe, Limit::surge); };
    if (surge_is_under_way(parameters)) {
        lower_to(override_before_growth_);
    }
    lower_to(surge_ceiling_);
    lower_to(turn_ceiling_);
    if (trend_.fading()) {
        lowest.lower_to(override_before_fade_, Limit::surge);
    }
}

template <typename Scalar>
bool Ceilings<Scalar>::surge_is_under_way(const Parameters& parameters) const {
    return parameters.surge_radial_immersion > Scalar(0) && trend_.growing();
}

}  // namespace millforce::control
