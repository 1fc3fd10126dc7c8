// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/drives/spindle_drive.hpp"
#include "estimation/engagement/engagement_estimate.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/phasor.hpp"

#include <cmath>

/// By how much more than the mean chip the tooth takes that stands out furthest, e, measured in the cut.
///
/// Where the cutter's axis lies off the spindle's, tooth k takes the chip f_z sin φ + Re(E e^(−2πik/N)), and the
/// tangential force gets a part that turns with the spindle. The edge force does not, so by the cutting force alone
/// (depth and K_s cancel; φ_m: middle of the arc, ψ: direction of the feed in machine axes)
///
///   F_1 = F_cut E/(f_z sin φ_m) e^(i(ψ − φ_m))
///   e   = |E| sin(π/N)/(π/N)          N > 2: the mean over all places of the axis, between |E| cos(π/N) and |E|
///   e   = |E|/2                       N = 2
///
/// F_1 is what current and encoder show: spindle_drive.hpp. In air the same signals show what the drive and the encoder
/// do by themselves once per revolution; at the same speed that is subtracted. E stands still in the tool, whatever the
/// cut: so it is averaged as a phasor, and noise far above it goes out. What the axes yield under F_1 is a part of E: a
/// slot at low speed has less of it than the cutter in its holder.
///
/// Until there is a measurement, and beside it as its doubt, e is what the tool's file states. Half of that always
/// stays: teeth may stand unequal in themselves, which this does not see.
///
/// A file that states 0 states it without a doubt: that is the variance of E to begin with and the measure of its walk,
/// so that the gain of every measurement is 0, and e is no more than the noise in air. A small runout that is not known
/// is stated as a small figure, not as 0.
///
/// A machine that knows the spindle's current alone never knows the arc. There the size of F_1 is averaged as if φ_m
/// were 90°: E/sin φ_m, which is what the thickest chip of a narrow arc has of it. It never counts as less than stated
/// there: nothing else is known of a tooth's share.
///
/// Valid: N ≥ 2, a known arc or the spindle alone, a steady speed, air at this speed before the cut; else nothing is
/// learnt. Where |E| is larger than the chip at the arc's middle, f_z sin φ_m, teeth miss the cut, their edge force
/// with them, and e is some 40 % off. Cost: a revolution some 40 operations, three roots and three divisions. No heap.
/// Not thread-safe.

namespace millforce::estimation {

template <typename Scalar>
class RunoutMeter {
  public:
    /// `stated_mm`: largest difference of two teeth's radii; 0: nothing is measured. `is_spindle_alone`: no arc will
    /// ever be known.
    RunoutMeter(Scalar stated_mm, int teeth, bool is_spindle_alone = false)
        : stated_um_(stated_mm * um_per_mm),
          can_measure_(teeth > 1),
          is_spindle_alone_(is_spindle_alone),
          variance_um2_(square(stated_um_)) {
        using elementary::sin;
        if (teeth > 2) {
            const Scalar half_pitch_rad = pi<Scalar> / Scalar(teeth);
            share_ = sin(half_pitch_rad) / half_pitch_rad;
        }
    }

    /// The tool turns in air.
    void learn_air(const TurningForce<Scalar>& seen) {
        if (!is_usable(seen)) {
            return;
        }
        const Scalar n = Scalar(seen.revolutions);
        const bool goes_on = is_near(seen.speed_rad_s, air_.speed_rad_s, same_speed);
        const Scalar before = goes_on ? air_revolutions_ : Scalar(0);
        air_revolutions_ = before + n < longest_air ? before + n : longest_air;
        const Scalar share = n < air_revolutions_ ? n / air_revolutions_ : Scalar(1);
        air_.force_N = goes_on ? air_.force_N + (seen.force_N - air_.force_N) * share : seen.force_N;
        air_.variance_N2 = seen.variance_N2 * share;
        air_.speed_rad_s = seen.speed_rad_s;
    }

    struct Cut {
        TurningForce<Scalar> turning{};
        Phasor<Scalar> feed_direction{};  ///< of length 1
        Scalar feed_per_tooth_mm{0};
        Scalar cutting_N{0};  ///< F_at without edge force
        EngagementEstimate<Scalar> engagement{};
    };

    /// The cut has been the same over these revolutions.
    void learn(const Cut& cut) {
        using std::sqrt;
        const EngagementEstimate<Scalar>& arc = cut.engagement;
        const bool knows_air =
            air_revolutions_ > Scalar(0) && is_near(cut.turning.speed_rad_s, air_.speed_rad_s, nearly_same_speed);
        const bool knows_arc = arc.immersion_valid && arc.side != CutSide::unknown && arc.radial_immersion > Scalar(0);
        if (!can_measure_ || !is_usable(cut.turning) || !knows_air || !(knows_arc || is_spindle_alone_) ||
            !(cut.cutting_N > least_cutting_N)) {
            return;
        }
        const Scalar half_immersion = knows_arc ? halved(arc.radial_immersion) : Scalar(1);  // sin² φ_m
        const Scalar sine = sqrt(half_immersion);
        const Scalar cosine = half_immersion < Scalar(1) ? sqrt(Scalar(1) - half_immersion) : Scalar(0);
        const Phasor<Scalar> middle{arc.side == CutSide::down ? -cosine : cosine, sine};
        const Scalar um_per_N = um_per_mm * cut.feed_per_tooth_mm * sine / cut.cutting_N;
        const Phasor<Scalar> of_tool_N = cut.turning.force_N - air_.force_N;
        const Phasor<Scalar> in_tool_N = knows_arc ? of_tool_N * conjugate(cut.feed_direction) * middle
                                                   : Phasor<Scalar>{sqrt(squared_length(of_tool_N)), Scalar(0)};
        const Scalar noise_um2 = cut.turning.variance_N2 * square(um_per_N);
        variance_um2_ += square(walk_share * stated_um_) * Scalar(cut.turning.revolutions);
        const Scalar gain = variance_um2_ / (variance_um2_ + noise_um2);
        off_axis_um_ += (in_tool_N * um_per_N - off_axis_um_) * gain;
        variance_um2_ -= gain * variance_um2_;
        air_variance_um2_ = air_.variance_N2 * square(um_per_N);
    }

    /// The angle's zero may be another one from now on: how large e is stays as its doubt.
    void lose_angle() {
        const Scalar largest_um = um_per_mm * largest_excess_mm();
        const Scalar doubt_um = largest_um > stated_um_ ? largest_um : stated_um_;
        variance_um2_ = square(doubt_um);
        off_axis_um_ = {};
        air_variance_um2_ = Scalar(0);
        air_revolutions_ = Scalar(0);
    }

    /// e with its deviation on top.
    [[nodiscard]] Scalar largest_excess_mm() const {
        using std::sqrt;
        const Scalar size2_um2 = squared_length(off_axis_um_);
        const Scalar doubt_um2 = variance_um2_ + air_variance_um2_ + square(model_share) * size2_um2;
        const Scalar measured_um = sqrt(size2_um2) * share_ + sqrt(doubt_um2);
        const Scalar least_um = is_spindle_alone_ ? stated_um_ : halved(stated_um_);
        return (measured_um > least_um ? measured_um : least_um) * mm_per_um;
    }

  private:
    static constexpr Scalar um_per_mm{1000};
    static constexpr Scalar mm_per_um = literal<Scalar>(0.001L);
    static constexpr Scalar same_speed = literal<Scalar>(0.02L);
    static constexpr Scalar nearly_same_speed = literal<Scalar>(0.05L);
    static constexpr Scalar longest_air{500};  // revolutions
    static constexpr Scalar least_cutting_N{1};
    static constexpr Scalar walk_share = literal<Scalar>(0.007L);  // of the stated runout, per root of a revolution
    static constexpr Scalar model_share = literal<Scalar>(0.1L);

    [[nodiscard]] static bool is_near(Scalar a, Scalar b, Scalar share) {
        const Scalar difference = a > b ? a - b : b - a;
        return difference < share * a;
    }
    [[nodiscard]] static bool is_usable(const TurningForce<Scalar>& seen) { return seen.revolutions > 0; }

    Scalar stated_um_;
    bool can_measure_;  // a single tooth takes all there is
    bool is_spindle_alone_;
    Scalar share_ = halved(Scalar(1));  // e/|E|
    TurningForce<Scalar> air_{};
    Scalar air_revolutions_{0};
    Phasor<Scalar> off_axis_um_{};  // E
    Scalar variance_um2_;           // of each component
    Scalar air_variance_um2_{0};
};

}  // namespace millforce::estimation
