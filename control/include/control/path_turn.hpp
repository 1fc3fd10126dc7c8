// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/fixed_point.hpp"

/// Notices that the path turns sharply, so that what the tool has met says little about what it meets next: a step over
/// into the wall, a corner of a pocket.
///
/// Two signs, either suffices:
///   turned  the direction of travel v differs by more than 30° from its mean m over the last 0.5 mm,
///             v·m < 0  or  (v·m)² < cos² 30° |v|² |m|².    An arc of 2 mm radius and more turns by less.
///   slowed  the axes slow down to less than 60 % of what override and program ask for: a CNC brakes before a corner,
///           and so announces it before it comes. They count as up to speed again from 80 %.
///
/// If the tooth period is longer than a drive's velocity loop takes to settle (15 ms), each tooth shakes the axes. The
/// velocities are then low-passed; the time constant is twice the part of the tooth period above 15 ms.
///
/// Speeds in mm/s, of any sign; below 0.5 mm/s there is no direction. A NaN or an infinite velocity is no turn and is
/// not kept. Cost: some 40 operations, up to three divisions. Not thread-safe.

namespace millforce::control {

template <typename Scalar>
class PathTurn {
  public:
    struct Motion {
        Scalar dt_s{0};
        Scalar velocity_x_mm_s{0};
        Scalar velocity_y_mm_s{0};
        Scalar path_speed_mm_s{0};
        Scalar travel_mm{0};  ///< gone in dt_s
        Scalar override_ratio{0};
        Scalar programmed_feed_mm_s{0};  ///< F; 0: not known
        Scalar tooth_period_s{0};        ///< 0: not known
    };

    /// Whether a sharp turn is noticed in this step.
    [[nodiscard]] bool update(const Motion& motion);

  private:
    [[nodiscard]] Motion without_shaking(const Motion& motion);
    [[nodiscard]] bool has_turned(const Motion& motion);
    [[nodiscard]] bool has_slowed(const Motion& motion);

    Scalar average_x_mm_s_{0};  // over the teeth's shaking
    Scalar average_y_mm_s_{0};
    Scalar average_path_mm_s_{0};
    Scalar mean_x_{0};  // over the path: m, of which only the direction is used
    Scalar mean_y_{0};
    bool was_at_speed_ = false;
};

extern template class PathTurn<float>;
extern template class PathTurn<estimation::Fixed>;

}  // namespace millforce::control
