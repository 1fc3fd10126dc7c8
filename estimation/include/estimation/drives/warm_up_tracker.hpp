// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/drives/learnt_in_air.hpp"

namespace millforce::estimation {

/// A drifting quantity that also relaxes while the machine warms up: a Kalman filter of two states,
///
///   x = b + w,   b a random walk,   dw/dt = −w/τ,
///
/// b the offset, w what is left of the cold machine's excess. One measurement in air sees only their sum; measurements
/// at different times separate them. Without a second one the excess falls as its calibration says, with the
/// uncertainty stated there. So an idle torque that was zeroed before a long cut does not keep the value of a cold
/// bearing.
///
///   b: P_bb ← P_bb + q dt, at most its start value;   w ← φ w, P_bw ← φ P_bw, P_ww ← φ² P_ww, φ = 1 − dt/τ, dt < τ/2
///   k = (P_bb + P_bw, P_bw + P_ww) / (P_bb + 2 P_bw + P_ww + R),   x ← x + k (z − x)
///
/// τ = 0: no warm-up is known, w stays 0. predict() is meant for steps of milliseconds to seconds: a step far below the
/// scalar's resolution of τ is lost. Cost: some ten multiplications. Not thread-safe.
template <typename Scalar>
class WarmUpTracker {
  public:
    struct Settings {
        Scalar offset_sd{0};            ///< deviation of b at the start
        Scalar walk_variance_per_s{0};  ///< q
        Scalar excess{0};               ///< w at the start: cold minus warm
        Scalar excess_sd{0};        ///< a machine may be half warm when the controller starts: not far below the excess
        Scalar time_constant_s{0};  ///< τ; 0: no warm-up is known
    };

    WarmUpTracker() = default;
    explicit WarmUpTracker(const Settings& settings) : settings_(settings), P_bb_(square(settings.offset_sd)) {
        if (settings.time_constant_s > Scalar(0)) {
            w_ = settings.excess;
            P_ww_ = square(settings.excess_sd);
        }
    }

    void predict(Scalar dt_s) {
        widen(settings_.walk_variance_per_s * dt_s);
        if (!(settings_.time_constant_s > Scalar(0))) {
            return;
        }
        const Scalar fall = dt_s / settings_.time_constant_s;
        constexpr Scalar least_kept = Scalar(0.5F);  // of a step, so that a long one does not change the sign
        const Scalar kept = fall < least_kept ? Scalar(1) - fall : least_kept;
        w_ *= kept;
        P_bw_ *= kept;
        P_ww_ *= square(kept);
    }

    /// b is less well known by so much, at most as little as at the start.
    void widen(Scalar variance) {
        const Scalar most = square(settings_.offset_sd);
        P_bb_ += variance;
        P_bb_ = P_bb_ < most ? P_bb_ : most;
    }

    /// Whether a measurement in air lies within what the calibration leaves open.
    [[nodiscard]] bool is_within_doubt(const Measurement<Scalar>& seen) const {
        return seen.valid && may_be_learnt_in_air(seen.value - w_, square(settings_.offset_sd) + P_ww_ + seen.variance);
    }

    void correct(Measurement<Scalar> seen) {
        const Scalar by_b = P_bb_ + P_bw_;
        const Scalar by_w = P_bw_ + P_ww_;
        const Scalar total = by_b + by_w + seen.variance;
        if (!seen.valid || !(total > Scalar(0))) {
            return;
        }
        const Scalar innovation = (seen.value - value()) / total;
        b_ += by_b * innovation;
        w_ += by_w * innovation;
        P_bb_ -= square(by_b) / total;
        P_bw_ -= by_b * by_w / total;
        P_ww_ -= square(by_w) / total;
        P_bb_ = P_bb_ > Scalar(0) ? P_bb_ : Scalar(0);
        P_ww_ = P_ww_ > Scalar(0) ? P_ww_ : Scalar(0);
    }

    [[nodiscard]] Scalar value() const { return b_ + w_; }
    [[nodiscard]] Scalar variance() const {
        const Scalar sum = P_bb_ + Scalar(2) * P_bw_ + P_ww_;
        return sum > Scalar(0) ? sum : Scalar(0);
    }
    [[nodiscard]] Scalar offset() const { return b_; }
    [[nodiscard]] Scalar excess() const { return w_; }

  private:
    Settings settings_{};
    Scalar b_{0};
    Scalar w_{0};
    Scalar P_bb_{0};
    Scalar P_bw_{0};
    Scalar P_ww_{0};
};

}  // namespace millforce::estimation
