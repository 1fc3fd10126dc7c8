// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/cut_state.hpp"
#include "control/cut_trend.hpp"
#include "control/feed_controller_data.hpp"
#include "estimation/number/finite.hpp"
#include "estimation/number/fixed_point.hpp"

/// The ceilings of the override. Each says how fast the feed may be for one reason, and the lowest wins; its Limit is
/// the reason that is shown. f_z: feed per tooth, z: teeth, n: revolutions per second, F: the programmed feed.
///
///   air        f_z,air z n/F · F/F_highest: the tool may meet the workpiece at any moment, and a new block's F acts at
///              once, but the override reacts only after the latency. f_z,air is not below what the program's cuts have
///              shown to be safe (contact_feed.hpp), nor is f_z,entry
///   plunge     the same by f_z,air alone, and at most 1 (limit entry_feed): the law does not describe that
///   entry      the larger of f_z,entry z n/F and, behind a gap in a cut, the override that the tool came with
///   exit       the override that contact was lost with, and at most that of an entry
///   feed per tooth   f_z,max z n/F: what edge and chip space allow
///   force      the demand of the law (feed_law.hpp)
///   surge      the override at which a surge to surge_radial_immersion would reach surge_share of the limit, by the
///              law with F · surge_ratio; the entry feed where the immersion is not known. While the cut grows, the
///              surge is under way: then also the override at the last estimate before the growth, until it is over
///              (cut_trend.hpp).
///   turn       the same with turn_ratio, for turn_travel_mm after a sharp turn of the path (limit surge)
///   way ahead  where a part map is known: its feed (feed_ahead.hpp). It replaces air, entry, exit, surge,
///              turn and fading, which guard a tool that does not see. The force, which is measured, stays.
///   spindle    override_min while the spindle loses its speed, then what holds F_at below that at the loss
///              (spindle_torque.hpp, limit spindle_torque)
///   load       where a spindle load comes seldom: the feed that it has answered (limit load_unanswered)
///   doubt      the feed that a current allows which may have drifted in the cut (limit current_in_doubt)
///   surface    the feed at which the upper bound of R_a meets Ra_limit_um (limit roughness)
///   blind      override_min out of the cut without F_at, unless the spindle stands or turns backwards: the tool may
///              meet the workpiece unnoticed (limit no_estimate)
///   program    a rapid goes at 1: the program says that nothing is in the way. Not where contact begins in it
///              (state entry), nor, on a CNC that tells a rapid's F, at an F of the blocks: then all ceilings hold.
///   operator   the operator's override below 1; NaN or infinite counts as 0
///
/// At the feed of an entry the tool may meet anything: surge, turn and a step of the depth hold it no lower. A program
/// that has run at proven_override without a broken tooth has met at that feed whatever comes without warning: none of
/// these, nor air, entry, exit and doubt, hold it lower. The force, which is measured, may. So it is at
/// depth_step_share times safe_override, at which whatever comes is survived.
///
/// No estimate, no rise: the present override is a ceiling (limit no_estimate) where feed, speed or F_at is not known,
/// in a cut without a tooth force, without a prediction of R_a that is asked for, and in state hold; also where the
/// forces contradict the law (limit law_misfit), since a signal may be wrong, and where the axes are faster than F and
/// override_max make them (limit feed_mismatch), since F may be wrong. In a cut that fades the override from before
/// the fade is one too (limit surge): what follows at its end would meet the tool at the highest feed of all. Before:
/// the highest of the last estimates, forgotten by an eighth with each, since forces at the begin of a fade are those
/// of two cuts.
///
/// `follow` takes in a step, `lowest` works the ceilings out and remembers nothing. State kept until the next estimate
/// has its own named member, override_before_growth_ for instance: the override at that moment.
///
/// The result is within [override_min, override_max]. A ceiling that is NaN counts as 0. Cost: some 60 operations, six
/// divisions; at a fresh estimate two of the law's override_for. Not thread-safe.

namespace millforce::control {

/// A ceiling of the override and the reason for it.
template <typename Scalar>
struct Ceiling {
    Scalar override_ratio{0};
    Limit limit = Limit::none;

    /// Among equal ceilings the first is the reason.
    void lower_to(Scalar ceiling, Limit reason) {
        if (!(override_ratio <= ceiling)) {
            override_ratio = estimation::is_finite(ceiling) ? ceiling : Scalar(0);
            limit = reason;
        }
    }
};

template <typename Scalar>
class Ceilings {
  public:
    using Parameters = FeedControllerParameters<Scalar>;

    /// Where the rest of the controller stands in this step.
    struct Situation {
        CutState state = CutState::air;
        bool has_cut = false;            ///< CutStates::has_cut
        Scalar override_ratio{0};        ///< override of the last step
        Scalar force_demand{0};          ///< FeedLaw::demand
        Scalar contact_feed_mm{0};       ///< ContactFeed::feed_per_tooth_mm
        bool spindle_is_slow = false;    ///< SpindleTorque::is_slow
        Scalar largest_tangential_N{0};  ///< SpindleTorque::largest_tangential_N
    };

    /// The state has changed, at this override.
    void enter_state(Scalar override_ratio) { override_at_state_entry_ = override_ratio; }

    void follow(const Parameters& parameters, const ControlInput<Scalar>& input, const StepMotion<Scalar>& motion,
                const Situation& situation);
    [[nodiscard]] Ceiling<Scalar> lowest(const Parameters& parameters, const ControlInput<Scalar>& input,
                                         const Situation& situation) const;

    /// Of the blocks so far, or of the whole program where the parameters tell it; 0: not known.
    [[nodiscard]] Scalar highest_programmed_feed_mm_s() const { return highest_programmed_feed_mm_s_; }
    /// The section of the cut falls.
    [[nodiscard]] bool is_fading() const { return trend_.fading(); }

  private:
    void follow_program(const Parameters& parameters, const ControlInput<Scalar>& input);
    [[nodiscard]] bool runs_free(const ControlInput<Scalar>& input, CutState state) const;
    void follow_surge(const Parameters& parameters, const ControlInput<Scalar>& input, const Situation& situation);
    void follow_turn(const Parameters& parameters, const ControlInput<Scalar>& input, bool turned);
    void follow_spindle(const Parameters& parameters, const ControlInput<Scalar>& input, const Situation& situation);
    void follow_surface(const ControlInput<Scalar>& input);

    [[nodiscard]] Ceiling<Scalar> lowest_in_feed(const Parameters& parameters, const ControlInput<Scalar>& input,
                                                 const Situation& situation) const;
    void lower_by_state(Ceiling<Scalar>& lowest, const Parameters& parameters, const ControlInput<Scalar>& input,
                        const Situation& situation) const;
    void lower_in_cut(Ceiling<Scalar>& lowest, const Parameters& parameters, const ControlInput<Scalar>& input,
                      const Situation& situation) const;
    void lower_by_surge(Ceiling<Scalar>& lowest, const Parameters& parameters, const ControlInput<Scalar>& input) const;
    [[nodiscard]] static bool may_exceed_the_limit(const Parameters& parameters,
                                                   const CutEstimateForControl<Scalar>& cut);
    [[nodiscard]] static Scalar ceiling_of_surge(const Parameters& parameters, const ControlInput<Scalar>& input);
    [[nodiscard]] bool surge_is_under_way(const Parameters& parameters) const;

    Scalar highest_programmed_feed_mm_s_{0};
    bool tells_feed_of_rapids_ = false;  // the CNC: a rapid's F was above that of all blocks
    Scalar override_at_state_entry_{0};
    Scalar surge_ceiling_{0};
    CutTrend<Scalar> trend_{};
    Scalar travel_since_estimate_mm_{0};
    Scalar override_before_growth_{0};  // at the last estimate that showed none
    Scalar override_before_fade_{0};
    Scalar turn_travel_left_mm_{0};
    Scalar turn_ceiling_{0};
    Scalar surface_ceiling_{0};
    Scalar spindle_ceiling_{0};
};

extern template class Ceilings<float>;
extern template class Ceilings<estimation::Fixed>;

}  // namespace millforce::control
