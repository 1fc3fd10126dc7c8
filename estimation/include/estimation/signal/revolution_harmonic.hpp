// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/circle.hpp"
#include "estimation/number/elementary.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"
#include "estimation/number/phasor.hpp"

#include <cmath>
#include <cstdint>

/// What repeats once per revolution of the spindle: in its current I, and in the time t that it takes for an angle.
/// Over whole revolutions of duration T, θ: angle of the encoder,
///
///   I_1 = (1/π) ∫ I e^(−iθ) dθ          I = mean + Re(I_1 e^(iθ)) + what repeats more often
///   T_1 = (2/T) ∫ e^(−iθ) dt            the speed is ω − Re(ω T_1 e^(iθ)) + …
///
/// Current and angle are taken as linear in time between two samples, and what that takes from a sine is given back.
///
/// Valid: five samples a revolution or more, and a speed that varies by less than a tenth within it; a revolution
/// without does not count. Cost: a sine and a cosine a
/// sample, three divisions a revolution. No heap. Not thread-safe.

namespace millforce::estimation {

template <typename Scalar>
class RevolutionHarmonic {
  public:
    /// The mean of some whole revolutions.
    struct Mean {
        int revolutions = 0;  ///< 0: there is none
        Phasor<Scalar> current_A{};
        Phasor<Scalar> time{};  ///< T_1
        Scalar time_sd{0};      ///< deviation of each component in one revolution: the encoder's counts are whole
        Scalar samples{0};      ///< in one revolution
    };

    explicit RevolutionHarmonic(std::uint32_t encoder_counts_per_rev)
        : count_rad_(encoder_counts_per_rev > 0 ? turn_rad<Scalar> / Scalar(static_cast<int>(encoder_counts_per_rev))
                                                : Scalar(0)) {}

    /// One sample. `turned_rev` since the last one (0 ≤ turned < 0.45), `angle_rev` at it (0…1).
    void add(Scalar dt_s, Scalar turned_rev, Scalar angle_rev, Scalar current_A) {
        const Scalar from_rev = angle_rev - turned_rev;
        const Scalar before_A = last_current_A_;
        last_current_A_ = current_A;
        if (!has_last_) {
            has_last_ = true;
            return;
        }
        if (!(from_rev < Scalar(0))) {
            accumulate({dt_s, turned_rev, from_rev + halved(turned_rev), halved(before_A + current_A)});
            return;
        }
        const Scalar share = -from_rev / turned_rev;
        const Scalar at_end_A = before_A + (current_A - before_A) * share;
        accumulate({dt_s * share, -from_rev, halved(from_rev), halved(before_A + at_end_A)});
        end_revolution();
        accumulate({dt_s * (Scalar(1) - share), angle_rev, halved(angle_rev), halved(at_end_A + current_A)});
    }

    /// Of the revolutions that have ended since the last call.
    Mean take() {
        const Mean taken = mean_;
        mean_ = {};
        return taken;
    }

    /// The current or the angle is not known.
    void restart() {
        has_last_ = false;
        is_whole_ = false;
        begun_ = {};
        mean_ = {};
    }

  private:
    static constexpr int longest = 1000;
    static constexpr Scalar fewest_samples{5};
    static constexpr Scalar largest_time = literal<Scalar>(0.1L);

    struct Part {
        Scalar duration_s{0};
        Scalar length_rev{0};
        Scalar middle_rev{0};
        Scalar current_A{0};
    };
    struct Revolution {
        Phasor<Scalar> current_A{};
        Phasor<Scalar> time_s{};
        Scalar duration_s{0};
        Scalar parts{0};
    };

    /// The mean of e^(−iθ) over a part of the angle x is that of its middle times 1 − x²/24 + …
    void accumulate(const Part& part) {
        using elementary::cos;
        using elementary::sin;
        constexpr Scalar per_24 = literal<Scalar>(1.0L / 24.0L);
        const Scalar middle_rad = part.middle_rev * turn_rad<Scalar>;
        const Scalar shortened = Scalar(1) - square(part.length_rev * turn_rad<Scalar>) * per_24;
        const Phasor<Scalar> turned = Phasor<Scalar>{cos(middle_rad), -sin(middle_rad)} * shortened;
        begun_.current_A += turned * (part.current_A * part.length_rev);
        begun_.time_s += turned * part.duration_s;
        begun_.duration_s += part.duration_s;
        begun_.parts += Scalar(1);
    }

    void end_revolution() {
        using std::sqrt;
        const Revolution ended = begun_;
        begun_ = {};
        const bool is_whole = is_whole_;
        is_whole_ = true;
        const Scalar samples = ended.parts - Scalar(1);
        if (!is_whole || samples < fewest_samples || !(ended.duration_s > Scalar(0))) {
            return;
        }
        // A line between samples leaves sinc²(1/n) of a sine.
        constexpr Scalar third_of_pi2 = literal<Scalar>(3.28986813369645287L);
        const Scalar given_back = Scalar(2) + Scalar(2) * third_of_pi2 / square(samples);
        const Phasor<Scalar> time = ended.time_s * (given_back / ended.duration_s);
        if (squared_length(time) > square(largest_time)) {
            return;
        }
        mean_.revolutions = mean_.revolutions < longest ? mean_.revolutions + 1 : longest;
        const Scalar share = Scalar(1) / Scalar(mean_.revolutions);
        mean_.current_A += (ended.current_A * given_back - mean_.current_A) * share;
        mean_.time += (time - mean_.time) * share;
        // A count's error has the variance 1/12, and each of two components half of the mean of n.
        constexpr Scalar sixth = literal<Scalar>(1.0L / 6.0L);
        mean_.time_sd = count_rad_ * sqrt(sixth / samples);
        mean_.samples = samples;
    }

    Scalar count_rad_;
    Scalar last_current_A_{0};
    bool has_last_ = false;
    bool is_whole_ = false;  // the revolution that has begun was seen from angle 0 on
    Revolution begun_{};
    Mean mean_{};
};

}  // namespace millforce::estimation
