// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/cut_state.hpp"
#include "control/way_ahead.hpp"
#include "estimation/cut_estimate.hpp"
#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/number/finite.hpp"
#include "estimation/number/literal.hpp"

/// What the feed controller (feed_controller.hpp) is set up with, what it is given at each step and what it answers.
/// Its parts (cut states, feed law, ceilings) are given the same, and StepMotion. They keep no copy of the parameters:
/// there is one, the controller's.

namespace millforce::control {

using estimation::literal;

/// Defaults of the table's [control]. What belongs to the tool, the CNC or the machine stands elsewhere in the
/// firmware's parameters, with its default, and is 0 here until it is set: such parameters are refused.
template <typename Scalar>
struct FeedControllerParameters {
    Scalar tooth_force_limit_N{0};  ///< F_tooth,max
    Scalar setpoint_share{
        literal<Scalar>(0.97L)};  ///< share of the limit at which steady cutting is held; the rest is for noise
    Scalar caution_sd{1};         ///< standard deviations of the tooth's force that are counted on top of it
    Scalar override_min{0};
    Scalar override_max{0};
    Scalar recovery_per_rev{Scalar(0.25F)};                  ///< fraction of the remaining rise taken per revolution
    Scalar slew_up_per_s{2};                                 ///< largest rise of the override per second
    Scalar slew_down_per_s{40};                              ///< largest fall of the override per second
    Scalar entry_feed_per_tooth_mm{literal<Scalar>(0.05L)};  ///< ceiling from contact until there is an estimate
    Scalar air_feed_per_tooth_mm{
        literal<Scalar>(0.05L)};             ///< ceiling in air: the feed at which the tool may meet the workpiece
    Scalar highest_programmed_feed_mm_s{0};  ///< highest F of the program; 0: learnt as blocks come
    Scalar max_feed_per_tooth_mm{literal<Scalar>(0.2L)};  ///< what the tool's edge and chip space allow
    Scalar entry_revolutions{2};
    Scalar entry_travel_mm{5};       ///< `entry` also lasts for this travel: the engagement still grows (cutter radius)
    Scalar exit_travel_mm{2};        ///< travel without contact before `exit` becomes `air`
    Scalar contact_force_N{10};      ///< smallest F_at that counts as contact
    Scalar contact_significance{4};  ///< contact: F_at must also be this many of its standard deviations
    Scalar surge_radial_immersion{0};  ///< largest immersion that may come without warning; 0: none does
    Scalar surge_share{1};             ///< share of the limit that the force may reach in a surge
    Scalar depth_step_ratio{2};  ///< largest ratio of depths that may follow each other without warning; 1: no step
    Scalar depth_step_share{
        literal<Scalar>(1.4L)};  ///< share of the limit that the force may reach in such a step: the tooth survives it
    /// Override at which the program has run before, and no contact broke a tooth: what may come without warning holds
    /// the feed no lower. 0: not known.
    Scalar proven_override{0};
    /// Override at which no tooth of the program exceeds its limit, in the hardest batch of its material. No force
    /// grows faster than the feed: at depth_step_share times that override, whatever comes loads a tooth with that
    /// share of its limit at most. 0: not known.
    Scalar safe_override{0};
    Scalar turn_radial_immersion{2};  ///< immersion assumed after a sharp turn of the path; 0: none
    Scalar turn_travel_mm{2};         ///< travel after a turn for which that immersion is assumed
    Scalar overload_share{
        literal<Scalar>(1.35L)};     ///< share of the limit above which the feed is held and the fault latched
    Scalar overload_revolutions{3};  ///< length of an overload that is a fault, once the override has had reaction_s
    Scalar reaction_s{0};            ///< from a change of the cut to the first change of the feed
    Scalar Ra_limit_um{0};           ///< largest upper bound of the predicted R_a; 0: none
    Scalar no_estimate_hold_s{Scalar(0.5F)};  ///< longest time in cut without an estimate; then state hold
    Scalar stale_s{0};                        ///< longest time without a sample; then a fault
    Scalar teeth{0};
    bool monitor_only{false};  ///< estimate and watch, leave the override to the operator
};

/// What the estimators say after a tooth period. `fresh` is false on ticks without a new one.
template <typename Scalar>
struct CutEstimateForControl {
    bool fresh = false;
    Scalar tooth_periods{1};   ///< tooth periods since the previous estimate
    bool force_valid = false;  ///< there is an F_at from the spindle
    Scalar tangential_N{0};    ///< F_at: contact is judged by it
    Scalar tangential_sd_N{0};
    bool tooth_force_valid = false;     ///< the immersion behind tooth_force_N is an estimate, not a guess
    bool tooth_force_is_bound = false;  ///< tooth_force_N is an upper bound: no sign of an overload
    Scalar tooth_force_N{0};            ///< peak force of one tooth; without an immersion, the worst it can be
    Scalar certain_tooth_force_N{0};    ///< what a tooth carries now at least, by the 95 % interval of the immersion
    Scalar least_tooth_force_N{0};      ///< smallest peak force of one tooth, whatever the immersion
    bool law_is_refuted =
        false;                ///< no cut by the law, or of the declared depth, has these forces: a signal may be wrong
    Scalar surge_ratio{1};    ///< tooth force after a surge to surge_radial_immersion, per tooth force now
    Scalar cutting_share{1};  ///< c: share of the force that is not edge force
    Scalar surge_cutting_share{1};  ///< cutting_share after a surge
    Scalar turn_ratio{1};           ///< as surge_ratio, to turn_radial_immersion
    Scalar turn_cutting_share{1};
    Scalar feed_exponent{estimation::usual_feed_exponent<Scalar>};  ///< 1 + p_s
    Scalar section_mm2{0};         ///< width × depth of the cut: its trend is watched, not its size; 0: not known
    Scalar section_noise_mm2{0};   ///< part of the section's deviation that differs from one window to the next
    Scalar feed_mm_s{0};           ///< path speed over the window of tangential_N
    Scalar answered_feed_mm_s{0};  ///< no faster until a load that comes seldom has answered; 0: no bound
    Scalar doubted_feed_mm_s{0};   ///< no faster while a current may have drifted in the cut; 0: no bound
    Scalar spindle_speed_rad_s{0};
    bool spindle_turning = false;
    bool spindle_does_not_mill = false;   ///< its encoder is there, and stands or counts backwards
    bool spindle_loaded_at_rest = false;  ///< the spindle's encoder stands, and its current says that it cuts
};

/// What the roughness model says, for Ra_limit_um. It may hold the feed down; without it the feed is not raised.
template <typename Scalar>
struct SurfaceForControl {
    bool valid = false;           ///< feed_ceiling_mm_s is a ceiling
    bool in_range = false;        ///< the cut is like those that the model was fitted to: the ceiling may rise
    Scalar feed_ceiling_mm_s{0};  ///< feed at which the upper bound of R_a meets its limit, within the fitted feeds
};

template <typename Scalar>
struct ControlInput {
    Scalar dt_s{literal<Scalar>(0.001L)};
    Scalar programmed_feed_mm_s{0};
    Scalar operator_override{1};
    Scalar path_speed_mm_s{0};
    Scalar velocity_x_mm_s{0};
    Scalar velocity_y_mm_s{0};
    Scalar velocity_z_mm_s{0};     ///< along the tool's axis, away from the workpiece
    bool height_is_known = false;  ///< velocity_z_mm_s is told
    Scalar time_since_sample_s{0};
    bool feed_is_assumed = false;  ///< programmed_feed_mm_s is not told: the controller's own, see feed_controller.hpp
    bool rapid = false;
    bool motion_is_unseen = false;  ///< no velocity is known in this step
    bool plunging = false;          ///< the way goes mainly along the tool's axis
    bool feed_hold = false;
    Fault implausible = Fault::none;  ///< what the supervisor of the signals found
    CutEstimateForControl<Scalar> cut{};
    SurfaceForControl<Scalar> surface{};
    WayAhead<Scalar> way{};
};

/// What has passed since the last step, worked out once for all parts of the controller. Finite whatever comes in.
template <typename Scalar>
struct StepMotion {
    Scalar dt_s{0};             ///< 0…1; a step of unknown, negative or absurd length counts as 0
    Scalar path_speed_mm_s{0};  ///< 0 where it is not known
    Scalar travel_mm{0};        ///< path_speed_mm_s · dt_s
    Scalar tooth_period_s{0};   ///< 2π/(z ω); 0 where the spindle's speed is not known
    bool turned = false;        ///< a sharp turn of the path is noticed in this step (path_turn.hpp)
};

template <typename Scalar>
struct ControlOutput {
    Scalar ratio{0};
    bool hold = false;
    CutState state = CutState::air;
    Fault fault = Fault::none;
    Limit limit = Limit::none;
    bool fading = false;  ///< the section of the cut falls: the tool leaves, or the part ends
};

/// `ratio` within the override's range. NaN becomes the minimum.
template <typename Scalar>
[[nodiscard]] Scalar bounded(const FeedControllerParameters<Scalar>& parameters, Scalar ratio) {
    if (!(ratio >= parameters.override_min)) {
        return parameters.override_min;
    }
    return ratio > parameters.override_max ? parameters.override_max : ratio;
}

/// What may come without warning holds a program no lower than it has run, nor than a safe one survives. NaN becomes
/// that override.
template <typename Scalar>
[[nodiscard]] Scalar not_below_proven(const FeedControllerParameters<Scalar>& parameters, Scalar ratio) {
    const Scalar survived = parameters.depth_step_share * parameters.safe_override;
    const Scalar proven = survived > parameters.proven_override ? survived : parameters.proven_override;
    return ratio > proven ? ratio : proven;
}

/// 2π/(z ω); 0 where the spindle's speed is not known, or backwards.
template <typename Scalar>
[[nodiscard]] Scalar tooth_period_s(Scalar teeth, Scalar spindle_speed_rad_s) {
    const Scalar teeth_rad_s = spindle_speed_rad_s * teeth;
    return teeth_rad_s > Scalar(0) ? estimation::turn_rad<Scalar> / teeth_rad_s : Scalar(0);
}

/// A feed or a speed that can be divided by: > 0, neither infinite nor NaN.
template <typename Scalar>
[[nodiscard]] bool is_known(Scalar feed_or_speed) {
    return feed_or_speed > Scalar(0) && estimation::is_finite(feed_or_speed);
}

/// The programmed feed and the spindle's speed are known: a feed can be turned into an override.
template <typename Scalar>
[[nodiscard]] bool feed_and_speed_are_known(const ControlInput<Scalar>& input) {
    return is_known(input.programmed_feed_mm_s) && is_known(input.cut.spindle_speed_rad_s);
}

/// The axes are faster than `ratio` times what programmed feed and largest override allow: they still brake, or one of
/// the feeds is told wrongly.
template <typename Scalar>
[[nodiscard]] bool is_faster_than_programmed(Scalar feed_mm_s, Scalar programmed_feed_mm_s, Scalar override_max,
                                             Scalar ratio) {
    constexpr Scalar tolerance_mm_s = Scalar(1);
    return feed_mm_s > ratio * override_max * programmed_feed_mm_s + tolerance_mm_s;
}

/// The override at which the teeth take `feed_per_tooth_mm` each: f_z z n/F. Needs feed_and_speed_are_known.
template <typename Scalar>
[[nodiscard]] Scalar override_of_feed_per_tooth(Scalar feed_per_tooth_mm, Scalar teeth,
                                                const ControlInput<Scalar>& input) {
    const Scalar feed_mm_s =
        feed_per_tooth_mm * teeth * input.cut.spindle_speed_rad_s * estimation::turns_per_rad<Scalar>;
    return feed_mm_s / input.programmed_feed_mm_s;
}

/// The override at which the tool may meet any workpiece. Needs feed_and_speed_are_known.
template <typename Scalar>
[[nodiscard]] Scalar safe_entry(const FeedControllerParameters<Scalar>& parameters, const ControlInput<Scalar>& input) {
    return not_below_proven(parameters,
                            override_of_feed_per_tooth(parameters.entry_feed_per_tooth_mm, parameters.teeth, input));
}

/// The override at which a cut may begin, after cuts that have shown `contact_feed_mm` to be safe (contact_feed.hpp).
/// Needs feed_and_speed_are_known.
template <typename Scalar>
[[nodiscard]] Scalar safe_contact(const FeedControllerParameters<Scalar>& parameters, const ControlInput<Scalar>& input,
                                  Scalar contact_feed_mm) {
    const Scalar told = safe_entry(parameters, input);
    const Scalar shown = override_of_feed_per_tooth(contact_feed_mm, parameters.teeth, input);
    return shown > told ? shown : told;
}

/// F_at from which on the tool counts as in contact: what the noise makes unlikely, and not less than contact_force_N.
template <typename Scalar>
[[nodiscard]] Scalar contact_level_N(Scalar contact_force_N, Scalar contact_significance, Scalar tangential_sd_N) {
    const Scalar significant_N = contact_significance * tangential_sd_N;
    return significant_N > contact_force_N ? significant_N : contact_force_N;
}
template <typename Scalar>
[[nodiscard]] Scalar contact_level_N(const FeedControllerParameters<Scalar>& parameters, Scalar tangential_sd_N) {
    return contact_level_N(parameters.contact_force_N, parameters.contact_significance, tangential_sd_N);
}

}  // namespace millforce::control
