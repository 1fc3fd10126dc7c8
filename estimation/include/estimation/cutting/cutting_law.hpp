// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/number/literal.hpp"

#include <cmath>

/// Closed-form averages of the milling force over one tooth pitch: the one forward model of this project's estimators.
///
/// Cutting (Kim & Chung Eqs. 4–6) and edge forces, both per tooth pitch φ_N = 2π/N, for any φ_st and φ_ex:
///
///   G = K_s f_z a_p / φ_N,  E_t = K_te a_p / φ_N,  E_r = K_re a_p / φ_N
///   F_at = G c            + E_t Δφ
///   F_ax = G (s + r_1 b)  + E_t d + E_r c
///   F_ay = G (−b + r_1 s) − E_t c + E_r d
///
///   c = ∫sin φ dφ = cos φ_st − cos φ_ex        s = ∫sin φ cos φ dφ = ½(sin²φ_ex − sin²φ_st)
///   b = ∫sin²φ dφ = ½[Δφ − ½(sin 2φ_ex − sin 2φ_st)]   d = ∫cos φ dφ = sin φ_ex − sin φ_st,  Δφ = φ_ex − φ_st
///
/// Coefficients by the mean chip thickness t_a = f_z c/Δφ (mm): K_s = k_s t_a^p_s (N/mm²), r_1 = k_1 t_a^p_1.
/// Forces act on the workpiece: F_x = F_t cos φ + F_r sin φ, F_y = −F_t sin φ + F_r cos φ. The paper prints F_ax and
/// F_ay with R_r where R_a belongs; integration of the force over the engagement decides for R_a.
///
/// Two laws of the field are special cases: Kim & Chung's power law has K_te = K_re = 0; the linear edge law
/// (K_tc, K_te, K_rc, K_re) has p_s = p_1 = 0, k_s = K_tc, k_1 = K_rc/K_tc.

namespace millforce::estimation {

/// Coefficients of a workpiece material and a tool, and how well they are known.
///
/// ln K_s has the variance K_s_relative_sd² + (K_s_exponent_sd · ln(t_a/t_ref))², and r_1 likewise: t_ref is where the
/// calibration knew most, and away from it the uncertainty grows. min/max_chip_thickness_mm is the calibrated range.
template <typename Scalar>
struct CuttingLaw {
    Scalar k_s_N_per_mm2{0};  ///< K_s at t_a = 1 mm.
    Scalar p_s{0};            ///< exponent of K_s, > −1; negative: thin chips cost more.
    Scalar k_1{0};            ///< r_1 = F_r/F_t at t_a = 1 mm.
    Scalar p_1{0};            ///< exponent of r_1.
    Scalar K_te_N_per_mm{0};  ///< tangential edge force per length of edge.
    Scalar K_re_N_per_mm{0};  ///< radial edge force per length of edge.

    Scalar K_s_relative_sd{literal<Scalar>(0.05L)};  ///< standard deviation of ln K_s at t_ref.
    Scalar K_s_exponent_sd{0};                       ///< its growth per unit of ln(t_a/t_ref).
    Scalar r_1_relative_sd{literal<Scalar>(0.05L)};  ///< standard deviation of ln r_1 at t_ref.
    Scalar r_1_exponent_sd{0};                       ///< its growth per unit of ln(t_a/t_ref).
    Scalar reference_chip_thickness_mm{0};           ///< t_ref; 0: the uncertainty does not grow.
    Scalar minimum_chip_thickness_mm{0};             ///< thinnest mean chip of the calibration cuts.
    Scalar maximum_chip_thickness_mm{0};             ///< thickest mean chip of the calibration cuts; 0: not given.
};

/// The linear edge law as a CuttingLaw, without doubt: both deviations are 0. `K_tc` > 0.
template <typename Scalar>
CuttingLaw<Scalar> linear_edge_law(Scalar K_tc_N_per_mm2, Scalar K_te_N_per_mm, Scalar K_rc_N_per_mm2,
                                   Scalar K_re_N_per_mm) {
    CuttingLaw<Scalar> law;
    law.k_s_N_per_mm2 = K_tc_N_per_mm2;
    law.k_1 = K_rc_N_per_mm2 / K_tc_N_per_mm2;
    law.K_te_N_per_mm = K_te_N_per_mm;
    law.K_re_N_per_mm = K_re_N_per_mm;
    law.K_s_relative_sd = Scalar(0);
    law.r_1_relative_sd = Scalar(0);
    return law;
}

/// One straight cut in steady state.
template <typename Scalar>
struct CutConditions {
    Scalar feed_per_tooth_mm{0};  ///< f_z > 0.
    Scalar axial_depth_mm{0};     ///< a_p ≥ 0.
    EngagementAngles<Scalar> engagement{};
    Scalar teeth{1};  ///< N ≥ 1, a whole number.
};

/// The integrals of the equations above over the engagement. Written with half-angles: a narrow engagement loses no
/// digits to the difference of two cosines.
template <typename Scalar>
struct EngagementIntegrals {
    Scalar c{0};          ///< ∫sin φ dφ
    Scalar s{0};          ///< ∫sin φ cos φ dφ
    Scalar b{0};          ///< ∫sin²φ dφ
    Scalar d{0};          ///< ∫cos φ dφ
    Scalar delta_rad{0};  ///< Δφ
    Scalar mean_sine{0};  ///< c/Δφ, so that t_a = f_z · mean_sine; 0 where nothing is engaged.
};

template <typename Scalar>
EngagementIntegrals<Scalar> engagement_integrals(EngagementAngles<Scalar> angles) {
    using elementary::cos;
    using elementary::sin;
    const Scalar delta = angles.exit_rad - angles.entry_rad;
    if (!(delta > Scalar(0))) {
        return {};
    }
    const Scalar half = halved(delta);
    const Scalar middle = angles.entry_rad + half;
    const Scalar sine_of_delta = sin(delta);
    EngagementIntegrals<Scalar> result;
    result.delta_rad = delta;
    result.mean_sine = sin(middle) * (sin(half) / half);
    result.c = result.mean_sine * delta;
    result.d = Scalar(2) * cos(middle) * sin(half);
    result.s = halved(sin(middle + middle)) * sine_of_delta;
    result.b = halved(delta - cos(middle + middle) * sine_of_delta);
    return result;
}

/// t_a = f_z c/Δφ in mm; 0 where nothing is engaged.
template <typename Scalar>
Scalar mean_chip_thickness_mm(Scalar feed_per_tooth_mm, EngagementAngles<Scalar> angles) {
    return feed_per_tooth_mm * engagement_integrals(angles).mean_sine;
}

/// K_s(t_a) and r_1(t_a), with their variances. t_a > 0.
template <typename Scalar>
struct CuttingCoefficients {
    Scalar K_s_N_per_mm2{0};
    Scalar r_1{0};
    Scalar ln_K_s_variance{0};
    Scalar ln_r_1_variance{0};
};

template <typename Scalar>
CuttingCoefficients<Scalar> cutting_coefficients(const CuttingLaw<Scalar>& law, Scalar chip_thickness_mm) {
    using elementary::exp;
    using elementary::log;
    if (!(chip_thickness_mm > Scalar(0))) {
        return {};
    }
    const Scalar ln_t = log(chip_thickness_mm);
    const Scalar distance =
        law.reference_chip_thickness_mm > Scalar(0) ? ln_t - log(law.reference_chip_thickness_mm) : Scalar(0);
    return {law.k_s_N_per_mm2 * exp(law.p_s * ln_t), law.k_1 * exp(law.p_1 * ln_t),
            square(law.K_s_relative_sd) + square(law.K_s_exponent_sd * distance),
            square(law.r_1_relative_sd) + square(law.r_1_exponent_sd * distance)};
}

/// Forces on the workpiece, averaged over a tooth pitch.
template <typename Scalar>
struct AverageForces {
    Scalar tangential_N{0};  ///< F_at; spindle torque = F_at · R.
    Scalar feed_N{0};        ///< F_ax, along the feed.
    Scalar normal_N{0};      ///< F_ay, along +y.
};

/// Average forces, and how they move with the two uncertain coefficients:
/// cov(F_i, F_j) = ∂F_i/∂ln K_s · ∂F_j/∂ln K_s · var(ln K_s) + ∂F_i/∂ln r_1 · ∂F_j/∂ln r_1 · var(ln r_1).
template <typename Scalar>
struct AverageForcesWithDoubt {
    AverageForces<Scalar> mean{};
    AverageForces<Scalar> per_ln_K_s{};
    AverageForces<Scalar> per_ln_r_1{};
    AverageForces<Scalar> standard_deviation{};
    CuttingCoefficients<Scalar> coefficients{};
};

/// Average forces of a cut: F_at, F_ax, F_ay in N. Zero where nothing is engaged or f_z ≤ 0.
/// Cost: 4 trigonometric calls, 1 logarithm, 2 exponentials.
template <typename Scalar>
AverageForcesWithDoubt<Scalar> average_forces_with_doubt(const CuttingLaw<Scalar>& law,
                                                         const CutConditions<Scalar>& cut) {
    using std::sqrt;
    const EngagementIntegrals<Scalar> i = engagement_integrals(cut.engagement);
    AverageForcesWithDoubt<Scalar> result;
    const Scalar t_a = cut.feed_per_tooth_mm * i.mean_sine;
    if (!(t_a > Scalar(0))) {
        return result;
    }
    result.coefficients = cutting_coefficients(law, t_a);
    const Scalar per_pitch = cut.axial_depth_mm * cut.teeth / turn_rad<Scalar>;
    const Scalar G = result.coefficients.K_s_N_per_mm2 * cut.feed_per_tooth_mm * per_pitch;
    const Scalar E_t = law.K_te_N_per_mm * per_pitch;
    const Scalar E_r = law.K_re_N_per_mm * per_pitch;
    const Scalar r_1 = result.coefficients.r_1;
    result.per_ln_K_s = {G * i.c, G * (i.s + r_1 * i.b), G * (r_1 * i.s - i.b)};
    result.per_ln_r_1 = {Scalar(0), G * r_1 * i.b, G * r_1 * i.s};
    result.mean = {result.per_ln_K_s.tangential_N + E_t * i.delta_rad, result.per_ln_K_s.feed_N + E_t * i.d + E_r * i.c,
                   result.per_ln_K_s.normal_N - E_t * i.c + E_r * i.d};
    const auto sd = [&](Scalar by_K_s, Scalar by_r_1) {
        return sqrt(by_K_s * by_K_s * result.coefficients.ln_K_s_variance +
                    by_r_1 * by_r_1 * result.coefficients.ln_r_1_variance);
    };
    result.standard_deviation = {sd(result.per_ln_K_s.tangential_N, result.per_ln_r_1.tangential_N),
                                 sd(result.per_ln_K_s.feed_N, result.per_ln_r_1.feed_N),
                                 sd(result.per_ln_K_s.normal_N, result.per_ln_r_1.normal_N)};
    return result;
}

/// Average forces alone; see average_forces_with_doubt.
template <typename Scalar>
AverageForces<Scalar> average_forces(const CuttingLaw<Scalar>& law, const CutConditions<Scalar>& cut) {
    return average_forces_with_doubt(law, cut).mean;
}

}  // namespace millforce::estimation
