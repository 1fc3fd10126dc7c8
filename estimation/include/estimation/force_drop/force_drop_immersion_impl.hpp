// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of force_drop_immersion.hpp. src/force_drop.cpp instantiates them for float and Fixed.

#include "estimation/force_drop/force_drop_immersion.hpp"
#include "estimation/number/elementary.hpp"

#include <cmath>

namespace millforce::estimation {

template <typename Scalar, int Nodes>
struct ForceDropImmersion<Scalar, Nodes>::Roots {
    std::array<Scalar, most_roots> theta_rad{};
    int count = 0;
};

template <typename Scalar, int Nodes>
struct ForceDropImmersion<Scalar, Nodes>::Value {
    bool valid = false;
    Scalar value{0};
};

template <typename Scalar, int Nodes>
struct ForceDropImmersion<Scalar, Nodes>::Propagation {
    Changes direction{};
    Changes magnitude{};
};

template <typename Scalar, int Nodes>
struct ForceDropImmersion<Scalar, Nodes>::Point {
    Scalar theta_rad;
    Scalar value;
};

template <typename Scalar, int Nodes>
ForceDropImmersion<Scalar, Nodes>::ForceDropImmersion(const ForceDropLaw<Scalar>& law,
                                                      const ForceDropImmersionSettings<Scalar>& settings)
    : law_(law), settings_(settings) {}

template <typename Scalar, int Nodes>
ForceDropEstimate<Scalar> ForceDropImmersion<Scalar, Nodes>::solve(const ForceDropMeasurement<Scalar>& m) const {
    using Reason = typename ForceDropEstimate<Scalar>::Reason;
    ForceDropEstimate<Scalar> estimate;
    estimate.side = m.side;
    estimate.reason = reason_against(m);
    if (estimate.reason != Reason::estimated) {
        return estimate;
    }
    const Roots direction = roots_of(Equation::direction, m);
    const Roots magnitude = roots_of(Equation::magnitude, m);
    Propagation doubt;
    estimate.by_direction = likeliest(direction, Equation::magnitude, m);
    estimate.by_magnitude = likeliest(magnitude, Equation::direction, m);
    propagate(m, estimate.by_direction, Equation::direction, doubt.direction);
    propagate(m, estimate.by_magnitude, Equation::magnitude, doubt.magnitude);
    estimate.reason = join(doubt, estimate);
    fill_ratios(m, estimate);
    return estimate;
}

template <typename Scalar, int Nodes>
Scalar ForceDropImmersion<Scalar, Nodes>::pressure_by_averages_N_per_mm(const ForceDropMeasurement<Scalar>& m,
                                                                        Scalar theta_rad) const {
    using elementary::cos;
    using elementary::exp;
    const ForceDropRatios<Scalar> ratios = ratios_at(inputs_of(m), m, theta_rad);
    return ratios.mean_pressure_N_per_mm * exp(law_.c.dot(pressure_regressors(cos(theta_rad), m.feed_per_tooth_mm)));
}

template <typename Scalar, int Nodes>
typename ForceDropEstimate<Scalar>::Reason ForceDropImmersion<Scalar, Nodes>::reason_against(
    const ForceDropMeasurement<Scalar>& m) const {
    using Reason = typename ForceDropEstimate<Scalar>::Reason;
    if (!law_.valid) {
        return Reason::no_law;
    }
    if (m.side != CutSide::up && m.side != CutSide::down) {
        return Reason::side_unknown;
    }
    const bool measured = m.tooth_x_N.valid && m.tooth_y_N.valid && m.mean_x_N.valid && m.mean_y_N.valid;
    const bool usable = measured && m.feed_per_tooth_mm > Scalar(0) && m.teeth >= Scalar(1);
    return usable ? Reason::estimated : Reason::no_drop;
}

template <typename Scalar, int Nodes>
bool ForceDropImmersion<Scalar, Nodes>::is_known(const ForceDropEstimate<Scalar>& estimate) const {
    return estimate.radial_immersion_sd <= settings_.largest_sd &&
           estimate.radial_immersion_sd <= settings_.largest_relative_sd * estimate.radial_immersion;
}

template <typename Scalar, int Nodes>
ForceDropInputs<Scalar> ForceDropImmersion<Scalar, Nodes>::inputs_of(const ForceDropMeasurement<Scalar>& m) const {
    return {m.tooth_x_N.value, m.tooth_y_N.value, m.mean_x_N.value, m.mean_y_N.value, law_.e_t_mm, law_.e_r_mm};
}

template <typename Scalar, int Nodes>
ForceDropRatios<Scalar> ForceDropImmersion<Scalar, Nodes>::ratios_at(const ForceDropInputs<Scalar>& in,
                                                                     const ForceDropMeasurement<Scalar>& m,
                                                                     Scalar theta_rad) {
    const EngagementAngles<Scalar> engagement = m.side == CutSide::up
                                                    ? EngagementAngles<Scalar>{Scalar(0), theta_rad}
                                                    : EngagementAngles<Scalar>{pi<Scalar> - theta_rad, pi<Scalar>};
    return force_drop_ratios(in, m.feed_per_tooth_mm, m.teeth, m.side, engagement);
}

template <typename Scalar, int Nodes>
typename ForceDropImmersion<Scalar, Nodes>::Value ForceDropImmersion<Scalar, Nodes>::residual(
    Equation equation, const ForceDropInputs<Scalar>& in, const ForceDropMeasurement<Scalar>& m,
    Scalar theta_rad) const {
    using elementary::cos;
    using elementary::log;
    using std::atan;
    const ForceDropRatios<Scalar> ratios = ratios_at(in, m, theta_rad);
    if (!ratios.possible) {
        return {};
    }
    if (equation == Equation::direction) {
        return {true, atan(ratios.r) - atan(law_.a * likely_r_av(ratios, m).value + law_.b)};
    }
    return {true, log(ratios.pressure_N_per_mm / ratios.mean_pressure_N_per_mm) -
                      law_.c.dot(pressure_regressors(cos(theta_rad), m.feed_per_tooth_mm))};
}

template <typename Scalar, int Nodes>
typename ForceDropImmersion<Scalar, Nodes>::Roots ForceDropImmersion<Scalar, Nodes>::roots_of(
    Equation equation, const ForceDropMeasurement<Scalar>& m) const {
    using elementary::acos;
    const ForceDropInputs<Scalar> in = inputs_of(m);
    const Scalar first = acos(Scalar(1) - law_.smallest_immersion);
    const Scalar step = (acos(Scalar(1) - law_.largest_immersion) - first) / Scalar(Nodes - 1);
    Roots roots;
    Value before = residual(equation, in, m, first);
    for (int k = 1; k < Nodes && roots.count < most_roots; ++k) {
        const Scalar theta = first + step * Scalar(k);
        const Value here = residual(equation, in, m, theta);
        if (before.valid && here.valid && (before.value < Scalar(0)) != (here.value < Scalar(0))) {
            roots.theta_rad[static_cast<std::size_t>(roots.count)] =
                close_bracket(equation, in, m, {theta - step, before.value}, {theta, here.value});
            ++roots.count;
        }
        before = here;
    }
    return roots;
}

/// Illinois: regula falsi in which an end that stays twice is halved. Gains a digit and a half per step.
template <typename Scalar, int Nodes>
Scalar ForceDropImmersion<Scalar, Nodes>::close_bracket(Equation equation, const ForceDropInputs<Scalar>& in,
                                                        const ForceDropMeasurement<Scalar>& m, Point low,
                                                        Point high) const {
    constexpr int most_steps = 12;
    constexpr Scalar close_enough_rad = literal<Scalar>(2e-6L);
    int stayed = 0;
    for (int k = 0; k < most_steps && high.theta_rad - low.theta_rad > close_enough_rad; ++k) {
        const Scalar theta = (low.theta_rad * high.value - high.theta_rad * low.value) / (high.value - low.value);
        const Value at = residual(equation, in, m, theta);
        if (!at.valid || at.value == Scalar(0)) {
            return theta;
        }
        const bool below = (at.value < Scalar(0)) == (low.value < Scalar(0));
        (below ? low : high) = {theta, at.value};
        if (below) {
            high.value *= stayed == 1 ? Scalar(0.5F) : Scalar(1);
            stayed = 1;
        } else {
            low.value *= stayed == -1 ? Scalar(0.5F) : Scalar(1);
            stayed = -1;
        }
    }
    return (low.theta_rad * high.value - high.theta_rad * low.value) / (high.value - low.value);
}

/// Of several roots the one at which the other equation is least violated, if by less than half of the next: the
/// direction equation may have two roots or touch zero without one, the magnitude equation has a second one near
/// 90°.
template <typename Scalar, int Nodes>
ForceDropRoot<Scalar> ForceDropImmersion<Scalar, Nodes>::likeliest(const Roots& roots, Equation other,
                                                                   const ForceDropMeasurement<Scalar>& m) const {
    const ForceDropInputs<Scalar> in = inputs_of(m);
    ForceDropRoot<Scalar> chosen;
    constexpr Scalar beyond_all = Scalar(1000);
    constexpr Scalar without_value = Scalar(10);  // more than any residual, and less than no root at all
    Scalar least = beyond_all;
    Scalar next = beyond_all;
    for (std::size_t i = 0; i < static_cast<std::size_t>(roots.count); ++i) {
        const Value at = residual(other, in, m, roots.theta_rad[i]);
        const Scalar violated = !at.valid ? without_value : (at.value < Scalar(0) ? -at.value : at.value);
        if (violated < least) {
            next = least;
            least = violated;
            chosen = {true, roots.theta_rad[i], Scalar(0)};
        } else {
            next = violated < next ? violated : next;
        }
    }
    chosen.valid = chosen.valid && least < Scalar(0.5F) * next;
    return chosen;
}

/// Moves each input by its standard deviation: Δθ = −Δg / (∂g/∂θ). Fills the root's variance, the law's included.
template <typename Scalar, int Nodes>
void ForceDropImmersion<Scalar, Nodes>::propagate(const ForceDropMeasurement<Scalar>& m, ForceDropRoot<Scalar>& root,
                                                  Equation equation, Changes& changes) const {
    using std::sqrt;
    if (!root.valid) {
        return;
    }
    constexpr Scalar step_rad = literal<Scalar>(0.01L);
    const ForceDropInputs<Scalar> in = inputs_of(m);
    const Value above = residual(equation, in, m, root.theta_rad + step_rad);
    const Value below = residual(equation, in, m, root.theta_rad - step_rad);
    const Scalar slope = (above.value - below.value) / (Scalar(2) * step_rad);
    if (!above.valid || !below.valid || slope == Scalar(0)) {
        root.valid = false;
        return;
    }
    const std::array<Scalar, input_count> sd{sqrt(m.tooth_x_N.variance),
                                             sqrt(m.tooth_y_N.variance),
                                             sqrt(m.mean_x_N.variance),
                                             sqrt(m.mean_y_N.variance),
                                             law_.e_t_sd_mm,
                                             law_.e_r_sd_mm};
    root.variance = law_variance(equation, m, root.theta_rad) / square(slope);
    for (std::size_t k = 0; k < input_count; ++k) {
        const Value up = residual(equation, moved(in, k, sd[k]), m, root.theta_rad);
        const Value down = residual(equation, moved(in, k, -sd[k]), m, root.theta_rad);
        root.valid = root.valid && up.valid && down.valid;
        changes[k] = -(up.value - down.value) / (Scalar(2) * slope);
        root.variance += square(changes[k]);
    }
}

template <typename Scalar, int Nodes>
ForceDropInputs<Scalar> ForceDropImmersion<Scalar, Nodes>::moved(ForceDropInputs<Scalar> in, std::size_t k, Scalar by) {
    Scalar* const fields[input_count] = {&in.tooth_x_N, &in.tooth_y_N, &in.mean_x_N,
                                         &in.mean_y_N,  &in.e_t_mm,    &in.e_r_mm};
    *fields[k] += by;
    return in;
}

/// r_av as measured, shrunk towards the calibration mean, the more so the larger its uncertainty is against the
/// calibration's spread. The variance is what remains of it beyond the measured forces' own, which propagate()
/// counts.
template <typename Scalar, int Nodes>
Measurement<Scalar> ForceDropImmersion<Scalar, Nodes>::likely_r_av(const ForceDropRatios<Scalar>& ratios,
                                                                   const ForceDropMeasurement<Scalar>& m) const {
    const Scalar spread = square(law_.r_av_sd);
    const Scalar doubt =
        square(ratios.r_av_per_x) * m.mean_x_N.variance + square(ratios.r_av_per_y) * m.mean_y_N.variance;
    const Scalar share = spread > Scalar(0) ? spread / (spread + doubt) : Scalar(1);
    return {true, law_.r_av_mean + share * (ratios.r_av - law_.r_av_mean), square(Scalar(1) - share) * spread, {}};
}

/// Variance of the residual, from the uncertainty of the calibrated line and the scatter about it.
template <typename Scalar, int Nodes>
Scalar ForceDropImmersion<Scalar, Nodes>::law_variance(Equation equation, const ForceDropMeasurement<Scalar>& m,
                                                       Scalar theta_rad) const {
    using elementary::cos;
    if (equation == Equation::magnitude) {
        const auto z = pressure_regressors(cos(theta_rad), m.feed_per_tooth_mm);
        return z.dot(law_.c_covariance * z) + square(law_.ln_K_scatter);
    }
    const ForceDropRatios<Scalar> ratios = ratios_at(inputs_of(m), m, theta_rad);
    const Measurement<Scalar> r_av = likely_r_av(ratios, m);
    const Eigen::Matrix<Scalar, 2, 1> z(r_av.value, Scalar(1));
    const Scalar variance = z.dot(law_.a_b_covariance * z) + square(law_.a) * r_av.variance + square(law_.r_scatter);
    return variance / square(Scalar(1) + square(ratios.r));
}

/// Weights of least variance for two correlated roots, none of them negative.
template <typename Scalar, int Nodes>
typename ForceDropEstimate<Scalar>::Reason ForceDropImmersion<Scalar, Nodes>::join(
    const Propagation& doubt, ForceDropEstimate<Scalar>& estimate) const {
    using Reason = typename ForceDropEstimate<Scalar>::Reason;
    using elementary::sin;
    using std::sqrt;
    const ForceDropRoot<Scalar>& A = estimate.by_direction;
    const ForceDropRoot<Scalar>& B = estimate.by_magnitude;
    if (!A.valid && !B.valid) {
        return Reason::no_root;
    }
    Scalar share_of_A = A.valid ? Scalar(1) : Scalar(0);
    Scalar covariance{0};
    bool agree = true;
    if (A.valid && B.valid) {
        for (std::size_t k = 0; k < input_count; ++k) {
            covariance += doubt.direction[k] * doubt.magnitude[k];
        }
        const Scalar of_difference = A.variance + B.variance - Scalar(2) * covariance;
        agree = square(A.theta_rad - B.theta_rad) <= square(settings_.largest_disagreement) * of_difference;
        share_of_A = of_difference > Scalar(0) ? clamp((B.variance - covariance) / of_difference, Scalar(0), Scalar(1))
                                               : Scalar(0);
    }
    const Scalar share_of_B = Scalar(1) - share_of_A;
    estimate.theta_rad = share_of_A * A.theta_rad + share_of_B * B.theta_rad;
    const Scalar variance = square(share_of_A) * A.variance + square(share_of_B) * B.variance +
                            Scalar(2) * share_of_A * share_of_B * covariance;
    estimate.radial_immersion = ForceDropRoot<Scalar>{true, estimate.theta_rad, variance}.immersion();
    estimate.radial_immersion_sd = sin(estimate.theta_rad) * sqrt(variance > Scalar(0) ? variance : Scalar(0));
    return !agree ? Reason::disagreement : is_known(estimate) ? Reason::estimated : Reason::too_uncertain;
}

template <typename Scalar, int Nodes>
void ForceDropImmersion<Scalar, Nodes>::fill_ratios(const ForceDropMeasurement<Scalar>& m,
                                                    ForceDropEstimate<Scalar>& estimate) const {
    const ForceDropRatios<Scalar> ratios = ratios_at(inputs_of(m), m, estimate.theta_rad);
    estimate.r = ratios.r;
    estimate.r_av = ratios.r_av;
    estimate.pressure_N_per_mm = ratios.pressure_N_per_mm;
}

}  // namespace millforce::estimation
