// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "cnc/move.hpp"
#include "cnc/path_limits.hpp"

namespace millforce::sim {

/// A scenario sets acceleration and latency from its machine file.
struct CncSettings {
    double servo_period_s = 0.25e-3;      ///< 1e-6…0.1
    double acceleration_mm_s2 = 2000.0;   ///< along the path and across it (arcs, corners); 1…1e6
    double override_latency_s = 0.010;    ///< from the override's arrival to the first change of velocity; 0…10
    double rapid_feed_mm_s = 250.0;       ///< feed of G0, and the largest of any move; 0.1…1e5
    double junction_deviation_mm = 0.01;  ///< how far a corner may be cut: sets the speed through it; 1e-6…10
    double spindle_wait_s = 0.5;          ///< after a change of S, M3, M5 before the next move; 0…60
};

/// The CNC's path velocity: programmed feed times override, behind a latency, under an acceleration limit, with
/// look-ahead for corners, arcs, slower blocks and the end.
///
/// In each servo period dt the velocity v is the largest that
///  - differs from the one before by no more than a·dt,
///  - does not exceed F × override (rapids: never more than the rapid feed), nor √(a r) on an arc,
///  - lets full braking meet each limit v_l at the distance d ahead: v² + 2 a dt v ≤ v_l² + 2 a d, which is
///    v² ≤ v_l² + 2 a d at the end of this period. So a limit that begins at a block's end is kept from its first
///    micrometre on, without overshoot. See PathLimits for the corners.
/// Only one thing cannot be foreseen: an override that falls. Then v exceeds F × override for as long as full braking
/// takes, and that may reach into the next block. Corners and arcs do not depend on it and hold even then.
///
/// An override that is not finite, or negative, counts as 0; so does a feed hold. A dwell and a spindle's wait run on
/// during a hold. Moves end exactly where they should; with an override that stays above 0 every program ends.
///
/// Cost: one pass over the moves at the start (40 bytes each in addition to the moves); a step looks at the blocks that
/// it passes and at most 256 changes of the programmed feed within the braking distance (beyond them it is ready to
/// stop). Not for several threads at once.
class Cnc {
  public:
    /// Throws InputError if there is no move, a move that no machine can run, or a setting out of its range.
    Cnc(const CncSettings& settings, std::vector<Move> moves);

    /// Advances by one servo period.
    void step(double override_ratio, bool feed_hold);

    [[nodiscard]] Eigen::Vector3d position_mm() const;
    [[nodiscard]] Eigen::Vector3d direction() const;  ///< tangent at the position, zero in a dwell and at the end
    [[nodiscard]] double feed_mm_s() const { return velocity_mm_s_; }
    [[nodiscard]] double programmed_feed_mm_s() const;
    [[nodiscard]] bool is_rapid() const;
    [[nodiscard]] double spindle_speed_rad_s() const;
    [[nodiscard]] std::size_t line() const;
    [[nodiscard]] double distance_to_go_mm() const;            ///< to the end of the block in work, along it
    [[nodiscard]] double path_mm() const { return path_mm_; }  ///< travelled since the start
    [[nodiscard]] double total_path_mm() const { return limits_.total_mm(); }
    [[nodiscard]] bool finished() const { return index_ >= moves_.size(); }
    [[nodiscard]] bool waiting() const { return wait_periods_ > 0; }  ///< true in a dwell, or for the spindle
    [[nodiscard]] const CncSettings& settings() const { return settings_; }

  private:
    [[nodiscard]] double feed_limit(std::size_t index, double override_ratio) const;
    [[nodiscard]] double approach(double limit_mm_s, double distance_mm) const;
    [[nodiscard]] double limit_by_geometry(double limit_mm_s) const;
    [[nodiscard]] double limit_by_feeds(double limit_mm_s, double override_ratio) const;
    double delayed(double override_ratio);
    void advance(double distance_mm);
    void enter_next_block();
    void wait(double time_s);
    [[nodiscard]] const Move& move() const { return moves_[index_ < moves_.size() ? index_ : moves_.size() - 1]; }

    CncSettings settings_;
    std::vector<Move> moves_;
    PathLimits limits_;
    double velocity_step_mm_s_;          // a·dt
    std::vector<double> override_line_;  // as many servo periods as the latency is long
    std::size_t override_place_ = 0;
    std::size_t index_ = 0;
    double along_mm_ = 0.0;
    double path_mm_ = 0.0;
    double velocity_mm_s_ = 0.0;
    long wait_periods_ = 0;
};

}  // namespace millforce::sim
