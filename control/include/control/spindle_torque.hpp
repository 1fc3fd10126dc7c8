// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/cut_state.hpp"
#include "control/feed_controller_data.hpp"
#include "estimation/number/fixed_point.hpp"

/// Whether the spindle loses its speed in a cut. At its drive's torque limit its current shows no more of the cut, and
/// the chip grows as the speed falls; the forces that are worked out look as if nothing had happened.
///
///   slow:     ω < 0.95 ω_0, ω_0 the speed that the cut began with, or a higher one since
///   regained: ω > 0.98 ω_0, by a lower feed or at the end of the cut. Before, the drive gave what it can: 0.9 of F_at
///             then, the largest of its averages by quarters, is not exceeded from then on, in later cuts, too
///   another:  ω within 1 % for a second. Somebody has asked for this speed: it is ω_0 from then on
///   stalls:   ω < ω_0/3: no feed that the override can give will do
///
/// A drive that holds its speed loses 1 % in the heaviest cuts. Slip that is not compensated, some 3 % at full load, is
/// no loss. A speed that is varied on purpose, against chatter, by more than 5 % is taken for one.
///
/// `follow` once per step. Cost: some 15 operations, no division. Not thread-safe.

namespace millforce::control {

template <typename Scalar>
class SpindleTorque {
  public:
    void follow(const CutEstimateForControl<Scalar>& cut, CutState state, Scalar dt_s);

    /// The feed is to be as low as it can be.
    [[nodiscard]] bool is_slow() const { return is_slow_; }
    /// The feed is to be held.
    [[nodiscard]] bool stalls() const { return stalls_; }
    /// F_at that is not to be exceeded; 0: the spindle has never lost its speed.
    [[nodiscard]] Scalar largest_tangential_N() const { return largest_N_; }

  private:
    void begin_at(Scalar speed_rad_s);
    void follow_loss(const CutEstimateForControl<Scalar>& cut, Scalar dt_s);

    Scalar full_speed_rad_s_{0};
    bool is_slow_ = false;
    bool stalls_ = false;
    Scalar mean_N_{0};     // of F_at since the loss
    Scalar lost_at_N_{0};  // its largest value
    Scalar largest_N_{0};
    Scalar steady_speed_rad_s_{0};
    Scalar steady_s_{0};
};

extern template class SpindleTorque<float>;
extern template class SpindleTorque<estimation::Fixed>;

}  // namespace millforce::control
