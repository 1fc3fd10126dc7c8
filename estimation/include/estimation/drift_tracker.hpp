#pragma once

#include "estimation/measurement.hpp"

namespace millforce::estimation {

/// A slowly drifting quantity seen through noise: a scalar Kalman filter with a random walk as its model.
///
///   P ← P + q dt,   k = P/(P + R),   x ← x + k (z − x),   P ← (1 − k) P
///
/// The spindle's idle torque (temperature) and a feed drive's friction (lubrication, temperature) are tracked with it
/// while the tool is in air. Between updates the variance grows, so that an estimate made long after the last
/// re-zeroing says so. Starts on its given value and variance, not on zero.
template <typename Scalar>
class DriftTracker {
  public:
    DriftTracker() = default;
    /// `walk_variance_per_s`: variance gained per second without a measurement; `variance_limit`: where it stops.
    DriftTracker(Scalar start, Scalar start_variance, Scalar walk_variance_per_s)
        : value_(start),
          variance_(start_variance),
          variance_limit_(start_variance),
          walk_variance_per_s_(walk_variance_per_s) {}

    void predict(Scalar dt_s) {
        variance_ += walk_variance_per_s_ * dt_s;
        if (variance_ > variance_limit_) {
            variance_ = variance_limit_;
        }
    }

    void correct(Measurement<Scalar> seen) {
        const Scalar total = variance_ + seen.variance;
        if (!seen.valid || !(total > Scalar(0))) {
            return;
        }
        const Scalar gain = variance_ / total;
        value_ += gain * (seen.value - value_);
        variance_ -= gain * variance_;
    }

    [[nodiscard]] Scalar value() const { return value_; }
    [[nodiscard]] Scalar variance() const { return variance_; }

  private:
    Scalar value_{0};
    Scalar variance_{0};
    Scalar variance_limit_{0};
    Scalar walk_variance_per_s_{0};
};

}  // namespace millforce::estimation
