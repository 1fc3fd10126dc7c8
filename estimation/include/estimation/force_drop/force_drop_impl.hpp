// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of force_drop.hpp. src/force_drop.cpp instantiates them for float and Fixed.

#include "estimation/force_drop/air_gap.hpp"
#include "estimation/force_drop/force_drop.hpp"
#include "estimation/force_drop/force_drop_detector_impl.hpp"
#include "estimation/force_drop/force_drop_immersion_impl.hpp"
#include "estimation/number/elementary.hpp"

#include <cmath>

namespace millforce::estimation {

/// A tried position of the other edge: the θ that the drop then gives, and how badly the signal fits.
template <typename Scalar, int Bins>
struct ForceDrop<Scalar, Bins>::Closure {
    bool valid = false;
    Scalar theta_rad{0};   ///< put in
    Scalar excess_rad{0};  ///< what comes out, less what was put in
    Scalar variance{0};    ///< variance of what comes out, in rad²
    Scalar residual_N2{0};
};

template <typename Scalar, int Bins>
ForceDrop<Scalar, Bins>::ForceDrop(const ForceDropLaw<Scalar>& law, const ForceDropSettings<Scalar>& settings)
    : settings_(settings),
      profile_(settings.revolutions),
      detector_(settings.detector),
      immersion_(law, settings.immersion) {}

template <typename Scalar, int Bins>
void ForceDrop<Scalar, Bins>::restart() {
    profile_.restart();
    complete_ = false;
}

template <typename Scalar, int Bins>
bool ForceDrop<Scalar, Bins>::add(const ForceDropSample<Scalar>& sample, Scalar feed_per_tooth_mm) {
    if (!collect(sample)) {
        return false;
    }
    evaluate(feed_per_tooth_mm);
    return true;
}

template <typename Scalar, int Bins>
bool ForceDrop<Scalar, Bins>::collect(const ForceDropSample<Scalar>& sample) {
    complete_ = complete_ || profile_.add(sample.spindle_angle_rev, sample.dt_s, sample.fx_N, sample.fy_N);
    return complete_;
}

template <typename Scalar, int Bins>
const typename ForceDrop<Scalar, Bins>::Estimate& ForceDrop<Scalar, Bins>::evaluate(Scalar feed_per_tooth_mm) {
    if (complete_) {
        estimate_profile(feed_per_tooth_mm);
        profile_.clear();
        complete_ = false;
    }
    return estimate_;
}

template <typename Scalar, int Bins>
void ForceDrop<Scalar, Bins>::estimate_profile(Scalar feed_per_tooth_mm) {
    if (settings_.known_immersion > Scalar(0)) {
        measure_known(feed_per_tooth_mm);
        return;
    }
    jump_ = detector_.detect(profile_);
    estimate_from(jump_, feed_per_tooth_mm, largest_theta_rad());
    if (!jump_.valid()) {
        estimate_.reason = jump_.reason == ForceJump<Scalar>::Reason::too_fast ? Estimate::Reason::too_fast
                                                                               : Estimate::Reason::no_drop;
        return;
    }
    const Scalar first_rad = estimate_.theta_rad;
    if (!(first_rad > Scalar(0))) {
        return;
    }
    estimate_from(jump_, feed_per_tooth_mm, first_rad);
    const Scalar reach = first_share_in_doubt * first_rad;
    OtherEdge<Scalar> edge;
    if (other_edge_acts_between(first_rad - reach, first_rad + reach)) {
        close_other_edge(first_rad, reach, feed_per_tooth_mm);
        edge = other_edge(estimate_.theta_rad, feed_per_tooth_mm);
    }
    if (jump_.valid() && detector_.another_filter_fits(profile_, jump_, edge)) {
        estimate_.reason = Estimate::Reason::other_filter;
    }
}

/// While θ is not known: what is air at the largest θ is air in any case.
template <typename Scalar, int Bins>
Scalar ForceDrop<Scalar, Bins>::largest_theta_rad() const {
    using elementary::acos;
    return acos(Scalar(1) - immersion_.law().largest_immersion);
}

/// One solution from a jump. `theta_rad` as far as it is known, for the air gap.
template <typename Scalar, int Bins>
void ForceDrop<Scalar, Bins>::estimate_from(const ForceJump<Scalar>& jump, Scalar feed_per_tooth_mm, Scalar theta_rad) {
    measurement_ = measurement_of(jump, feed_per_tooth_mm);
    take_zero_off(jump, theta_rad);
    estimate_ = immersion_.solve(measurement_);
}

template <typename Scalar, int Bins>
bool ForceDrop<Scalar, Bins>::other_edge_acts_between(Scalar low_rad, Scalar high_rad) const {
    constexpr int places = 5;
    bool acts = false;
    for (int k = 0; k < places; ++k) {
        const Scalar theta_rad = low_rad + (high_rad - low_rad) * Scalar(k) / Scalar(places - 1);
        acts = acts || detector_.acts_on_window(profile_, other_edge_behind_rev(measurement_.side, theta_rad));
    }
    return acts;
}

/// Puts the other edge where it would be at θ, takes it off, and solves.
template <typename Scalar, int Bins>
typename ForceDrop<Scalar, Bins>::Closure ForceDrop<Scalar, Bins>::close_at(Scalar theta_rad, Scalar feed_per_tooth_mm,
                                                                            const ForceJump<Scalar>& first) {
    using elementary::sin;
    constexpr Scalar doubt_in_taken_off = literal<Scalar>(0.5L);
    jump_ = detector_.detect_near(profile_, first.angle_rev, other_edge(theta_rad, feed_per_tooth_mm));
    jump_.x_N.variance += square(doubt_in_taken_off * (jump_.x_N.value - first.x_N.value));
    jump_.y_N.variance += square(doubt_in_taken_off * (jump_.y_N.value - first.y_N.value));
    estimate_from(jump_, feed_per_tooth_mm, theta_rad);
    if (!jump_.valid() || !(estimate_.theta_rad > Scalar(0))) {
        return {};
    }
    const Scalar sd_rad = estimate_.radial_immersion_sd / sin(estimate_.theta_rad);
    return {true, theta_rad, estimate_.theta_rad - theta_rad, square(sd_rad), jump_.residual_N2};
}

/// Two conditions determine θ here: what is put in must come out, and the edge must be taken off where it is, else
/// the signal fits badly. The first alone fails at coincidence, where what comes out follows what is put in; the
/// second knows the edge's place within `place_sd_rad` (runout moves it), and its shape within some 70 % of the
/// least residual.
template <typename Scalar, int Bins>
Scalar ForceDrop<Scalar, Bins>::misfit(const Closure& closure, Scalar least_residual_N2) {
    constexpr Scalar per_relative_residual = Scalar(1.5F);  // 1 for two thirds above the least residual
    return square(closure.excess_rad) / (closure.variance + square(place_sd_rad)) +
           per_relative_residual * (closure.residual_N2 / least_residual_N2 - Scalar(1));
}

template <typename Scalar, int Bins>
void ForceDrop<Scalar, Bins>::close_other_edge(Scalar first_rad, Scalar reach_rad, Scalar feed_per_tooth_mm) {
    const ForceJump<Scalar> first = jump_;
    Closures tried{};
    Scalar step_rad = Scalar(2) * reach_rad / Scalar(closing_nodes - 1);
    for (std::size_t k = 0; k < closing_nodes; ++k) {
        tried[k] = close_at(first_rad - reach_rad + step_rad * Scalar(k), feed_per_tooth_mm, first);
    }
    for (std::size_t halving = 0; halving < closing_halvings; ++halving) {
        const Scalar best_rad = tried[best_of(tried)].theta_rad;
        step_rad *= Scalar(0.5F);
        const std::size_t next = closing_nodes + 2 * halving;
        tried[next] = close_at(best_rad - step_rad, feed_per_tooth_mm, first);
        tried[next + 1] = close_at(best_rad + step_rad, feed_per_tooth_mm, first);
    }
    const Closure best = tried[best_of(tried)];
    if (!best.valid) {
        estimate_.reason = Estimate::Reason::no_root;
        return;
    }
    close_at(best.theta_rad, feed_per_tooth_mm, first);
    join_place(best, is_ambiguous(tried, best));
}

template <typename Scalar, int Bins>
Scalar ForceDrop<Scalar, Bins>::least_residual_N2(const Closures& tried) {
    Scalar least{-1};
    for (const Closure& closure : tried) {
        least = closure.valid && (least < Scalar(0) || closure.residual_N2 < least) ? closure.residual_N2 : least;
    }
    return least > Scalar(0) ? least : Scalar(1);
}

template <typename Scalar, int Bins>
std::size_t ForceDrop<Scalar, Bins>::best_of(const Closures& tried) {
    const Scalar least = least_residual_N2(tried);
    std::size_t best = 0;
    for (std::size_t k = 1; k < tried.size(); ++k) {
        const bool better = !tried[best].valid || misfit(tried[k], least) < misfit(tried[best], least);
        best = tried[k].valid && better ? k : best;
    }
    return best;
}

/// Another immersion, far off, that explains drop and signal nearly as well. In down milling the force that the
/// other tooth takes along at its exit points as the jump does, and the two are harder to distinguish.
template <typename Scalar, int Bins>
bool ForceDrop<Scalar, Bins>::is_ambiguous(const Closures& tried, const Closure& best) const {
    constexpr Scalar far_rad = literal<Scalar>(0.12L);  // four times place_sd_rad: no neighbour of the best
    // A misfit is a sum of squared deviations, and exp(−Δ/2) the likelihood beside the best: 0.78 and 0.54 of it.
    constexpr Scalar nearly_in_up_milling{0.5F};
    constexpr Scalar nearly_in_down_milling{1.25F};
    const Scalar nearly = measurement_.side == CutSide::up ? nearly_in_up_milling : nearly_in_down_milling;
    const Scalar least = least_residual_N2(tried);
    bool ambiguous = false;
    for (const Closure& closure : tried) {
        ambiguous = ambiguous || (closure.valid && square(closure.theta_rad - best.theta_rad) > square(far_rad) &&
                                  misfit(closure, least) < misfit(best, least) + nearly);
    }
    return ambiguous;
}

/// θ by the edge's place and θ by the drop, weighted.
template <typename Scalar, int Bins>
void ForceDrop<Scalar, Bins>::join_place(const Closure& best, bool ambiguous) {
    using elementary::cos;
    using elementary::sin;
    using std::sqrt;
    const Scalar of_place = square(place_sd_rad);
    const Scalar total = of_place + best.variance;
    estimate_.theta_rad = best.theta_rad + best.excess_rad * of_place / total;
    estimate_.radial_immersion = Scalar(1) - cos(estimate_.theta_rad);
    const bool disagrees = square(best.excess_rad) > square(settings_.immersion.largest_disagreement) * total;
    estimate_.radial_immersion_sd =
        sin(estimate_.theta_rad) * sqrt(of_place * best.variance / total + square(Scalar(0.5F) * best.excess_rad));
    estimate_.reason = ambiguous   ? Estimate::Reason::ambiguous
                       : disagrees ? Estimate::Reason::disagreement
                                   : Estimate::Reason::estimated;
}

template <typename Scalar, int Bins>
void ForceDrop<Scalar, Bins>::measure_known(Scalar feed_per_tooth_mm) {
    using elementary::acos;
    jump_ = detector_.detect(profile_);
    measurement_ = measurement_of(jump_, feed_per_tooth_mm);
    estimate_ = {};
    if (!jump_.valid()) {
        return;
    }
    const Scalar theta_rad = acos(Scalar(1) - settings_.known_immersion);
    take_zero_off(jump_, theta_rad);
    const ForceJump<Scalar> other =
        detector_.measure_at(profile_, jump_.angle_rev + other_edge_behind_rev(measurement_.side, theta_rad));
    constexpr Scalar per_rad = Scalar(1) / (Scalar(2) * pi<Scalar>);
    measurement_.has_other_edge = true;
    measurement_.other_step_x_N = other.x_N.value;
    measurement_.other_step_y_N = other.y_N.value;
    measurement_.other_slope_x_N_per_rad = other.slope_x_N_per_rev * per_rad;
    measurement_.other_slope_y_N_per_rad = other.slope_y_N_per_rev * per_rad;
}

/// From the jump on, the spindle turns so far to the other edge of the cut, modulo the pitch: back to where the
/// tooth entered an up cut, on to where it leaves a down cut.
template <typename Scalar, int Bins>
Scalar ForceDrop<Scalar, Bins>::other_edge_behind_rev(CutSide side, Scalar theta_rad) {
    return (side == CutSide::up ? Scalar(-1) : Scalar(1)) * theta_rad / (Scalar(2) * pi<Scalar>);
}

template <typename Scalar, int Bins>
void ForceDrop<Scalar, Bins>::take_zero_off(const ForceJump<Scalar>& jump, Scalar theta_rad) {
    const Scalar stays = square(settings_.mean_force_sd_N);
    measurement_.mean_x_N.variance += stays + square(settings_.zero_drift_sd_N);
    measurement_.mean_y_N.variance += stays + square(settings_.zero_drift_sd_N);
    if (!jump.valid()) {
        return;
    }
    const Scalar leaves_rev =
        jump.angle_rev + (measurement_.side == CutSide::up ? Scalar(0) : theta_rad / (Scalar(2) * pi<Scalar>));
    const Scalar settling_rev = settings_.detector.response.settling_s() / (profile_.seconds_per_bin() * Scalar(Bins));
    const Scalar gap_rev = Scalar(1) / Scalar(settings_.detector.teeth) - theta_rad / (Scalar(2) * pi<Scalar>);
    const AirGap<Scalar> gap =
        read_air_gap(profile_, settings_.detector.teeth, leaves_rev + settling_rev, gap_rev - settling_rev);
    if (gap.valid) {
        const Scalar inflation =
            Scalar(1) / settings_.detector.response.independent_share(Scalar(1) / profile_.seconds_per_bin());
        measurement_.mean_x_N.value -= gap.x_N;
        measurement_.mean_y_N.value -= gap.y_N;
        measurement_.mean_x_N.variance = jump.mean_x_N.variance + stays + gap.x_variance * inflation;
        measurement_.mean_y_N.variance = jump.mean_y_N.variance + stays + gap.y_variance * inflation;
    }
}

template <typename Scalar, int Bins>
ForceDropMeasurement<Scalar> ForceDrop<Scalar, Bins>::measurement_of(const ForceJump<Scalar>& jump,
                                                                     Scalar feed_per_tooth_mm) const {
    ForceDropMeasurement<Scalar> m;
    m.feed_per_tooth_mm = feed_per_tooth_mm;
    m.teeth = Scalar(settings_.detector.teeth);
    if (!jump.valid()) {
        return m;
    }
    const Scalar along = jump.x_N.value * jump.mean_x_N.value + jump.y_N.value * jump.mean_y_N.value;
    m.side = settings_.side == CutSide::unknown ? (along < Scalar(0) ? CutSide::up : CutSide::down) : settings_.side;
    const Scalar sign = m.side == CutSide::up ? Scalar(-1) : Scalar(1);
    m.tooth_x_N = jump.x_N;
    m.tooth_y_N = jump.y_N;
    m.tooth_x_N.value *= sign;
    m.tooth_y_N.value *= sign;
    m.mean_x_N = jump.mean_x_N;
    m.mean_y_N = jump.mean_y_N;
    return m;
}

template <typename Scalar, int Bins>
OtherEdge<Scalar> ForceDrop<Scalar, Bins>::other_edge(Scalar theta_rad, Scalar feed_per_tooth_mm) const {
    const ForceDropLaw<Scalar>& law = immersion_.law();
    const Scalar pressure = immersion_.pressure_by_averages_N_per_mm(measurement_, theta_rad);
    const Scalar chip_N_per_rev = (measurement_.side == CutSide::up ? Scalar(1) : Scalar(-1)) * pressure *
                                  feed_per_tooth_mm * (Scalar(2) * pi<Scalar>);
    OtherEdge<Scalar> other;
    other.present = true;
    other.behind_rev = other_edge_behind_rev(measurement_.side, theta_rad);
    other.step_x_N = pressure * law.other_step_x_mm;
    other.step_y_N = pressure * law.other_step_y_mm;
    other.slope_x_N_per_rev = chip_N_per_rev * law.other_slope_x;
    other.slope_y_N_per_rev = chip_N_per_rev * law.other_slope_y;
    return other;
}

}  // namespace millforce::estimation
