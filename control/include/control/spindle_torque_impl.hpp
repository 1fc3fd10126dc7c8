// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of spindle_torque.hpp. Only src/spindle_torque.cpp includes them.

#include "control/spindle_torque.hpp"

namespace millforce::control {

template <typename Scalar>
void SpindleTorque<Scalar>::begin_at(Scalar speed_rad_s) {
    full_speed_rad_s_ = speed_rad_s;
    is_slow_ = false;
    stalls_ = false;
}

template <typename Scalar>
void SpindleTorque<Scalar>::follow(const CutEstimateForControl<Scalar>& cut, CutState state, Scalar dt_s) {
    constexpr Scalar held_share = literal<Scalar>(0.95L);
    const Scalar speed_rad_s = cut.spindle_speed_rad_s;
    if (!is_known(speed_rad_s)) {
        return;
    }
    if (!is_cutting(state) || speed_rad_s > full_speed_rad_s_) {
        begin_at(speed_rad_s);
        return;
    }
    if (is_slow_) {
        follow_loss(cut, dt_s);
    } else if (speed_rad_s < held_share * full_speed_rad_s_) {
        is_slow_ = true;
        mean_N_ = Scalar(0);
        lost_at_N_ = Scalar(0);
        steady_speed_rad_s_ = speed_rad_s;
        steady_s_ = Scalar(0);
    }
}

template <typename Scalar>
void SpindleTorque<Scalar>::follow_loss(const CutEstimateForControl<Scalar>& cut, Scalar dt_s) {
    constexpr Scalar regained_share = literal<Scalar>(0.98L);
    constexpr Scalar stalled_share = literal<Scalar>(0.333L);
    constexpr Scalar steady_share = literal<Scalar>(0.01L);
    constexpr Scalar held_share_of_force = literal<Scalar>(0.9L);
    constexpr Scalar long_enough_s = Scalar(1);
    constexpr Scalar share_of_new = Scalar(0.25F);
    const Scalar speed_rad_s = cut.spindle_speed_rad_s;
    if (cut.fresh && cut.force_valid) {
        const Scalar share = mean_N_ > Scalar(0) ? share_of_new : Scalar(1);
        mean_N_ += share * (cut.tangential_N - mean_N_);
        lost_at_N_ = mean_N_ > lost_at_N_ ? mean_N_ : lost_at_N_;
    }
    if (speed_rad_s > regained_share * full_speed_rad_s_) {
        is_slow_ = false;
        largest_N_ = lost_at_N_ > Scalar(0) ? held_share_of_force * lost_at_N_ : largest_N_;
        return;
    }
    stalls_ = speed_rad_s < stalled_share * full_speed_rad_s_;
    const Scalar change = speed_rad_s - steady_speed_rad_s_;
    const Scalar most = steady_share * speed_rad_s;
    if (change > most || -change > most) {
        steady_speed_rad_s_ = speed_rad_s;
        steady_s_ = Scalar(0);
    }
    steady_s_ += dt_s;
    if (steady_s_ > long_enough_s) {
        begin_at(speed_rad_s);
    }
}

}  // namespace millforce::control
