// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/ceilings.hpp"
#include "control/contact_feed.hpp"
#include "control/cut_state.hpp"
#include "control/cut_states.hpp"
#include "control/feed_controller_data.hpp"
#include "control/feed_law.hpp"
#include "control/path_turn.hpp"
#include "control/spindle_torque.hpp"
#include "estimation/number/fixed_point.hpp"

/// The feed override that holds the largest force on a tooth at its limit. One step, of any length up to 1 s:
///
///   path turn   does the path turn sharply here?                                                   path_turn.hpp
///   cut states  where does the tool stand; has something failed?                                   cut_states.hpp
///   feed law    which override brings the force to its set point?                                  feed_law.hpp
///   ceilings    how fast may the feed be, for each other reason? The lowest wins.                  ceilings.hpp
///   feed law    the override moves towards that: down at once, up by a share per revolution.
///
/// All of it is worked out at each step, from the input and from what the parts remember.
///
/// A programmed feed that is not told is taken for the highest of the program so far, with which every ceiling is as
/// low as can be, and nothing rises on it. Before one was told the override stays, in air at its minimum.
///
/// No estimate, no rise: without an estimate the override may fall (the tangential force alone suffices for that) or
/// stay, never grow. The override is finite and within [override_min, override_max] whatever the input. Parameters that
/// make no sense are the fault bad_configuration from the start: override 0, feed held, and reset() does not leave it.
/// In a fault the override falls to override_min with the feed held; `limit` stays what it was.
///
/// Cost of a step: some 200 operations, twelve divisions; at a fresh estimate four exponentials and logarithms at most.
/// No heap. Not thread-safe: one thread calls step() and reset().

namespace millforce::control {

template <typename Scalar>
class FeedController {
  public:
    using Parameters = FeedControllerParameters<Scalar>;

    explicit FeedController(const Parameters& parameters);

    [[nodiscard]] CutState state() const { return states_.state(); }
    [[nodiscard]] const Parameters& parameters() const { return parameters_; }

    /// Leaves a latched fault; parameters that are refused stay so. Only at standstill: the caller has seen the spindle
    /// stop or the operator acknowledge.
    void reset();

    ControlOutput<Scalar> step(const ControlInput<Scalar>& input);

  private:
    [[nodiscard]] ControlOutput<Scalar> step_at_feed(const ControlInput<Scalar>& input);
    [[nodiscard]] StepMotion<Scalar> motion_of(const ControlInput<Scalar>& input);
    [[nodiscard]] Ceiling<Scalar> wanted(const ControlInput<Scalar>& input, const StepMotion<Scalar>& motion);
    void follow_law(const ControlInput<Scalar>& input);
    [[nodiscard]] ControlOutput<Scalar> output_of(const ControlInput<Scalar>& input) const;

    Parameters parameters_;
    PathTurn<Scalar> turn_{};
    CutStates<Scalar> states_{};
    SpindleTorque<Scalar> spindle_{};
    FeedLaw<Scalar> law_;
    ContactFeed<Scalar> contact_feed_{};
    Ceilings<Scalar> ceilings_{};
    Limit limit_ = Limit::none;  // that was shown last
};

extern template class FeedController<float>;
extern template class FeedController<estimation::Fixed>;

}  // namespace millforce::control
