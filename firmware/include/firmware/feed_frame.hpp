// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"

namespace millforce::firmware {

/// The feed's frame, x along the feed and y its normal, from the velocities of machine x and y.
///
/// The direction is that of the velocity over the last quarter of a second, for a drive gives way to each tooth. It is
/// followed sample by sample; once it has turned by more than 3° since the frame was taken, the frame is a new one, and
/// averages must start again. φ grows from the frame's +y to its +x: a frame turned by the feed's direction
/// counter-clockwise sees each tooth that much further on. One division and one root a sample. Not thread-safe.
template <typename Scalar>
class FeedFrame {
  public:
    static constexpr Scalar slowest_mm_s = estimation::literal<Scalar>(0.1L);
    static constexpr Scalar averaging_s = estimation::literal<Scalar>(0.25L);

    struct Pose {
        bool valid = false;   ///< the feed moves
        bool is_new = false;  ///< not the frame of the last sample
        Scalar cosine{1};
        Scalar sine{0};
        Scalar direction_rev{0};  ///< direction of the feed, from +x to +y
        Scalar speed_mm_s{0};

        [[nodiscard]] Scalar along(Scalar x, Scalar y) const { return cosine * x + sine * y; }
        [[nodiscard]] Scalar across(Scalar x, Scalar y) const { return cosine * y - sine * x; }
    };

    void restart() {
        has_velocity_ = false;
        has_frame_ = false;
    }

    Pose update(Scalar dt_s, Scalar x_velocity_mm_s, Scalar y_velocity_mm_s) {
        using std::sqrt;
        if (has_velocity_ && dt_s < averaging_s) {
            const Scalar share = dt_s / averaging_s;
            x_mm_s_ += (x_velocity_mm_s - x_mm_s_) * share;
            y_mm_s_ += (y_velocity_mm_s - y_mm_s_) * share;
        } else {
            x_mm_s_ = x_velocity_mm_s;
            y_mm_s_ = y_velocity_mm_s;
        }
        has_velocity_ = true;
        Pose pose;
        pose.speed_mm_s = sqrt(estimation::square(x_mm_s_) + estimation::square(y_mm_s_));
        if (!(pose.speed_mm_s >= slowest_mm_s)) {
            restart();
            return pose;
        }
        pose.valid = true;
        pose.cosine = x_mm_s_ / pose.speed_mm_s;
        pose.sine = y_mm_s_ / pose.speed_mm_s;
        take_direction(pose);
        return pose;
    }

  private:
    static constexpr Scalar widest = estimation::literal<Scalar>(0.0523L);  // sin 3°
    static constexpr Scalar whole_turn = Scalar(2) * estimation::pi<Scalar>;

    void take_direction(Pose& pose) {
        using std::atan2;
        const Scalar turned = cosine_ * pose.sine - sine_ * pose.cosine;
        const bool ahead = cosine_ * pose.cosine + sine_ * pose.sine > Scalar(0);
        pose.is_new = !has_frame_ || !ahead || estimation::square(turned) > estimation::square(widest);
        if (pose.is_new) {
            cosine_ = pose.cosine;
            sine_ = pose.sine;
            direction_rad_ = atan2(pose.sine, pose.cosine);
            has_frame_ = true;
        }
        // Within 3° the angle is its sine.
        pose.direction_rev = (direction_rad_ + (pose.is_new ? Scalar(0) : turned)) / whole_turn;
    }

    Scalar x_mm_s_{0};
    Scalar y_mm_s_{0};
    Scalar cosine_{1};
    Scalar sine_{0};
    Scalar direction_rad_{0};
    bool has_velocity_ = false;
    bool has_frame_ = false;
};

}  // namespace millforce::firmware
