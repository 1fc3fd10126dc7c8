// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of force_drop_detector.hpp. src/force_drop.cpp instantiates them for float and Fixed.

#include "estimation/force_drop/force_drop_detector.hpp"

#include <Eigen/Cholesky>

#include <cmath>

namespace millforce::estimation {

template <typename Scalar, int Bins, int MaxWindow>
struct ForceDropDetector<Scalar, Bins, MaxWindow>::Window {
    int before{0};  ///< grid points
    int after{0};
    Scalar seconds_per_bin{0};
    Scalar independent_share{1};
    bool fits = false;
};

/// Fit of all teeth at one place.
template <typename Scalar, int Bins, int MaxWindow>
struct ForceDropDetector<Scalar, Bins, MaxWindow>::Fit {
    Scalar residual_N2{0};
    Scalar step_x_N{0};
    Scalar step_y_N{0};
    Scalar slope_x_N_per_rev{0};
    Scalar slope_y_N_per_rev{0};
    Scalar step_gain{0};  ///< variance of one tooth's step per variance of one sample
    int free_points{0};   ///< per force
    Scalar residual_x_N2{0};
    Scalar residual_y_N2{0};
};

template <typename Scalar, int Bins, int MaxWindow>
ForceJump<Scalar> ForceDropDetector<Scalar, Bins, MaxWindow>::detect(const Profile& profile) const {
    const Window window = window_of(profile.seconds_per_bin());
    return window.fits ? refine(profile, window, {}, search(profile, window)) : too_fast();
}

template <typename Scalar, int Bins, int MaxWindow>
ForceJump<Scalar> ForceDropDetector<Scalar, Bins, MaxWindow>::detect_near(const Profile& profile, Scalar angle_rev,
                                                                          const OtherEdge<Scalar>& other) const {
    const Window window = window_of(profile.seconds_per_bin());
    return window.fits ? refine(profile, window, other, angle_rev * Scalar(Bins)) : too_fast();
}

template <typename Scalar, int Bins, int MaxWindow>
bool ForceDropDetector<Scalar, Bins, MaxWindow>::acts_on_window(const Profile& profile, Scalar behind_rev) const {
    const Window window = window_of(profile.seconds_per_bin());
    return place_in_window(window, behind_rev) <= Scalar(window.after);
}

template <typename Scalar, int Bins, int MaxWindow>
bool ForceDropDetector<Scalar, Bins, MaxWindow>::another_filter_fits(const Profile& profile,
                                                                     const ForceJump<Scalar>& jump,
                                                                     const OtherEdge<Scalar>& other_edge) const {
    constexpr Scalar clearly_less = literal<Scalar>(0.6L);
    const Scalar s_per_rev = profile.seconds_per_bin() * Scalar(Bins);
    bool fits = false;
    for (const Scalar factor : {Scalar(0.5F), literal<Scalar>(1.4L), Scalar(2)}) {
        Settings other = settings_;
        other.response.corner_hz *= factor;
        const Scalar earlier_rev = (other.response.lag_s() - settings_.response.lag_s()) / s_per_rev;
        const ForceJump<Scalar> with_other =
            ForceDropDetector(other).detect_near(profile, jump.angle_rev - earlier_rev, other_edge);
        fits = fits || (with_other.valid() && with_other.sample_variance_N2 < clearly_less * jump.sample_variance_N2);
    }
    return fits;
}

template <typename Scalar, int Bins, int MaxWindow>
ForceJump<Scalar> ForceDropDetector<Scalar, Bins, MaxWindow>::measure_at(const Profile& profile,
                                                                         Scalar angle_rev) const {
    const Window window = window_of(profile.seconds_per_bin());
    const Scalar place_bin = angle_rev * Scalar(Bins);
    return window.fits ? judge(profile, window, fit_at(profile, window, {}, place_bin), place_bin) : too_fast();
}

template <typename Scalar, int Bins, int MaxWindow>
typename ForceDropDetector<Scalar, Bins, MaxWindow>::Window ForceDropDetector<Scalar, Bins, MaxWindow>::window_of(
    Scalar seconds_per_bin) const {
    Window window;
    const Scalar pitch_bins = Scalar(Bins) / Scalar(settings_.teeth);
    const Scalar settling_bins = settings_.response.settling_s() / seconds_per_bin;
    if (!(seconds_per_bin > Scalar(0)) || settling_bins > settings_.largest_settling_pitches * pitch_bins) {
        return window;
    }
    const Scalar side = settings_.window_rev * Scalar(Bins);
    window.before = static_cast<int>(side);
    window.after = static_cast<int>(side + settling_bins);
    window.seconds_per_bin = seconds_per_bin;
    window.independent_share = settings_.response.independent_share(Scalar(1) / seconds_per_bin);
    window.fits = window.before >= 3 && window.before + window.after + 2 < MaxWindow &&
                  Scalar(window.before + window.after) < pitch_bins;
    return window;
}

/// Regressors at `bins` after the jump, each of order 1.
template <typename Scalar, int Bins, int MaxWindow>
typename ForceDropDetector<Scalar, Bins, MaxWindow>::Vector4 ForceDropDetector<Scalar, Bins, MaxWindow>::regressors(
    const Window& window, Scalar bins) const {
    const auto at = settings_.response.at(bins * window.seconds_per_bin);
    const Scalar scale = Scalar(1) / Scalar(window.after);
    return {Scalar(1), bins * scale, at.step, at.ramp_s / window.seconds_per_bin * scale};
}

template <typename Scalar, int Bins, int MaxWindow>
std::size_t ForceDropDetector<Scalar, Bins, MaxWindow>::index_in(const Window& window, int bin) {
    const int index = bin + window.before;
    return static_cast<std::size_t>(index);
}

template <typename Scalar, int Bins, int MaxWindow>
ForceJump<Scalar> ForceDropDetector<Scalar, Bins, MaxWindow>::too_fast() {
    ForceJump<Scalar> jump;
    jump.reason = ForceJump<Scalar>::Reason::too_fast;
    return jump;
}

/// Of an edge's repetitions a pitch apart, the first that acts on the window and is not linear there any more.
template <typename Scalar, int Bins, int MaxWindow>
Scalar ForceDropDetector<Scalar, Bins, MaxWindow>::place_in_window(const Window& window, Scalar behind_rev) const {
    using std::floor;
    const Scalar pitch = Scalar(Bins) / Scalar(settings_.teeth);
    const Scalar earliest = -Scalar(window.before + window.after);
    const Scalar from_earliest = behind_rev * Scalar(Bins) - earliest;
    return earliest + from_earliest - pitch * floor(from_earliest / pitch);
}

/// What the other edge adds at `bins` after the sought jump, subtracted.
template <typename Scalar, int Bins, int MaxWindow>
void ForceDropDetector<Scalar, Bins, MaxWindow>::take_off(const Window& window, const OtherEdge<Scalar>& other,
                                                          Scalar bins, Scalar& x_N, Scalar& y_N) const {
    if (!other.present) {
        return;
    }
    const Scalar at_bins = place_in_window(window, other.behind_rev);
    const auto at = settings_.response.at((bins - at_bins) * window.seconds_per_bin);
    const Scalar ramp_rev = at.ramp_s / (window.seconds_per_bin * Scalar(Bins));
    x_N -= other.step_x_N * at.step + other.slope_x_N_per_rev * ramp_rev;
    y_N -= other.step_y_N * at.step + other.slope_y_N_per_rev * ramp_rev;
}

/// The grid point where allowing a jump gains most.
template <typename Scalar, int Bins, int MaxWindow>
Scalar ForceDropDetector<Scalar, Bins, MaxWindow>::search(const Profile& profile, const Window& window) const {
    std::array<Scalar, static_cast<std::size_t>(MaxWindow)> weights{};
    fill_step_weights(window, weights);
    const Scalar pitch = Scalar(Bins) / Scalar(settings_.teeth);
    Scalar best_gain{-1};
    int best = 0;
    for (int p = 0; Scalar(p) < pitch; ++p) {
        Scalar gain{0};
        for (int tooth = 0; tooth < settings_.teeth; ++tooth) {
            const int centre = p + static_cast<int>(Scalar(tooth) * pitch + Scalar(0.5F));
            Scalar x{0};
            Scalar y{0};
            for (int i = -window.before; i <= window.after; ++i) {
                const Scalar weight = weights[index_in(window, i)];
                x += weight * profile.x_N(centre + i);
                y += weight * profile.y_N(centre + i);
            }
            gain += x * x + y * y;
        }
        if (gain > best_gain) {
            best_gain = gain;
            best = p;
        }
    }
    return Scalar(best);
}

/// d = Σ weight · y at a jump on a grid point: the third row of (XᵀX)⁻¹Xᵀ.
template <typename Scalar, int Bins, int MaxWindow>
void ForceDropDetector<Scalar, Bins, MaxWindow>::fill_step_weights(
    const Window& window, std::array<Scalar, static_cast<std::size_t>(MaxWindow)>& weights) const {
    Matrix4 gram = Matrix4::Zero();
    for (int i = -window.before; i <= window.after; ++i) {
        const Vector4 x = regressors(window, Scalar(i));
        gram += x * x.transpose();
    }
    const Vector4 step_only = Vector4::Unit(2);
    const Vector4 row = Factors(gram).solve(step_only);
    for (int i = -window.before; i <= window.after; ++i) {
        weights[index_in(window, i)] = row.dot(regressors(window, Scalar(i)));
    }
}

template <typename Scalar, int Bins, int MaxWindow>
typename ForceDropDetector<Scalar, Bins, MaxWindow>::Fit ForceDropDetector<Scalar, Bins, MaxWindow>::fit_at(
    const Profile& profile, const Window& window, const OtherEdge<Scalar>& other, Scalar place_bin) const {
    using std::ceil;
    Fit fit;
    const Scalar pitch = Scalar(Bins) / Scalar(settings_.teeth);
    for (int tooth = 0; tooth < settings_.teeth; ++tooth) {
        const Scalar centre = place_bin + Scalar(tooth) * pitch;
        const int first = static_cast<int>(ceil(centre)) - window.before;
        const int last = static_cast<int>(ceil(centre)) + window.after;
        add_tooth(profile, window, other, centre, first, last, fit);
    }
    const Scalar share = Scalar(1) / Scalar(settings_.teeth);
    fit.step_x_N *= share;
    fit.step_y_N *= share;
    fit.slope_x_N_per_rev *= share;
    fit.slope_y_N_per_rev *= share;
    fit.step_gain *= share;
    fit.residual_N2 = fit.residual_x_N2 + fit.residual_y_N2;
    return fit;
}

template <typename Scalar, int Bins, int MaxWindow>
void ForceDropDetector<Scalar, Bins, MaxWindow>::add_tooth(const Profile& profile, const Window& window,
                                                           const OtherEdge<Scalar>& other, Scalar centre, int first,
                                                           int last, Fit& fit) const {
    Matrix4 gram = Matrix4::Zero();
    Vector4 moments_x = Vector4::Zero();
    Vector4 moments_y = Vector4::Zero();
    Scalar squares_x{0};
    Scalar squares_y{0};
    const Scalar level_x = profile.x_N(first);  // taken off first: float keeps the digits of the residual
    const Scalar level_y = profile.y_N(first);
    for (int bin = first; bin <= last; ++bin) {
        const Vector4 r = regressors(window, Scalar(bin) - centre);
        Scalar x = profile.x_N(bin) - level_x;
        Scalar y = profile.y_N(bin) - level_y;
        take_off(window, other, Scalar(bin) - centre, x, y);
        gram += r * r.transpose();
        moments_x += r * x;
        moments_y += r * y;
        squares_x += x * x;
        squares_y += y * y;
    }
    const Factors factors(gram);
    const Vector4 step_only = Vector4::Unit(2);
    const Vector4 cx = factors.solve(moments_x);
    const Vector4 cy = factors.solve(moments_y);
    const Vector4 inverse_row = factors.solve(step_only);
    fit.step_x_N += cx(2);
    fit.step_y_N += cy(2);
    fit.slope_x_N_per_rev += cx(3) * Scalar(Bins) / Scalar(window.after);
    fit.slope_y_N_per_rev += cy(3) * Scalar(Bins) / Scalar(window.after);
    fit.step_gain += inverse_row(2);
    fit.residual_x_N2 += squares_x - moments_x.dot(cx);
    fit.residual_y_N2 += squares_y - moments_y.dot(cy);
    fit.free_points += last - first + 1 - 4;
}

template <typename Scalar, int Bins, int MaxWindow>
ForceJump<Scalar> ForceDropDetector<Scalar, Bins, MaxWindow>::refine(const Profile& profile, const Window& window,
                                                                     const OtherEdge<Scalar>& other,
                                                                     Scalar near_bin) const {
    Scalar centre = near_bin;
    Scalar width{1};
    for (int round = 0; round < 4; ++round) {
        const Scalar low = fit_at(profile, window, other, centre - width).residual_N2;
        const Scalar mid = fit_at(profile, window, other, centre).residual_N2;
        const Scalar high = fit_at(profile, window, other, centre + width).residual_N2;
        const Scalar bend = low - Scalar(2) * mid + high;
        const Scalar shift =
            bend > Scalar(0) ? Scalar(0.5F) * (low - high) / bend : (low < high ? Scalar(-1) : Scalar(1));
        centre += clamp(shift, Scalar(-1), Scalar(1)) * width;
        width *= Scalar(0.5F);
    }
    return judge(profile, window, fit_at(profile, window, other, centre), centre);
}

template <typename Scalar, int Bins, int MaxWindow>
ForceJump<Scalar> ForceDropDetector<Scalar, Bins, MaxWindow>::judge(const Profile& profile, const Window& window,
                                                                    const Fit& fit, Scalar place_bin) const {
    ForceJump<Scalar> jump;
    const Scalar pitch_rev = Scalar(1) / Scalar(settings_.teeth);
    jump.angle_rev = place_bin / Scalar(Bins);
    jump.angle_rev += jump.angle_rev < Scalar(0) ? pitch_rev : Scalar(0);
    const Scalar inflation = Scalar(1) / window.independent_share;
    constexpr Scalar least_variance_N2 = literal<Scalar>(1e-12L);  // a perfect fit's weight 1/variance stays finite
    const auto measured = [&](Scalar step, Scalar residual_N2) {
        const Scalar sample_variance = (residual_N2 > Scalar(0) ? residual_N2 : Scalar(0)) / Scalar(fit.free_points);
        const Scalar variance =
            sample_variance * inflation * fit.step_gain / Scalar(settings_.teeth) + least_variance_N2;
        return Measurement<Scalar>{true, step, variance, variance};
    };
    jump.x_N = measured(fit.step_x_N, fit.residual_x_N2);
    jump.y_N = measured(fit.step_y_N, fit.residual_y_N2);
    jump.residual_N2 = fit.residual_N2;
    jump.sample_variance_N2 = fit.residual_N2 / Scalar(2 * fit.free_points);
    jump.slope_x_N_per_rev = fit.slope_x_N_per_rev;
    jump.slope_y_N_per_rev = fit.slope_y_N_per_rev;
    fill_means(profile, inflation, fit, jump);
    const Scalar size = square(jump.x_N.value) + square(jump.y_N.value);
    const Scalar doubt = jump.x_N.variance + jump.y_N.variance;
    jump.reason = size > square(settings_.least_significance) * doubt ? ForceJump<Scalar>::Reason::found
                                                                      : ForceJump<Scalar>::Reason::not_significant;
    return jump;
}

template <typename Scalar, int Bins, int MaxWindow>
void ForceDropDetector<Scalar, Bins, MaxWindow>::fill_means(const Profile& profile, Scalar inflation, const Fit& fit,
                                                            ForceJump<Scalar>& jump) const {
    Scalar x{0};
    Scalar y{0};
    for (int bin = 0; bin < Bins; ++bin) {
        x += profile.x_N(bin);
        y += profile.y_N(bin);
    }
    const Scalar per_mean = inflation / (Scalar(fit.free_points) * Scalar(Bins));
    const Scalar variance_x = (fit.residual_x_N2 > Scalar(0) ? fit.residual_x_N2 : Scalar(0)) * per_mean;
    const Scalar variance_y = (fit.residual_y_N2 > Scalar(0) ? fit.residual_y_N2 : Scalar(0)) * per_mean;
    jump.mean_x_N = {true, x / Scalar(Bins), variance_x, variance_x};
    jump.mean_y_N = {true, y / Scalar(Bins), variance_y, variance_y};
}

}  // namespace millforce::estimation
