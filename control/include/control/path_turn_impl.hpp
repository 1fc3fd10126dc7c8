// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of path_turn.hpp. Only src/path_turn.cpp includes them.

#include "control/path_turn.hpp"
#include "estimation/number/finite.hpp"
#include "estimation/number/literal.hpp"

namespace millforce::control {

template <typename Scalar>
bool PathTurn<Scalar>::update(const Motion& motion) {
    const Motion smooth = without_shaking(motion);
    const bool turned = has_turned(smooth);
    const bool slowed = has_slowed(smooth);
    return turned || slowed;
}

/// A non-finite input becomes the average once; the next finite one replaces it.
template <typename Scalar>
static void move_towards(Scalar now, Scalar share, Scalar& average) {
    const Scalar next = average + (now - average) * share;
    average = estimation::is_finite(next) ? next : now;
}

template <typename Scalar>
typename PathTurn<Scalar>::Motion PathTurn<Scalar>::without_shaking(const Motion& motion) {
    constexpr Scalar settling_s = estimation::literal<Scalar>(0.015L);  // of a drive's velocity loop
    const Scalar window_s = Scalar(2) * (motion.tooth_period_s - settling_s);
    if (!(window_s > motion.dt_s)) {
        average_x_mm_s_ = motion.velocity_x_mm_s;
        average_y_mm_s_ = motion.velocity_y_mm_s;
        average_path_mm_s_ = motion.path_speed_mm_s;
        return motion;
    }
    const Scalar share = motion.dt_s / window_s;
    move_towards(motion.velocity_x_mm_s, share, average_x_mm_s_);
    move_towards(motion.velocity_y_mm_s, share, average_y_mm_s_);
    move_towards(motion.path_speed_mm_s, share, average_path_mm_s_);
    Motion smooth = motion;
    smooth.velocity_x_mm_s = average_x_mm_s_;
    smooth.velocity_y_mm_s = average_y_mm_s_;
    smooth.path_speed_mm_s = average_path_mm_s_;
    smooth.travel_mm = average_path_mm_s_ * motion.dt_s;
    return smooth;
}

template <typename Scalar>
bool PathTurn<Scalar>::has_turned(const Motion& motion) {
    constexpr Scalar slowest2 = Scalar(0.25F);      // (0.5 mm/s)²: below it the noise of a velocity has any direction
    constexpr Scalar cos2_of_turn = Scalar(0.75F);  // cos² 30°
    const Scalar x = motion.velocity_x_mm_s;
    const Scalar y = motion.velocity_y_mm_s;
    const Scalar v2 = x * x + y * y;
    if (!(v2 > slowest2) || !(motion.path_speed_mm_s > Scalar(0))) {
        return false;
    }
    const Scalar m2 = mean_x_ * mean_x_ + mean_y_ * mean_y_;
    const bool has_mean = m2 > Scalar(0);
    const Scalar along = x * mean_x_ + y * mean_y_;
    // (v·m)² < cos² |v|² |m|², divided by |m|²: the fourth power of a rapid's speed is beyond the range of fixed point.
    const bool turned = has_mean && (along < Scalar(0) || along * (along / m2) < cos2_of_turn * v2);
    // A share of v per travel, and not of v/|v|: only the direction of m is used.
    const Scalar of_memory = Scalar(2) * motion.travel_mm;  // travel/0.5 mm
    const bool adds = has_mean && !turned && of_memory < Scalar(1);
    const Scalar share = adds ? of_memory : Scalar(1);
    mean_x_ += (x - mean_x_) * share;
    mean_y_ += (y - mean_y_) * share;
    return turned;
}

template <typename Scalar>
bool PathTurn<Scalar>::has_slowed(const Motion& motion) {
    using estimation::literal;
    constexpr Scalar lag = literal<Scalar>(0.05L);  // of F: the axes lag so far behind a rising override
    constexpr Scalar slow_share = literal<Scalar>(0.6L);
    constexpr Scalar at_speed_share = literal<Scalar>(0.8L);  // apart from slow_share, so that one braking counts once
    const Scalar expected_mm_s = (motion.override_ratio - lag) * motion.programmed_feed_mm_s;
    if (!(expected_mm_s > Scalar(0))) {
        return false;
    }
    if (was_at_speed_) {
        was_at_speed_ = !(motion.path_speed_mm_s < slow_share * expected_mm_s);
        return !was_at_speed_;
    }
    was_at_speed_ = motion.path_speed_mm_s > at_speed_share * expected_mm_s;
    return false;
}

}  // namespace millforce::control
