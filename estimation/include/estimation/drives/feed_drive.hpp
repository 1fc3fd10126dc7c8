// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/drives/force_change.hpp"
#include "estimation/drives/learnt_in_air.hpp"
#include "estimation/drives/noise_ratio.hpp"
#include "estimation/number/literal.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace millforce::estimation {

/// K_x1 w² + K_x2 w, w = |velocity| in m/min (Kim & Chung Eq. 9), for one direction of travel.
template <typename Scalar>
struct FrictionCurrent {
    Scalar K_x1_A_min2_per_m2{0};
    Scalar K_x2_A_min_per_m{0};

    [[nodiscard]] Scalar at(Scalar speed_m_per_min) const {
        return (K_x1_A_min2_per_m2 * speed_m_per_min + K_x2_A_min_per_m) * speed_m_per_min;
    }
};

/// The friction of both directions of travel, relative to its calibration, tracked while the tool is in air.
///
/// Temperature and lubrication act on both directions alike: the two scales are two states with correlated errors,
/// and travel in air in one direction teaches about the other as well. Kalman filter with two states:
///   P ← P + q dt [1 ρ; ρ 1],   k = P e_d/(P_dd + R),   κ ← κ + k (z − κ_d),   P ← P − k e_dᵀ P
/// What lies beyond 3 √(P_dd + R) on one side, eight times on end, is learnt at once: P_dd ← (z − κ_d)² − R.
template <typename Scalar>
class FrictionScale {
  public:
    /// ρ: nearly one, since the causes are common; the rest is what each direction has of its own.
    static constexpr Scalar correlation = literal<Scalar>(0.95L);

    FrictionScale() = default;
    FrictionScale(Scalar relative_sd, Scalar walk_per_sqrt_s)
        : own_{square(relative_sd), square(relative_sd)},
          shared_(correlation * square(relative_sd)),
          limit_(square(relative_sd)),
          walk_per_s_(square(walk_per_sqrt_s)) {}

    /// Each up to what its calibration leaves open: a direction that is not used must not end the tracking of the
    /// other. The shared part stays behind rather than grow past what both bear.
    void predict(Scalar dt_s) {
        const Scalar growth = walk_per_s_ * dt_s;
        bool both_grow = true;
        for (Scalar& own : own_) {
            const bool grows = own + growth < limit_;
            own = grows ? own + growth : own;
            both_grow = both_grow && grows;
        }
        shared_ = both_grow ? shared_ + correlation * growth : shared_;
    }

    /// Whether a scale seen in air lies within what the calibration leaves open.
    [[nodiscard]] bool is_within_doubt(const Measurement<Scalar>& seen) const {
        return seen.valid && may_be_learnt_in_air(seen.value - Scalar(1), limit_ + seen.variance);
    }

    void correct(std::size_t direction, Measurement<Scalar> seen) {
        const std::size_t other = 1U - direction;
        if (!seen.valid) {
            return;
        }
        doubt_what_is_denied(direction, seen);
        const Scalar total = own_[direction] + seen.variance;
        if (!(total > Scalar(0))) {
            return;
        }
        const Scalar gain = own_[direction] / total;
        const Scalar gain_of_other = shared_ / total;
        const Scalar surprise = seen.value - value_[direction];
        value_[direction] += gain * surprise;
        value_[other] += gain_of_other * surprise;
        own_[other] -= gain_of_other * shared_;
        shared_ -= gain * shared_;
        own_[direction] -= gain * own_[direction];
    }

    [[nodiscard]] Scalar value(std::size_t direction) const { return value_[direction]; }
    [[nodiscard]] Scalar variance(std::size_t direction) const { return own_[direction]; }

  private:
    /// The friction has moved by more than it walks, as at another feed: the doubt becomes what is seen, so that it is
    /// learnt at once. Several times on end: a cut that begins looks like it for a moment.
    void doubt_what_is_denied(std::size_t direction, const Measurement<Scalar>& seen) {
        constexpr Scalar deviations{3};
        constexpr int on_end = 8;
        const Scalar surprise = seen.value - value_[direction];
        const Scalar total = own_[direction] + seen.variance;
        if (!(square(surprise) > square(deviations) * total)) {
            denials_ = 0;
            return;
        }
        const int one = surprise > Scalar(0) ? 1 : -1;
        denials_ = static_cast<std::int8_t>(one * denials_ > 0 ? denials_ + one : one);
        if (one * denials_ == on_end) {
            own_[direction] += square(surprise) - total;
            denials_ = 0;
        }
    }

    std::array<Scalar, 2> value_{Scalar(1), Scalar(1)};
    std::array<Scalar, 2> own_{};
    Scalar shared_{0};
    Scalar limit_{0};
    Scalar walk_per_s_{0};
    std::int8_t denials_ = 0;  // on end; negative: below what is believed
};

template <typename Scalar>
struct FeedDriveParameters {
    FrictionCurrent<Scalar> positive{};  ///< growth of the friction current with speed, travelling in + direction
    FrictionCurrent<Scalar> negative{};  ///< magnitude when travelling in − direction
    Scalar K_x3_A{0};                    ///< constant friction current, of both directions: see gravity_A
    Scalar gravity_A{0};                 ///< current that holds the axis against its weight; half the difference of
                                         ///< the directions' constant friction is in it: air data cannot separate them
    Scalar K_x4_N_per_A{0};              ///< force per ampere. The paper's Table 3 repeats K_t1 here: calibrate
    Scalar K_x5_N_m_per_min{0};          ///< force term K_x5/w. The paper's Table 3 repeats K_t2 here: calibrate
    Scalar mass_kg{0};                   ///< moved mass, with the motor's inertia reflected
    Scalar velocity_floor_mm_s{1};       ///< below it there is no estimate: friction is undefined at rest
    Scalar gain_relative_sd{literal<Scalar>(0.03L)};  ///< relative deviation of K_x4, from its calibration
    Scalar friction_relative_sd{
        literal<Scalar>(0.2L)};  ///< relative deviation of I_f before the first re-zeroing in air
    /// The calibration's feeds: beyond them I_f is less certain (FeedDrive). A largest speed of 0: not known.
    Scalar friction_speed_min_m_per_min{0};
    Scalar friction_speed_max_m_per_min{0};
    Scalar K_x1_sd_A_min2_per_m2{0};  ///< deviation of K_x1 from that calibration, also where it is left out as 0
    Scalar friction_walk_per_sqrt_s{literal<Scalar>(0.002L)};  ///< drift of I_f, relative
    Scalar friction_ripple_A{literal<Scalar>(0.05L)};  ///< position-dependent part of friction that no average removes
    Scalar current_sd_A{literal<Scalar>(0.1L)};        ///< noise of one current sample
};

/// Mean force of the cut along one feed axis from its motor current.
///
///   F_ax = K_x4 (I − I_g − σ κ I_f(|w|)) + K_x5/w − M dv/dt,   σ = sign of w      Kim & Chung Eqs. 9, 10
///   I_f(w) = K_x1 w² + K_x2 w + K_x3,   K_x1 and K_x2 by direction
///
/// positive in the axis' + direction, as a force on the workpiece. κ scales the friction and is re-zeroed in air
/// (FrictionScale). An axis below its velocity floor, or one that turned round within the average, gives no estimate:
/// at rest the force hides in static friction, and K_x5/w is singular there.
///
/// The calibration knows I_f between its slowest and its fastest feed. At a distance d beyond them, the curvature that
/// it left open adds σ(K_x1) d (d + w_max − w_min) to the deviation of I_f: by so much two parabolas that agree at both
/// ends are apart. Not thread-safe.
template <typename Scalar>
class FeedDrive {
  public:
    explicit FeedDrive(const FeedDriveParameters<Scalar>& parameters = {})
        : parameters_(parameters),
          friction_scale_(parameters.friction_relative_sd, parameters.friction_walk_per_sqrt_s) {}

    /// What was learnt in air was none: back to the calibration.
    void forget() { *this = FeedDrive(parameters_); }

    struct Average {
        Scalar current_A{0};
        Scalar velocity_mm_s{0};
        Scalar acceleration_mm_s2{0};
        Scalar duration_s{0};
        Scalar samples{1};
        bool present = false;
    };

    [[nodiscard]] Measurement<Scalar> force_N(const Average& average) const {
        if (!is_moving(average) || is_implausible_) {
            return {};
        }
        const Scalar friction_A = signed_friction_A(average);
        const Scalar cut_A =
            average.current_A - parameters_.gravity_A - friction_scale_.value(direction(average)) * friction_A;
        const Scalar inertial_N = inertial_force_N(average);
        const Scalar force = parameters_.K_x4_N_per_A * cut_A + force_by_speed_N(average) - inertial_N;
        const Scalar friction_variance =
            square(friction_A) * friction_scale_.variance(direction(average)) + other_friction_variance_A2(average);
        const Scalar noise = noise_variance_N2(average) + square(inertia_share_in_doubt * inertial_N);
        return {
            true, force,
            noise + square(parameters_.K_x4_N_per_A) * friction_variance + square(parameters_.gain_relative_sd * force),
            noise};
    }

    /// The least force on an axis that stands: what its motor carries beyond static friction. Not valid where static
    /// friction may carry it all.
    [[nodiscard]] Measurement<Scalar> least_force_at_rest_N(const Average& average) const {
        // Break-away is up to a third above K_x3, the friction of a sliding axis, which is known to within two
        // deviations.
        constexpr Scalar break_away = literal<Scalar>(1.3L);
        const Scalar held_A =
            break_away * parameters_.K_x3_A * (Scalar(1) + Scalar(2) * parameters_.friction_relative_sd);
        const Scalar shown_A = average.current_A - parameters_.gravity_A;
        const Scalar beyond_A = shown_A < Scalar(0) ? shown_A + held_A : shown_A - held_A;
        // Four times the noise that was stated: the channel is not scaled as calibrated.
        constexpr Scalar noise_of_another_gain{16};
        const bool is_as_calibrated = !is_implausible_ && noise_.value() < noise_of_another_gain;
        if (!rests(average) || !is_as_calibrated || !(held_A > Scalar(0)) || !(beyond_A * shown_A > Scalar(0))) {
            return {};
        }
        const Scalar force = parameters_.K_x4_N_per_A * beyond_A;
        const Scalar noise = noise_variance_N2(average);
        const Scalar by_gain = square(parameters_.gain_relative_sd * parameters_.K_x4_N_per_A * shown_A);
        return {true, force, noise + by_gain, noise};
    }

    /// What a change of current between two averages of so many samples is as a force, at an unchanged velocity
    /// (force_change.hpp).
    [[nodiscard]] Measurement<Scalar> change_N(Scalar change_A, Scalar samples) const {
        return samples > Scalar(0) && parameters_.K_x4_N_per_A > Scalar(0)
                   ? force_change_N(change_A, parameters_.K_x4_N_per_A, parameters_.current_sd_A, noise_.value(),
                                    samples)
                   : Measurement<Scalar>{};
    }

    /// The tool is in air, at an unchanged velocity: what change_N found is noise.
    void learn_noise(const Measurement<Scalar>& change_N) { noise_.learn(change_N); }

    /// Time passes: the friction may have moved.
    void predict(Scalar dt_s) { friction_scale_.predict(dt_s); }

    /// The tool is known to be in air: the current is friction, weight and inertia alone. A current that the stated
    /// deviation of the friction cannot explain teaches nothing: the signal is implausible, and there is no force until
    /// one in air is plausible again. Beyond the calibration's feeds, where I_f itself may be off by as much as its
    /// drift, nothing is learnt: the same error in each window would not average out.
    void rezero(const Average& average) {
        const Scalar friction_A = signed_friction_A(average);
        const Scalar drift_A = halved(parameters_.friction_relative_sd * friction_A);
        const bool is_known_here = !(square(extrapolation_sd_A(average)) > square(drift_A));
        if (!is_steady(average) || !(square(friction_A) > Scalar(0)) || !is_known_here) {
            return;
        }
        const Scalar other_A =
            parameters_.gravity_A + (inertial_force_N(average) - force_by_speed_N(average)) / parameters_.K_x4_N_per_A;
        const Measurement<Scalar> seen{true, (average.current_A - other_A) / friction_A,
                                       current_variance_A2(average) / square(friction_A)};
        is_implausible_ = !friction_scale_.is_within_doubt(seen);
        if (!is_implausible_) {
            friction_scale_.correct(direction(average), seen);
        }
    }
    [[nodiscard]] bool is_implausible() const { return is_implausible_; }

    [[nodiscard]] Scalar friction_scale(bool positive_direction) const {
        return friction_scale_.value(positive_direction ? 1U : 0U);
    }

    [[nodiscard]] bool is_moving(const Average& average) const {
        return has_current(average) &&
               speed_mm_s(average) - speed_change_mm_s(average) >= parameters_.velocity_floor_mm_s;
    }

    /// It does not move, or by less than it must for its friction to be known.
    [[nodiscard]] bool rests(const Average& average) const {
        return has_current(average) &&
               speed_mm_s(average) + speed_change_mm_s(average) < parameters_.velocity_floor_mm_s;
    }

    /// Moving, and at nearly the same speed throughout the average.
    [[nodiscard]] bool is_steady(const Average& average) const {
        constexpr Scalar steady_share = literal<Scalar>(0.1L);  // by which the speed may change
        const Scalar change = average.acceleration_mm_s2 * average.duration_s;
        return is_moving(average) && square(change) < square(steady_share * average.velocity_mm_s);
    }

  private:
    /// Of M dv/dt: what the slope of an average misses of an acceleration that changes within it.
    static constexpr Scalar inertia_share_in_doubt = literal<Scalar>(0.15L);

    [[nodiscard]] bool has_current(const Average& average) const {
        return average.present && average.samples > Scalar(0) && parameters_.K_x4_N_per_A > Scalar(0);
    }
    [[nodiscard]] static Scalar speed_mm_s(const Average& average) {
        return average.velocity_mm_s < Scalar(0) ? -average.velocity_mm_s : average.velocity_mm_s;
    }
    /// From the middle of the average to its ends.
    [[nodiscard]] static Scalar speed_change_mm_s(const Average& average) {
        const Scalar change = halved(average.acceleration_mm_s2 * average.duration_s);
        return change < Scalar(0) ? -change : change;
    }
    [[nodiscard]] static std::size_t direction(const Average& average) {
        return average.velocity_mm_s > Scalar(0) ? 1U : 0U;
    }
    [[nodiscard]] static Scalar velocity_m_per_min(const Average& average) {
        constexpr Scalar m_per_min = literal<Scalar>(0.06L);  // of 1 mm/s
        return average.velocity_mm_s * m_per_min;
    }
    [[nodiscard]] Scalar signed_friction_A(const Average& average) const {
        const Scalar w = velocity_m_per_min(average);
        return w > Scalar(0) ? parameters_.positive.at(w) + parameters_.K_x3_A
                             : -(parameters_.negative.at(-w) + parameters_.K_x3_A);
    }
    /// K_x5/w; most drives have none.
    [[nodiscard]] Scalar force_by_speed_N(const Average& average) const {
        const Scalar K_x5 = parameters_.K_x5_N_m_per_min;
        return K_x5 == Scalar(0) ? Scalar(0) : K_x5 / velocity_m_per_min(average);
    }
    [[nodiscard]] Scalar inertial_force_N(const Average& average) const {
        constexpr Scalar m_per_mm = literal<Scalar>(0.001L);
        return parameters_.mass_kg * average.acceleration_mm_s2 * m_per_mm;
    }
    [[nodiscard]] Scalar noise_variance_N2(const Average& average) const {
        return square(parameters_.K_x4_N_per_A * parameters_.current_sd_A) * noise_.value() / average.samples;
    }
    [[nodiscard]] Scalar current_variance_A2(const Average& average) const {
        return square(parameters_.current_sd_A) * noise_.value() / average.samples +
               other_friction_variance_A2(average);
    }
    /// What the scale of the friction does not describe.
    [[nodiscard]] Scalar other_friction_variance_A2(const Average& average) const {
        return square(parameters_.friction_ripple_A) + square(extrapolation_sd_A(average));
    }
    [[nodiscard]] Scalar extrapolation_sd_A(const Average& average) const {
        const Scalar slowest = parameters_.friction_speed_min_m_per_min;
        const Scalar fastest = parameters_.friction_speed_max_m_per_min;
        const Scalar signed_w = velocity_m_per_min(average);
        const Scalar w = signed_w < Scalar(0) ? -signed_w : signed_w;
        const Scalar beyond = w > fastest ? w - fastest : slowest - w;
        return fastest > Scalar(0) && beyond > Scalar(0)
                   ? parameters_.K_x1_sd_A_min2_per_m2 * beyond * (beyond + fastest - slowest)
                   : Scalar(0);
    }

    FeedDriveParameters<Scalar> parameters_;
    FrictionScale<Scalar> friction_scale_;  // [0]: − direction, [1]: + direction
    NoiseRatio<Scalar> noise_;
    bool is_implausible_ = false;
};

}  // namespace millforce::estimation
