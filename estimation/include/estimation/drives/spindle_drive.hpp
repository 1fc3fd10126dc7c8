// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/drives/force_change.hpp"
#include "estimation/drives/noise_ratio.hpp"
#include "estimation/drives/warm_up_tracker.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/phasor.hpp"
#include "estimation/signal/revolution_harmonic.hpp"

namespace millforce::estimation {

template <typename Scalar>
struct SpindleDriveParameters {
    Scalar K_t1_Nm_per_A{0};           ///< torque per ampere below base speed (the paper's K_t1 times R)
    Scalar K_t2_Nm{0};                 ///< torque at zero current, −K_t1 × idle current (the paper's K_t2 times R)
    Scalar idle_torque_slope_Nm_s{0};  ///< growth of the idle torque with speed, N·m per rad/s
    Scalar inertia_kg_m2{0};           ///< J of spindle, rotor and tool
    Scalar base_speed_rad_s{0};        ///< above it K_t1 falls as base/ω (constant power); 0: never
    Scalar gain_relative_sd{literal<Scalar>(0.02L)};  ///< relative deviation of K_t1, from its calibration
    Scalar idle_torque_sd_Nm{
        literal<Scalar>(0.2L)};  ///< deviation of the idle torque before the first re-zeroing in air
    Scalar idle_walk_Nm_per_sqrt_s{literal<Scalar>(0.01L)};  ///< drift of the idle torque
    Scalar warm_up_torque_Nm{0};  ///< idle torque of the cold spindle above that of the warm one
    Scalar warm_up_torque_sd_Nm{0};
    Scalar warm_up_time_s{0};                    ///< time constant of the warming; 0: not known
    Scalar current_sd_A{literal<Scalar>(0.1L)};  ///< noise of one current sample
};

/// The part of the tangential force that turns with the spindle, as a mean of whole revolutions.
template <typename Scalar>
struct TurningForce {
    int revolutions = 0;  ///< 0: not known
    Phasor<Scalar> force_N{};
    Scalar variance_N2{0};  ///< of each component
    Scalar speed_rad_s{0};
    Scalar samples{0};  ///< per revolution
};

/// Mean tangential force from the spindle's motor current.
///
///   F_at = (K_t1(ω) I + K_t2 − k ω − δ − J dω/dt) / R            Kim & Chung Eq. 8, with inertia, speed and drift
///   K_t1(ω) = K_t1 for ω ≤ ω_base, K_t1 ω_base/ω above           field weakening: constant power
///
/// δ is the idle torque's drift, re-zeroed in air by rezero(); between two such moments it falls as the bearing warms
/// up. At another speed it is doubtful by σ(δ) Δω/ω, with the deviation σ(δ) that the calibration states. Averages over
/// whole tooth periods are meant: between teeth the rotor stores what the current does not show. R > 0 in mm, ω in
/// rad/s, I in A. Not thread-safe.
template <typename Scalar>
class SpindleDrive {
  public:
    explicit SpindleDrive(const SpindleDriveParameters<Scalar>& parameters = {})
        : parameters_(parameters),
          drift_Nm_({parameters.idle_torque_sd_Nm, square(parameters.idle_walk_Nm_per_sqrt_s),
                     parameters.warm_up_torque_Nm, parameters.warm_up_torque_sd_Nm, parameters.warm_up_time_s}),
          certain_drift_Nm_(drift_Nm_.value()) {}

    struct Average {
        Scalar current_A{0};
        Scalar speed_rad_s{0};
        Scalar acceleration_rad_s2{0};
        Scalar acceleration_variance{0};       ///< noise of the counts
        Scalar acceleration_change_rad_s2{0};  ///< within the average
        Scalar samples{1};
        bool present = false;
    };

    [[nodiscard]] Measurement<Scalar> tangential_force_N(const Average& average, Scalar cutter_radius_mm) const {
        return cutter_radius_mm > Scalar(0) ? force_N(average, Scalar(1000) / cutter_radius_mm) : Measurement<Scalar>{};
    }
    /// The same for a tool whose newtons per N·m, 1000/R, are known already.
    [[nodiscard]] Measurement<Scalar> force_N(const Average& average, Scalar per_Nm) const {
        if (!is_usable(average) || is_implausible_) {
            return {};
        }
        const Scalar torque_Nm = torque_without_drift_Nm(average) - drift_Nm_.value();
        const Scalar noise = noise_variance(average, per_Nm);
        const Scalar others = drift_Nm_.variance() + square(parameters_.gain_relative_sd * torque_Nm) +
                              inertia_doubt_Nm2(average) + square(speed_doubt_Nm(average));
        return {true, torque_Nm * per_Nm, noise + others * square(per_Nm), noise};
    }

    /// What a change of current between two averages of so many samples is as a force (force_change.hpp).
    [[nodiscard]] Measurement<Scalar> change_N(Scalar change_A, Scalar speed_rad_s, Scalar samples,
                                               Scalar per_Nm) const {
        return samples > Scalar(0) && speed_rad_s > Scalar(0)
                   ? force_change_N(change_A, torque_constant_Nm_per_A(speed_rad_s) * per_Nm, parameters_.current_sd_A,
                                    noise_.value(), samples)
                   : Measurement<Scalar>{};
    }

    /// What turns with the spindle: motor and rotor share it, the more of it the rotor the faster it turns. With the
    /// phasors I_1 and T_1 of current and time (revolution_harmonic.hpp),
    ///
    ///   F_1 = (K_t1(ω) I_1 + i J ω² T_1)/R
    [[nodiscard]] TurningForce<Scalar> turning_force_N(const typename RevolutionHarmonic<Scalar>::Mean& seen,
                                                       Scalar speed_rad_s, Scalar per_Nm) const {
        if (seen.revolutions == 0 || !(seen.samples > Scalar(0))) {
            return {};
        }
        const Scalar N_per_A = torque_constant_Nm_per_A(speed_rad_s) * per_Nm;
        const Scalar rotor_Nm = parameters_.inertia_kg_m2 * square(speed_rad_s);
        const Phasor<Scalar> force_N = seen.current_A * N_per_A - over_i(seen.time) * rotor_Nm * per_Nm;
        const Scalar of_current_N2 =
            Scalar(2) * square(N_per_A * parameters_.current_sd_A) * noise_.value() / seen.samples;
        const Scalar variance_N2 = of_current_N2 + square(rotor_Nm * seen.time_sd * per_Nm);
        return {seen.revolutions, force_N, variance_N2 / Scalar(seen.revolutions), speed_rad_s, seen.samples};
    }

    /// What was learnt in air was none: back to the calibration.
    void forget() { *this = SpindleDrive(parameters_); }

    /// The tool is in air, at an unchanged speed: what change_N found is noise.
    void learn_noise(const Measurement<Scalar>& change_N) { noise_.learn(change_N); }

    /// Time passes: the drift may have moved.
    void predict(Scalar dt_s) { drift_Nm_.predict(dt_s); }

    /// The tool is known to be in air: what is left of the torque is drift. A spindle that runs up teaches little:
    /// a share of its inertia's torque is uncertain. A torque that the idle torque's stated deviation cannot explain
    /// teaches nothing: the signal is implausible, and there is no force until one in air is plausible again.
    /// `may_cut`: nothing but the force says that this is air, so it may be a light cut.
    void rezero(const Average& average, bool may_cut = false) {
        if (!is_usable(average)) {
            return;
        }
        const Scalar noise = noise_variance(average, Scalar(1));
        const Measurement<Scalar> seen{true, torque_without_drift_Nm(average), noise + inertia_doubt_Nm2(average),
                                       noise};
        drift_Nm_.widen(square(speed_doubt_Nm(average)));
        zeroed_speed_rad_s_ = average.speed_rad_s;
        is_implausible_ = !drift_Nm_.is_within_doubt(seen);
        is_above_idle_ = seen.value > drift_Nm_.excess();
        if (!is_implausible_) {
            drift_Nm_.correct(seen);
            if (!may_cut) {
                certain_drift_Nm_ = drift_Nm_.value();
            }
            doubt_gain(average.speed_rad_s);
        }
    }
    [[nodiscard]] bool is_implausible() const { return is_implausible_; }
    /// The tool may have been in a cut: if the last torque in air was more than the idle torque can be, it was one, and
    /// the signal is plausible. Returns whether it was.
    bool find_hidden_cut() {
        const bool is_cut = is_implausible_ && is_above_idle_;
        is_implausible_ = is_implausible_ && !is_cut;
        return is_cut;
    }

    /// Relative deviation of F_at that the idle torque brings about, beyond that of force_N: a current that shows too
    /// little of the cut shows too little of the idle torque as well. 0, unless less of it was seen in air than
    /// calibrations like this one leave to chance; then the gain may be off by as much. Stays from then on: where a
    /// weak signal hides the contact, what is learnt next is the cut. 0 as well where the current is as noisy in air as
    /// stated (NoiseRatio::is_as_stated): a signal that is weak is weak in its noise, too.
    [[nodiscard]] Scalar gain_doubt() const { return noise_.is_as_stated() ? Scalar(0) : gain_doubt_; }

    [[nodiscard]] Scalar drift_Nm() const { return drift_Nm_.value(); }
    /// By how much the drift has grown where it may have been a light cut, ≥ 0: the torque may be so much too small.
    [[nodiscard]] Scalar uncertain_drift_Nm() const {
        const Scalar grown_Nm = drift_Nm_.value() - certain_drift_Nm_;
        return grown_Nm > Scalar(0) ? grown_Nm : Scalar(0);
    }

    [[nodiscard]] Scalar torque_constant_Nm_per_A(Scalar speed_rad_s) const {
        const bool weakened = parameters_.base_speed_rad_s > Scalar(0) && speed_rad_s > parameters_.base_speed_rad_s;
        return weakened ? parameters_.K_t1_Nm_per_A * parameters_.base_speed_rad_s / speed_rad_s
                        : parameters_.K_t1_Nm_per_A;
    }

  private:
    /// Of J dω/dt: what J is off by, and the current's delay behind the torque.
    static constexpr Scalar inertia_share_in_doubt = literal<Scalar>(0.15L);

    [[nodiscard]] Scalar inertia_doubt_Nm2(const Average& average) const {
        return square(inertia_share_in_doubt * parameters_.inertia_kg_m2 * average.acceleration_rad_s2) +
               square(parameters_.inertia_kg_m2 * average.acceleration_change_rad_s2);
    }

    void doubt_gain(Scalar speed_rad_s) {
        constexpr Scalar by_chance_in_deviations = literal<Scalar>(1.5L);
        constexpr Scalar largest_doubt{4};
        const Scalar missing_Nm = -drift_Nm_.offset();
        if (!(missing_Nm > by_chance_in_deviations * parameters_.idle_torque_sd_Nm)) {
            return;
        }
        const Scalar seen_Nm = parameters_.idle_torque_slope_Nm_s * speed_rad_s - parameters_.K_t2_Nm - missing_Nm;
        const Scalar doubt = missing_Nm < largest_doubt * seen_Nm ? missing_Nm / seen_Nm : largest_doubt;
        gain_doubt_ = doubt > gain_doubt_ ? doubt : gain_doubt_;
    }

    /// Of the idle torque, since it was zeroed at another speed.
    [[nodiscard]] Scalar speed_doubt_Nm(const Average& average) const {
        const Scalar change_rad_s = average.speed_rad_s - zeroed_speed_rad_s_;
        return zeroed_speed_rad_s_ > Scalar(0) ? parameters_.idle_torque_sd_Nm * change_rad_s / zeroed_speed_rad_s_
                                               : Scalar(0);
    }

    [[nodiscard]] static bool is_usable(const Average& average) {
        return average.present && average.samples > Scalar(0) && average.speed_rad_s > Scalar(0);
    }

    [[nodiscard]] Scalar torque_without_drift_Nm(const Average& average) const {
        return torque_constant_Nm_per_A(average.speed_rad_s) * average.current_A + parameters_.K_t2_Nm -
               parameters_.idle_torque_slope_Nm_s * average.speed_rad_s -
               parameters_.inertia_kg_m2 * average.acceleration_rad_s2;
    }

    /// Of the torque times `unit`. The unit goes in before the square: that of a small spindle's torque in N·m, 1e-10,
    /// is at the limit of fixed-point resolution.
    [[nodiscard]] Scalar noise_variance(const Average& average, Scalar unit) const {
        const Scalar sd = torque_constant_Nm_per_A(average.speed_rad_s) * parameters_.current_sd_A * unit;
        return square(sd) * noise_.value() / average.samples +
               square(parameters_.inertia_kg_m2 * unit) * average.acceleration_variance;
    }

    SpindleDriveParameters<Scalar> parameters_;
    WarmUpTracker<Scalar> drift_Nm_;
    NoiseRatio<Scalar> noise_;
    Scalar zeroed_speed_rad_s_{0};
    Scalar gain_doubt_{0};
    Scalar certain_drift_Nm_{0};
    bool is_implausible_ = false;
    bool is_above_idle_ = false;
};

}  // namespace millforce::estimation
