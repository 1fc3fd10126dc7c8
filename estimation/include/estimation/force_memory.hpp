#pragma once

#include "estimation/engagement_solver.hpp"
#include "estimation/measurement.hpp"

#include <cmath>

namespace millforce::estimation {

/// Averages over as many revolutions as the cut stays the same.
///
/// Forces of earlier revolutions are carried to the present feed, F ∝ f^m, and averaged with the present ones as long as
/// every force agrees with its memory within `agreement` standard deviations of their noise and the feed keeps its
/// direction. Where one does not, the cut has changed and the memory starts anew: no lag behind a change, little noise
/// without one. Only noise shrinks by averaging; what is common to all windows (gain, friction, drift) stays whole.
template <typename Scalar>
class ForceMemory {
  public:
    void clear() { revolutions_ = Scalar(0); }

    /// The present forces, averaged with what the memory holds of the same cut. `is_new_revolution`: these forces share
    /// no sample with those remembered last, and are remembered. `exponent`: m.
    AverageForceMeasurement<Scalar> blend(const AverageForceMeasurement<Scalar>& now, Scalar feed_mm_s, Scalar exponent,
                                          bool is_new_revolution) {
        const Scalar carried = revolutions_ > Scalar(0) ? carried_by(feed_mm_s_, feed_mm_s, exponent) : Scalar(1);
        if (revolutions_ > Scalar(0) && !is_same_cut(now, carried)) {
            clear();
        }
        if (!(revolutions_ > Scalar(0))) {
            remember(now, feed_mm_s, Scalar(1));
            return now;
        }
        carry(carried);
        feed_mm_s_ = feed_mm_s;
        AverageForceMeasurement<Scalar> mixed = now;
        const Scalar share = Scalar(1) / (revolutions_ + Scalar(1));
        mix(mixed.tangential_N, held_.tangential_N, share);
        mix(mixed.x_N, held_.x_N, share);
        mix(mixed.y_N, held_.y_N, share);
        if (is_new_revolution) {
            const Scalar most = static_cast<Scalar>(longest_revolutions);
            remember(mixed, feed_mm_s, revolutions_ + Scalar(1) < most ? revolutions_ + Scalar(1) : most);
        }
        return mixed;
    }

    /// The tangential force tells of no change: it agrees with a memory of two revolutions or more, as it is.
    [[nodiscard]] bool holds(const Measurement<Scalar>& tangential_N) const {
        return revolutions_ > Scalar(1) && agrees(tangential_N, held_.tangential_N, Scalar(1), allowed_per_noise_);
    }

    [[nodiscard]] Scalar revolutions() const { return revolutions_; }

  private:
    static constexpr int longest_revolutions = 8;
    static constexpr Scalar agreement = static_cast<Scalar>(3);

    [[nodiscard]] static bool agrees(const Measurement<Scalar>& now, const Measurement<Scalar>& held, Scalar carried,
                              Scalar allowed_per_noise) {
        if (now.valid != held.valid) {
            return false;
        }
        return !now.valid || square(now.value - held.value * carried) <= allowed_per_noise * now.noise;
    }

    [[nodiscard]] static Scalar carried_by(Scalar from_feed, Scalar to_feed, Scalar exponent) {
        using elementary::exp;
        using elementary::log;
        return from_feed > Scalar(0) && to_feed > Scalar(0) ? exp(exponent * log(to_feed / from_feed)) : Scalar(1);
    }

    [[nodiscard]] bool is_same_cut(const AverageForceMeasurement<Scalar>& now, Scalar carried) const {
        const Scalar along = now.feed_direction_x * held_.feed_direction_x + now.feed_direction_y * held_.feed_direction_y;
        const Scalar allowed = allowed_per_noise_;
        return along > static_cast<Scalar>(0.998L) && agrees(now.tangential_N, held_.tangential_N, carried, allowed) &&
               agrees(now.x_N, held_.x_N, carried, allowed) && agrees(now.y_N, held_.y_N, carried, allowed);
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
        }
    }

    void remember(const AverageForceMeasurement<Scalar>& forces, Scalar feed_mm_s, Scalar revolutions) {
        held_ = forces;
        feed_mm_s_ = feed_mm_s;
        revolutions_ = revolutions;
        allowed_per_noise_ = square(agreement) * (Scalar(1) + Scalar(1) / revolutions);
    }

    AverageForceMeasurement<Scalar> held_{};
    Scalar feed_mm_s_{0};
    Scalar revolutions_{0};
    Scalar allowed_per_noise_{0};  // square of how far a force may be from its memory, over the variance of its noise
};

}  // namespace millforce::estimation
