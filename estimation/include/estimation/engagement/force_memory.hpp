// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/engagement/engagement_estimate.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"

#include <cmath>

namespace millforce::estimation {

/// The same straight move of the path: within 3.6 degrees.
template <typename Scalar>
[[nodiscard]] constexpr bool feed_in_one_direction(const AverageForceMeasurement<Scalar>& a,
                                                   const AverageForceMeasurement<Scalar>& b) {
    const Scalar along = a.feed_direction_x * b.feed_direction_x + a.feed_direction_y * b.feed_direction_y;
    constexpr Scalar cosine_of_widest = literal<Scalar>(0.998L);
    return along > cosine_of_widest;
}

/// Averages over as many revolutions as the cut stays the same.
///
/// Forces of earlier revolutions are carried to the present feed, F ∝ f^m, and averaged with the present ones. The
/// memory fades with disagreement: a force within two standard deviations of its noise leaves it whole, one at four
/// deviations or a feed in another direction leaves nothing, and it starts again: no lag after a change, little noise
/// without one. In between it fades quadratically, so rounding cannot tip the result. Only noise shrinks by averaging;
/// what is common to all windows (gain, friction, drift) stays whole.
template <typename Scalar>
class ForceMemory {
  public:
    /// Averages the present forces with what the memory holds of the same cut. `is_new_revolution`: these forces share
    /// no sample with those remembered last, and are remembered. `exponent`: m.
    void blend(AverageForceMeasurement<Scalar>& now, Scalar feed_mm_s, Scalar exponent, bool is_new_revolution) {
        const Scalar carried = carried_by(feed_mm_s_, feed_mm_s, exponent);
        if (revolutions_ > Scalar(0)) {
            revolutions_ *= share_of_same_cut(now, carried);
        }
        if (revolutions_ < forgotten_revolutions) {
            remember(now, feed_mm_s, Scalar(1));
            return;
        }
        carry(carried);
        feed_mm_s_ = feed_mm_s;
        const Scalar share = Scalar(1) / (revolutions_ + Scalar(1));
        mix(now.tangential_N, held_.tangential_N, share);
        mix(now.x_N, held_.x_N, share);
        mix(now.y_N, held_.y_N, share);
        if (is_new_revolution) {
            const Scalar most = static_cast<Scalar>(longest_revolutions);
            remember(now, feed_mm_s, revolutions_ + Scalar(1) < most ? revolutions_ + Scalar(1) : most);
        }
    }

    [[nodiscard]] Scalar revolutions() const { return revolutions_; }

  private:
    static constexpr int longest_revolutions = 8;
    static constexpr Scalar forgotten_revolutions = literal<Scalar>(0.01L);
    static constexpr Scalar whole_deviations = Scalar(2);
    static constexpr Scalar nothing_deviations = Scalar(4);

    /// Variance of a force's difference from its memory, over the variance of its noise.
    [[nodiscard]] Scalar variance_per_noise() const { return Scalar(1) + Scalar(1) / revolutions_; }

    [[nodiscard]] static Scalar share_of_agreement(const Measurement<Scalar>& now, const Measurement<Scalar>& held,
                                                   Scalar carried, Scalar per_noise) {
        if (!now.valid || !held.valid) {
            return now.valid == held.valid ? Scalar(1) : Scalar(0);
        }
        constexpr Scalar whole = square(whole_deviations);
        constexpr Scalar nothing = square(nothing_deviations);
        const Scalar off = square(now.value - held.value * carried);
        const Scalar variance = per_noise * now.noise;
        if (off <= whole * variance) {
            return Scalar(1);
        }
        return off < nothing * variance ? (nothing - off / variance) / (nothing - whole) : Scalar(0);
    }

    [[nodiscard]] static Scalar carried_by(Scalar from_feed, Scalar to_feed, Scalar exponent) {
        using elementary::exp;
        using elementary::log;
        return from_feed > Scalar(0) && to_feed > Scalar(0) ? exp(exponent * log(to_feed / from_feed)) : Scalar(1);
    }

    [[nodiscard]] Scalar share_of_same_cut(const AverageForceMeasurement<Scalar>& now, Scalar carried) const {
        if (!feed_in_one_direction(now, held_)) {
            return Scalar(0);
        }
        const Scalar per_noise = variance_per_noise();
        return share_of_agreement(now.tangential_N, held_.tangential_N, carried, per_noise) *
               share_of_agreement(now.x_N, held_.x_N, carried, per_noise) *
               share_of_agreement(now.y_N, held_.y_N, carried, per_noise);
    }

    void carry(Scalar carried) {
        held_.tangential_N.value *= carried;
        held_.x_N.value *= carried;
        held_.y_N.value *= carried;
    }

    static void mix(Measurement<Scalar>& now, const Measurement<Scalar>& held, Scalar share) {
        if (now.valid) {
            now.value = held.value + (now.value - held.value) * share;
            now.variance -= now.noise * (Scalar(1) - share);
            const Scalar of_held = held.variance * (Scalar(1) - share);  // doubt fades no faster than its revolutions
            now.variance = now.variance > of_held ? now.variance : of_held;
        }
    }

    void remember(const AverageForceMeasurement<Scalar>& forces, Scalar feed_mm_s, Scalar revolutions) {
        held_ = forces;
        feed_mm_s_ = feed_mm_s;
        revolutions_ = revolutions;
    }

    AverageForceMeasurement<Scalar> held_{};
    Scalar feed_mm_s_{0};  // 0: nothing is held
    Scalar revolutions_{0};
};

}  // namespace millforce::estimation
