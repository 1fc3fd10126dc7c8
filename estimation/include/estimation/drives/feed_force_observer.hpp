// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"

/// Force of the cut along one feed axis, sample by sample, for what happens within a tooth period.
///
///   F(t) + friction = K_x4 I(t) − M (v(t + dt) − v(t − dt)) / 2dt
///
/// The current alone follows the force only as fast as the velocity loop (some 60 Hz), and overshoots. Together with
/// the acceleration, from the velocity that the drive reports, the loop drops out: what is left is the smear of the
/// difference over two sample intervals, a low-pass of 0.44/2dt (220 Hz at 1 kHz), ζ = 1/√2 (LowPassResponse).
///
/// Friction stays in: it is constant while the axis slides in one direction, and the zero between two teeth takes it
/// off (AirGap). An axis that stands or turns round hides force in static friction: no force while its velocity is
/// below `least_velocity_mm_s` in the direction of travel, which is the sign of the mean velocity that the caller
/// gives. The force belongs to the sample before the one added: one interval of delay. Float; 6 scalars; 8 operations.

namespace millforce::estimation {

template <typename Scalar>
struct FeedForceObserverSettings {
    Scalar K_x4_N_per_A{0};
    Scalar mass_kg{0};
    Scalar least_velocity_mm_s{literal<Scalar>(0.02L)};  ///< a slower axis counts as standing
};

template <typename Scalar>
class FeedForceObserver {
  public:
    explicit FeedForceObserver(const FeedForceObserverSettings<Scalar>& settings = {}) : settings_(settings) {}

    void restart() { seen_ = 0; }

    /// Force on the workpiece along the axis, friction included, at the sample before this one. `travel`: +1 or −1.
    Measurement<Scalar> add(Scalar dt_s, Scalar current_A, Scalar velocity_mm_s, Scalar travel) {
        Measurement<Scalar> force;
        const bool slides = velocity_mm_s * travel >= settings_.least_velocity_mm_s;
        if (!slides || !(dt_s > Scalar(0))) {
            seen_ = 0;
            return force;
        }
        if (seen_ >= 2) {
            const Scalar acceleration_mm_s2 = (velocity_mm_s - before_last_mm_s_) / (dt_s + last_dt_s_);
            constexpr Scalar m_per_mm = literal<Scalar>(0.001L);
            force.valid = true;
            force.value = settings_.K_x4_N_per_A * last_A_ - settings_.mass_kg * acceleration_mm_s2 * m_per_mm;
        }
        seen_ += seen_ < 2 ? 1 : 0;
        before_last_mm_s_ = last_mm_s_;
        last_mm_s_ = velocity_mm_s;
        last_A_ = current_A;
        last_dt_s_ = dt_s;
        return force;
    }

  private:
    FeedForceObserverSettings<Scalar> settings_;
    Scalar before_last_mm_s_{0};
    Scalar last_mm_s_{0};
    Scalar last_A_{0};
    Scalar last_dt_s_{0};
    int seen_ = 0;
};

}  // namespace millforce::estimation
