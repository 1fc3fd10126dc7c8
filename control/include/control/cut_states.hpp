// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/cut_state.hpp"
#include "control/feed_controller_data.hpp"
#include "estimation/number/fixed_point.hpp"

/// The state machine: where the tool stands, from the mean tangential force F_at, and the watches that end in a fault.
/// Who may enter each state and how it is left stands at the enumerators (cut_state.hpp).
///
///   contact:       F_at above the contact level, the larger of contact_force_N and contact_significance · σ(F_at)
///   lost contact:  F_at below half of it; between the two the state stays (hysteresis)
///
/// Only a fresh estimate moves between air, entry, in_cut and exit. Without a valid force nothing counts as contact and
/// nothing as lost contact: the state stays. In a cut the tool counts as held after no_estimate_hold_s; out of it, or
/// behind a hold, after exit_travel_mm of feed, unless the spindle stands or turns backwards: then nobody mills. Where
/// the velocity is not known either, the axes count as moving with the programmed feed.
///
/// Watches, each latched as a fault:
///   stale_input      no drive sample for longer than stale_s, or of unknown age (NaN), in any state
///   spindle_stopped  in entry or in_cut, or where the current shows a cut, the axes moving, and the spindle or its
///                    encoder at rest for longer than stale_s; the controller adds a spindle that stalls
///                    (spindle_torque.hpp)
///   overload         F_tooth > overload_share · F_tooth,max for more than overload_revolutions beyond reaction_s,
///                    before which no lower override acts; F_tooth as far as it is certain, by an estimate: what is
///                    only possible or forecast does not count.
///                    Not in monitor_only.
///
/// Forces in N, ≥ 0; times in s, travel in mm, both as StepMotion has made them finite. A NaN in a force compares as
/// false: neither contact nor lost contact nor overload. Cost: some 40 operations. Not thread-safe.

namespace millforce::control {

template <typename Scalar>
class CutStates {
  public:
    using Parameters = FeedControllerParameters<Scalar>;

    void step(const Parameters& parameters, const ControlInput<Scalar>& input, const StepMotion<Scalar>& motion);

    /// Latches a fault that is found elsewhere.
    void enter_fault(Fault fault);
    /// Begins again with the axes at rest, perhaps in a cut.
    void resume();

    [[nodiscard]] CutState state() const { return state_; }
    [[nodiscard]] Fault fault() const { return fault_; }
    /// The tool has been in_cut since it was last in air, so it has already survived a cut at this feed.
    [[nodiscard]] bool has_cut() const { return has_cut_; }
    /// In `hold` because there is no estimate.
    [[nodiscard]] bool is_blind() const { return is_blind_; }

  private:
    using Estimate = CutEstimateForControl<Scalar>;

    void go_to(CutState state);
    void follow_contact(const Parameters& parameters, const ControlInput<Scalar>& input);
    void leave_hold(const Parameters& parameters, const ControlInput<Scalar>& input, bool contact);
    [[nodiscard]] bool has_entered(const Parameters& parameters) const;
    void watch_force(const ControlInput<Scalar>& input, const StepMotion<Scalar>& motion);
    [[nodiscard]] bool lacks_estimate(const Parameters& parameters) const;
    void watch_input(const Parameters& parameters, const ControlInput<Scalar>& input);
    void watch_spindle(const Parameters& parameters, const ControlInput<Scalar>& input,
                       const StepMotion<Scalar>& motion);
    void watch_rest(const ControlInput<Scalar>& input, const StepMotion<Scalar>& motion);
    void watch_overload(const Parameters& parameters, const Estimate& cut);

    CutState state_ = CutState::air;
    Fault fault_ = Fault::none;
    bool has_cut_ = false;
    bool was_in_contact_ = false;
    bool is_blind_ = false;
    bool may_stand_in_cut_ = false;  // in hold
    Scalar travel_in_state_mm_{0};
    Scalar tooth_periods_in_state_{0};  // counted: a sum of shares of a revolution would round
    Scalar without_force_s_{0};
    Scalar fed_without_force_mm_{0};
    Scalar spindle_at_rest_s_{0};
    Scalar at_rest_s_{0};  // spindle and axes
    Scalar overload_tooth_periods_{0};
};

extern template class CutStates<float>;
extern template class CutStates<estimation::Fixed>;

}  // namespace millforce::control
