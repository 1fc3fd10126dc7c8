// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/circle.hpp"
#include "estimation/number/literal.hpp"

#include <cmath>

/// How a force sensor or a drive smears a jump of force: a low-pass of second order,
///
///   H(s) = ω² / (s² + 2ζω s + ω²),   ω = 2π · corner_hz,   0.2 ≤ ζ < 1
///
/// in closed form for a step and for a ramp that start at t = 0. ζ = 1/√2 is the Butterworth filter of a charge
/// amplifier, with its −3 dB point at corner_hz. Both are 0 before t = 0.
/// Cost: one exponential, a sine and a cosine per call.

namespace millforce::estimation {

template <typename Scalar>
struct LowPassResponse {
    Scalar corner_hz{300};
    Scalar damping{literal<Scalar>(0.70710678118654752L)};  ///< ζ = 1/√2: Butterworth

    struct At {
        Scalar step{0};    ///< response to a step of 1 from t = 0
        Scalar ramp_s{0};  ///< response to a ramp t from t = 0, in seconds
    };

    /// With ω_d = ω√(1 − ζ²):
    ///   step = 1 − e^(−ζωt) [cos ω_d t + ζ/√(1−ζ²) sin ω_d t]
    ///   ramp = t − 2ζ/ω + e^(−ζωt) [2ζ/ω cos ω_d t + (2ζ² − 1)/ω_d sin ω_d t]
    [[nodiscard]] At at(Scalar time_s) const {
        using std::cos;
        using std::exp;
        using std::sin;
        using std::sqrt;
        if (!(time_s > Scalar(0))) {
            return {};
        }
        const Scalar omega = omega_rad_s();
        const Scalar root = sqrt(Scalar(1) - damping * damping);
        const Scalar decay = exp(-damping * omega * time_s);
        const Scalar cosine = cos(omega * root * time_s);
        const Scalar sine = sin(omega * root * time_s);
        const Scalar lag = lag_s();
        return {Scalar(1) - decay * (cosine + damping / root * sine),
                time_s - lag +
                    decay * (lag * cosine + (Scalar(2) * damping * damping - Scalar(1)) / (omega * root) * sine)};
    }

    /// By which a ramp comes out late, 2ζ/ω.
    [[nodiscard]] Scalar lag_s() const { return Scalar(2) * damping / omega_rad_s(); }

    /// After this time a step is within 3 % of its end.
    [[nodiscard]] Scalar settling_s() const { return Scalar(4) / (damping * omega_rad_s()); }

    /// Each sample of white noise that passed the filter counts as this many independent ones: the share of the band
    /// that is left. Noise bandwidth of the filter: πf/(4ζ).
    [[nodiscard]] Scalar independent_share(Scalar sample_rate_hz) const {
        const Scalar share = pi<Scalar> * corner_hz / (Scalar(2) * damping * sample_rate_hz);
        return share < Scalar(1) ? share : Scalar(1);
    }

  private:
    [[nodiscard]] Scalar omega_rad_s() const { return turn_rad<Scalar> * corner_hz; }
};

}  // namespace millforce::estimation
