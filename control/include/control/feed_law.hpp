// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/cut_state.hpp"
#include "control/feed_controller_data.hpp"
#include "estimation/number/fixed_point.hpp"

/// The feed law: the override at which the force on a tooth meets a target, and how the override moves there.
///
/// The force grows with the feed f as
///
///   F = F₀ [(1 − c) + c (f/f₀)^(1+p_s)]        c: share of F that is not edge force, p_s: exponent of the size effect
///
/// and its gain dF/df varies by an order of magnitude along a part (depth, immersion). A loop with a fixed gain is slow
/// or unstable there. So the law inverts the process at the measured point (f, F),
///
///   f* = f {[F_target/F − (1 − c)]/c}^(1/(1+p_s)),    override = f*/F_programmed
///
/// with f and F averaged over the same window of tooth periods: the depth, the immersion and K_s cancel, and a delay
/// between override and force delays the correction but does not add to it. Where the edge force alone exceeds the
/// target no feed helps, and f* is 0.
///
/// The demand is the override for the set point,
///
///   F_target = F_tooth,max · setpoint_share, and where no part map tells the depth at most
///              F_tooth,max · depth_step_share/depth_step_ratio
///
/// The second one is for a step of the depth that nobody has announced: at its first tooth the force is
/// depth_step_ratio times as large, and no reaction is faster than a tooth. It need not come, so it holds the demand no
/// lower than the feed of an entry, at which the tool may meet anything. A larger step that the program has met once
/// may come again: the demand also stays where the heaviest cut so far would reach depth_step_share of the limit at
/// most (contact_feed.hpp). The demand is worked out at each fresh estimate and stands until the next.
///
/// The override approaches what is wanted
///   downwards  at once, within slew_down_per_s
///   upwards    in the cut by recovery_per_rev of the distance per revolution, else at once; within slew_up_per_s,
///              but where the way ahead is known: there its ceiling says how far it may rise. In the cut an estimate is
///              good for a rise of one revolution; then the override waits for the next.
///
/// Valid: F, f > 0, 1+p_s > 0, all finite (`applies_to`); c below 0.05 counts as 0.05. An estimate outside leaves the
/// demand where it is; the ceilings then let nothing rise. The override is always finite and within [override_min,
/// override_max]. Cost: two divisions, an exponential and a logarithm per override_for; else some 10 operations. Not
/// thread-safe.

namespace millforce::control {

template <typename Scalar>
class FeedLaw {
  public:
    using Parameters = FeedControllerParameters<Scalar>;
    using Estimate = CutEstimateForControl<Scalar>;

    /// Begins at `override_ratio`, within the override's range.
    explicit FeedLaw(Scalar override_ratio) : override_ratio_(override_ratio) {}

    /// The force that is `force_N` at the measured feed is to become `share_of_limit` × F_tooth,max.
    struct Target {
        Scalar share_of_limit{1};
        Scalar force_N{0};
        Scalar cutting_share{1};  ///< c of that force
    };

    /// The process can be inverted at this estimate.
    [[nodiscard]] static bool applies_to(const Estimate& cut);
    /// And the force of a tooth after a turn of the path is known: turn_ratio, turn_cutting_share.
    [[nodiscard]] static bool knows_turn(const Estimate& cut);
    /// f*/F_programmed, ≥ 0. Needs applies_to(input.cut) and a programmed feed > 0.
    [[nodiscard]] static Scalar override_for(const Parameters& parameters, const ControlInput<Scalar>& input,
                                             Target target);

    /// A step of the depth, which no part map announces, keeps the demand below the set point.
    [[nodiscard]] static bool guards_against_a_step(const Parameters& parameters, const ControlInput<Scalar>& input);
    /// Of the limit: such that the largest step of the depth is survived.
    [[nodiscard]] static Scalar share_before_a_step(const Parameters& parameters);
    /// Takes in a fresh estimate. Out of the cut there is no demand: override_max. Between two estimates the demand
    /// falls with the spindle's speed by more than 5 %, so that the feed per tooth does not grow; it does not rise with
    /// it. `contact_feed_mm`: ContactFeed.
    void follow(const Parameters& parameters, const ControlInput<Scalar>& input, CutState state,
                Scalar contact_feed_mm);
    [[nodiscard]] Scalar demand() const { return demand_; }

    /// Moves the override by one step towards `wanted`, which is within the override's range.
    void approach(const Parameters& parameters, const ControlInput<Scalar>& input, const StepMotion<Scalar>& motion,
                  CutState state, Scalar wanted);
    [[nodiscard]] Scalar override_ratio() const { return override_ratio_; }

  private:
    struct SafeFeed {
        Scalar override_ratio{0};   ///< safe at contact
        Scalar present_force_N{0};  ///< that a tooth carries for certain; 0: not known
    };
    [[nodiscard]] static Scalar not_below_safe_feed(const Parameters& parameters, const ControlInput<Scalar>& input,
                                                    Scalar demand, SafeFeed safe);
    [[nodiscard]] static Scalar override_before_heaviest(const Parameters& parameters,
                                                         const ControlInput<Scalar>& input, Scalar contact_feed_mm);
    [[nodiscard]] static Scalar recovery_in(const Parameters& parameters, const ControlInput<Scalar>& input,
                                            const StepMotion<Scalar>& motion);
    void slow_down_with(Scalar spindle_speed_rad_s);

    Scalar override_ratio_;
    Scalar demand_{0};
    Scalar speed_of_demand_rad_s_{0};
    Scalar since_estimate_s_{0};
};

extern template class FeedLaw<float>;
extern template class FeedLaw<estimation::Fixed>;

}  // namespace millforce::control
