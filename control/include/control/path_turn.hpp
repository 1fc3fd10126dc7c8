// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Notices that the path turns sharply, so that what the tool has met says little about what it meets next: a step over
/// into the wall, a corner of a pocket.
///
/// Two signs, either suffices:
///  - the direction of travel differs by more than 30° from its mean over the last 0.5 mm. An arc of 2 mm radius and
///    more turns by less;
///  - the axes slow down to less than 60 % of what override and program ask for: a CNC brakes before a corner, and so
///    tells of it before it comes. (A twentieth of F is left for its lag behind a rising override.)
/// Teeth that pass more slowly than a drive's velocity loop settles (15 ms) shake the axes, each of them: the
/// velocities are averaged over twice what their period has beyond that. Speeds in mm/s, of any sign; below 0.5 mm/s
/// there is no direction. Some thirty operations. Not thread-safe.

namespace millforce::control {

template <typename Scalar>
class PathTurn {
  public:
    struct Motion {
        Scalar dt_s{0};
        Scalar velocity_x_mm_s{0};
        Scalar velocity_y_mm_s{0};
        Scalar path_speed_mm_s{0};
        Scalar way_mm{0};  ///< gone in dt_s
        Scalar override_ratio{0};
        Scalar programmed_feed_mm_s{0};  ///< F; 0: not known
        Scalar tooth_period_s{0};        ///< 0: not known
    };

    /// Whether a sharp turn is noticed in this step.
    bool update(const Motion& measured) {
        constexpr Scalar settling_s = static_cast<Scalar>(0.015L);
        const Scalar beyond_s = measured.tooth_period_s - settling_s;
        const Scalar over_s = beyond_s + beyond_s;
        Motion motion = measured;
        if (over_s > measured.dt_s) {
            follow({measured.velocity_x_mm_s, measured.velocity_y_mm_s, measured.path_speed_mm_s},
                   measured.dt_s / over_s);
            motion.velocity_x_mm_s = smooth_.x_mm_s;
            motion.velocity_y_mm_s = smooth_.y_mm_s;
            motion.path_speed_mm_s = smooth_.path_mm_s;
            motion.way_mm = motion.path_speed_mm_s * motion.dt_s;
        } else {
            smooth_ = {measured.velocity_x_mm_s, measured.velocity_y_mm_s, measured.path_speed_mm_s};
        }
        const bool slowed = has_slowed(motion);
        return has_turned(motion) || slowed;
    }

  private:
    struct Velocity {
        Scalar x_mm_s{0};
        Scalar y_mm_s{0};
        Scalar path_mm_s{0};
    };

    [[gnu::noinline]] void follow(Velocity now, Scalar share) {
        follow(smooth_.x_mm_s, now.x_mm_s, share);
        follow(smooth_.y_mm_s, now.y_mm_s, share);
        follow(smooth_.path_mm_s, now.path_mm_s, share);
    }

    /// What is no number passes through and does not stay.
    static void follow(Scalar& smooth, Scalar now, Scalar share) {
        const Scalar next = smooth + (now - smooth) * share;
        smooth = next - next == Scalar(0) ? next : now;
    }

    bool has_turned(const Motion& m) {
        const Scalar v2 = m.velocity_x_mm_s * m.velocity_x_mm_s + m.velocity_y_mm_s * m.velocity_y_mm_s;
        if (!(v2 > static_cast<Scalar>(0.25L)) || !(m.path_speed_mm_s > Scalar(0))) {
            return false;
        }
        // v weighted by the way gone: only its direction is used, so |v| may stay in it.
        const Scalar off_x = m.velocity_x_mm_s - mean_x_;
        const Scalar off_y = m.velocity_y_mm_s - mean_y_;
        // Within |v| sin 30° of the mean: no turn, and what is usual.
        const bool is_near = off_x * off_x + off_y * off_y < static_cast<Scalar>(0.2499L) * v2;
        const bool known = is_near || mean_x_ * mean_x_ + mean_y_ * mean_y_ > Scalar(0);
        const bool turned = !is_near && known && is_beyond_30_degrees(m, v2);
        const Scalar of_memory = m.way_mm + m.way_mm;  // 0.5 mm
        const Scalar taken = known && !turned && of_memory < Scalar(1) ? of_memory : Scalar(1);
        mean_x_ += off_x * taken;
        mean_y_ += off_y * taken;
        return turned;
    }

    [[nodiscard]] bool is_beyond_30_degrees(const Motion& m, Scalar v2) const {
        constexpr Scalar cos2_of_turn = static_cast<Scalar>(0.75L);
        const Scalar along = m.velocity_x_mm_s * mean_x_ + m.velocity_y_mm_s * mean_y_;
        const Scalar mean2 = mean_x_ * mean_x_ + mean_y_ * mean_y_;
        // along² < cos² v² mean², without a fourth power: that of a rapid is beyond the range of fixed point.
        return along < Scalar(0) || along * (along / mean2) < cos2_of_turn * v2;
    }

    bool has_slowed(const Motion& m) {
        constexpr Scalar lag = static_cast<Scalar>(0.05L);
        const Scalar expected = (m.override_ratio - lag) * m.programmed_feed_mm_s;
        if (!(expected > Scalar(0))) {
            return false;
        }
        if (was_at_speed_) {
            was_at_speed_ = !(m.path_speed_mm_s < static_cast<Scalar>(0.6L) * expected);
            return !was_at_speed_;
        }
        was_at_speed_ = m.path_speed_mm_s > static_cast<Scalar>(0.8L) * expected;
        return false;
    }

    Velocity smooth_{};
    Scalar mean_x_{0};
    Scalar mean_y_{0};
    bool was_at_speed_ = false;
};

}  // namespace millforce::control
