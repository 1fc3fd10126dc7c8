// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/feed_controller_data.hpp"
#include "control/feed_law.hpp"
#include "estimation/number/fixed_point.hpp"

namespace millforce::control {

/// The feed per tooth at which the tool may meet the workpiece again, from the cuts of this program.
///
/// A tooth that meets a wall takes the whole feed per tooth as its first chip, as in a slot. How much that costs
/// depends on the depth and the material ahead, which are not known; but they are seldom more than depth_step_ratio
/// times what the program has cut so far. So each settled cut says
///
///   f_z: its tooth force in a slot of the same depth is depth_step_share/depth_step_ratio of the limit (feed_law.hpp)
///
/// averaged over 16 estimates, and the heaviest cut counts. With it a new contact is at most a step of the depth, which
/// the tooth survives. Where the edge force of that slot alone is more, no feed is that low: then f_z is 0.0001 mm.
///
/// 0: nothing is known. So it is before the first settled cut, where the tool is lower than it has cut by more than
/// 0.1 mm, and after the spindle stood (another part, another tool). Where nobody tells the height, a rapid may have
/// changed it.
///
/// Cost: that of FeedLaw::override_for at a fresh estimate, else some five operations. Not thread-safe.
template <typename Scalar>
class ContactFeed {
  public:
    /// Each step, of `dt_s`.
    void follow(const ControlInput<Scalar>& input, Scalar dt_s) {
        constexpr Scalar rest_mm_s = literal<Scalar>(0.05L);  // no drift of a velocity at rest
        const Scalar z_mm_s = input.velocity_z_mm_s;
        const bool may_be_lower = input.motion_is_unseen || (input.rapid && !input.height_is_known);
        if (!input.cut.spindle_turning || may_be_lower) {
            *this = {};
        } else if (z_mm_s > rest_mm_s || z_mm_s < -rest_mm_s) {
            height_mm_ += z_mm_s * dt_s;
        }
    }

    /// A fresh estimate in a cut that neither begins nor ends. Needs feed_and_speed_are_known.
    void learn(const FeedControllerParameters<Scalar>& parameters, const ControlInput<Scalar>& input) {
        const CutEstimateForControl<Scalar>& cut = input.cut;
        const bool is_determined = FeedLaw<Scalar>::knows_turn(cut) && cut.turn_ratio > Scalar(0) &&
                                   cut.tooth_force_valid && !cut.tooth_force_is_bound && !cut.law_is_refuted;
        if (!is_determined) {
            return;
        }
        const Scalar override_ratio =
            FeedLaw<Scalar>::override_for(parameters, input,
                                          {FeedLaw<Scalar>::share_before_a_step(parameters),
                                           cut.tooth_force_N * cut.turn_ratio, cut.turn_cutting_share});
        sum_mm_ += override_ratio / override_of_feed_per_tooth(Scalar(1), parameters.teeth, input);
        if (++estimates_ < block) {
            return;
        }
        const Scalar mean_mm = sum_mm_ > Scalar(block) * least_mm ? sum_mm_ / Scalar(block) : least_mm;
        lowest_mm_ = feed_per_tooth_mm_ > Scalar(0) && lowest_mm_ < height_mm_ ? lowest_mm_ : height_mm_;
        feed_per_tooth_mm_ =
            feed_per_tooth_mm_ > Scalar(0) && feed_per_tooth_mm_ < mean_mm ? feed_per_tooth_mm_ : mean_mm;
        sum_mm_ = Scalar(0);
        estimates_ = 0;
    }

    [[nodiscard]] Scalar feed_per_tooth_mm() const {
        constexpr Scalar as_low_mm = literal<Scalar>(0.1L);
        return height_mm_ < lowest_mm_ - as_low_mm ? Scalar(0) : feed_per_tooth_mm_;
    }

  private:
    static constexpr int block = 16;
    static constexpr Scalar least_mm = literal<Scalar>(0.0001L);

    Scalar height_mm_{0};  // since the spindle turns
    Scalar lowest_mm_{0};  // at which it has cut
    Scalar feed_per_tooth_mm_{0};
    Scalar sum_mm_{0};
    int estimates_ = 0;
};

}  // namespace millforce::control
