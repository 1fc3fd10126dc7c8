#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "cnc/move.hpp"

namespace millforce::sim {

struct CncSettings {
    double servo_period_s = 0.25e-3;
    double acceleration_mm_s2 = 2000.0;
    double override_latency_s = 0.010;   ///< from the override's arrival to the first change of commanded velocity
    double rapid_feed_mm_s = 250.0;
    double junction_deviation_mm = 0.01; ///< how far a corner may be cut: sets the speed through it
    double spindle_wait_s = 0.5;         ///< after a change of S, M3, M5 before the next feed move
};

/// The CNC's path velocity: programmed feed times override, behind a latency, under an acceleration limit, with
/// look-ahead for corners, arcs, slower blocks and the end.
///
/// In each servo period the velocity is the largest that
///  - changes by no more than a·dt,
///  - does not exceed F × override (rapids: never more than programmed), nor √(a r) on an arc,
///  - still lets the velocity fall to every later limit: v² ≤ v_limit² + 2 a d, over the blocks within braking distance.
/// A corner of angle θ between two blocks may be passed at v² = a δ sin(θ/2)/(1 − sin(θ/2)), δ the junction deviation.
/// An override that is not finite, or negative, counts as 0; so does a feed hold. Work per step is bounded: at most
/// 256 blocks are looked at, and the velocity is such that they suffice.
class Cnc {
  public:
    Cnc(const CncSettings& settings, std::vector<Move> moves);

    /// Advances by one servo period.
    void step(double override_ratio, bool feed_hold);

    [[nodiscard]] Eigen::Vector3d position_mm() const;
    [[nodiscard]] Eigen::Vector3d direction() const;
    [[nodiscard]] double feed_mm_s() const { return velocity_mm_s_; }
    [[nodiscard]] double programmed_feed_mm_s() const;
    [[nodiscard]] bool is_rapid() const;
    [[nodiscard]] double spindle_speed_rad_s() const;
    [[nodiscard]] std::size_t line() const;
    [[nodiscard]] double path_mm() const { return path_mm_; }        ///< travelled since the start
    [[nodiscard]] double total_path_mm() const { return total_mm_; }
    [[nodiscard]] bool finished() const { return index_ >= moves_.size(); }
    [[nodiscard]] const CncSettings& settings() const { return settings_; }

  private:
    struct Block {
        double length_mm;
        double limit_mm_s;     ///< of its own, without override: feed, rapid feed, arc
        double junction_mm_s;  ///< through the corner at its end
    };
    void prepare();
    [[nodiscard]] double block_limit(std::size_t index, double override_ratio) const;
    [[nodiscard]] double velocity_limit(double override_ratio) const;
    double delayed(double override_ratio);
    void advance(double distance_mm);
    [[nodiscard]] const Move& move() const { return moves_[index_ < moves_.size() ? index_ : moves_.size() - 1]; }

    CncSettings settings_;
    std::vector<Move> moves_;
    std::vector<Block> blocks_;
    std::vector<double> override_line_;  // as many servo periods as the latency is long
    std::size_t override_place_ = 0;
    std::size_t index_ = 0;
    double along_mm_ = 0.0;
    double path_mm_ = 0.0;
    double total_mm_ = 0.0;
    double velocity_mm_s_ = 0.0;
    double wait_s_ = 0.0;
};

}  // namespace millforce::sim
