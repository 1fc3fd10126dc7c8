// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/cut_state.hpp"
#include "estimation/cut_estimate.hpp"
#include "estimation/cutting/cutting_law.hpp"
#include "estimation/number/literal.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace millforce::firmware {

/// Whether spindle and axes tell of the same cut while the tool enters it.
///
/// Once the tool is in, F_at and the force along the feed are two numbers, and a wrong one of them is mostly the right
/// one of another cut. On the way in they must grow together: each piece of edge that comes into the cut brings an
/// in-plane force of F_t √(1 + ρ²), ρ = F_r/F_t. So from any moment of the entry to any later one, along an axis
///
///   |ΔF_axis| ≤ b ΔF_at,   b = 1.1 √(1 + ρ²), ρ by the tool's law at its entry feed
///
/// It begins in air, where all forces are zero. An axis whose friction jumps at the contact changes while F_at does not
/// yet; beside a spindle current that is saturated the axes go on changing. Judged once a revolution, on means that
/// forget a quarter in each; a change counts from three of its deviations on, which include friction and gain.
///
/// Where F_at falls, the feed falls or turns, an axis begins or ceases to have a force, or the tool moves along its
/// axis, the force may follow from that: it goes on from the new forces, and from those of air. A part whose one side
/// ends while the other begins can break the rule as well, so what comes of it is no fault: the tick does not believe
/// the axes, and the feed is held (limit law_misfit), until re-zeroing in air finds the axes as they should be.
///
/// Not for a load that comes late: the axes are then ahead of it. Cost: some 40 operations a revolution, no
/// division. No heap. One thread.
template <typename Scalar>
class EnteringCut {
  public:
    using Estimate = estimation::CutEstimate<Scalar>;

    /// Nothing is judged with an `entry_feed_per_tooth_mm` of 0.
    EnteringCut(const estimation::CuttingLaw<Scalar>& law, Scalar entry_feed_per_tooth_mm, int teeth)
        : per_tangential_(most_per_tangential(law, entry_feed_per_tooth_mm)), teeth_(teeth) {}

    /// Re-zeroing in air has found the axes.
    void clear() { contradicts_ = false; }
    /// Each estimate, with the state of the last answer.
    void follow(const Estimate& e, control::CutState state);

    [[nodiscard]] bool contradicts() const { return contradicts_; }

  private:
    using Force = estimation::Measurement<Scalar>;

    /// Of x or y: its mean force, and the least of F − b F_at and of −F − b F_at since the reference.
    struct Axis {
        Scalar mean_N{0};
        Scalar least_up_N{0};
        Scalar least_down_N{0};
    };

    static constexpr Scalar newest_share = Scalar(0.25F);
    static constexpr Scalar noise_left = newest_share / (Scalar(2) - newest_share);  // variance, of such a mean

    [[nodiscard]] static Scalar most_per_tangential(const estimation::CuttingLaw<Scalar>& law, Scalar feed_mm);
    void follow_air(const Estimate& e);
    void follow_entry(const Estimate& e);
    void average(const Estimate& e);
    void remember_move(const Estimate& e);
    [[nodiscard]] bool is_same_move(const Estimate& e) const;
    void begin(const Estimate& e);
    void forget();
    void judge(Axis& axis, const Force& force_N, Scalar tangential_noise);

    Scalar per_tangential_;  // b
    int teeth_;
    int periods_ = 0;
    bool contradicts_ = false;
    Scalar tangential_N_{0};  // mean
    Scalar largest_N_{0};     // of it
    std::array<Axis, 2> axes_{};
    std::array<bool, 2> has_force_{};
    Scalar feed_x_mm_s_{0};
    Scalar feed_y_mm_s_{0};
};

/// The mean chip of a half circle is 2/π of the feed.
template <typename Scalar>
Scalar EnteringCut<Scalar>::most_per_tangential(const estimation::CuttingLaw<Scalar>& law, Scalar feed_mm) {
    using estimation::literal;
    using std::sqrt;
    constexpr Scalar law_is_off_by = literal<Scalar>(1.1L);
    constexpr Scalar mean_chip = literal<Scalar>(0.6366L);
    const Scalar chip_mm = mean_chip * feed_mm;
    const auto c = estimation::cutting_coefficients(law, chip_mm);
    const Scalar F_t = c.K_s_N_per_mm2 * chip_mm + law.K_te_N_per_mm;
    const Scalar F_r = c.r_1 * c.K_s_N_per_mm2 * chip_mm + law.K_re_N_per_mm;
    return chip_mm > Scalar(0) && F_t > Scalar(0) ? law_is_off_by * sqrt(Scalar(1) + estimation::square(F_r / F_t))
                                                  : Scalar(0);
}

template <typename Scalar>
void EnteringCut<Scalar>::follow(const Estimate& e, control::CutState state) {
    const bool is_air = state == control::CutState::air;
    if (!(is_air || state == control::CutState::entry) || !(per_tangential_ > Scalar(0))) {
        forget();
        return;
    }
    periods_ += e.tooth_periods;
    if (periods_ < teeth_ || !e.tangential_N.valid) {
        return;
    }
    periods_ = 0;
    if (is_air) {
        follow_air(e);
    } else if (!is_same_move(e)) {
        begin(e);
    } else {
        follow_entry(e);
    }
}

/// Inertia is no force of a cut.
template <typename Scalar>
void EnteringCut<Scalar>::follow_air(const Estimate& e) {
    if (!e.tooth_change.feed_is_steady) {
        forget();
    }
    average(e);
    for (Axis& axis : axes_) {
        axis.least_up_N = axis.least_down_N = Scalar(0);
    }
    largest_N_ = Scalar(0);
    remember_move(e);
}

template <typename Scalar>
void EnteringCut<Scalar>::follow_entry(const Estimate& e) {
    constexpr Scalar surely2 = Scalar(9);  // three deviations, squared
    constexpr Scalar share = estimation::literal<Scalar>(0.9L);
    average(e);
    const Scalar noise = noise_left * e.tangential_N.noise;
    largest_N_ = tangential_N_ > largest_N_ ? tangential_N_ : largest_N_;
    const Scalar fallen_N = share * largest_N_ - tangential_N_;
    if (fallen_N > Scalar(0) && estimation::square(fallen_N) > surely2 * noise) {
        begin(e);
    } else {
        judge(axes_[0], e.x_N, noise);
        judge(axes_[1], e.y_N, noise);
    }
}

template <typename Scalar>
void EnteringCut<Scalar>::average(const Estimate& e) {
    tangential_N_ += newest_share * (e.tangential_N.value - tangential_N_);
    axes_[0].mean_N += newest_share * (e.x_N.value - axes_[0].mean_N);
    axes_[1].mean_N += newest_share * (e.y_N.value - axes_[1].mean_N);
}

template <typename Scalar>
void EnteringCut<Scalar>::remember_move(const Estimate& e) {
    has_force_ = {e.x_N.valid, e.y_N.valid};
    feed_x_mm_s_ = e.feed_x_mm_s;
    feed_y_mm_s_ = e.feed_y_mm_s;
}

/// Level and straight, and not slower than at the reference.
template <typename Scalar>
bool EnteringCut<Scalar>::is_same_move(const Estimate& e) const {
    using estimation::literal;
    using estimation::square;
    constexpr Scalar level_share = literal<Scalar>(0.05L);     // of the feed
    constexpr Scalar slower = literal<Scalar>(0.95L);          // of the feed
    constexpr Scalar sine_of_widest = literal<Scalar>(0.06L);  // 3.4 degrees
    const bool is_level = square(e.axial_speed_mm_s) < square(level_share * e.feed_mm_s);
    const bool has_same_axes = has_force_[0] == e.x_N.valid && has_force_[1] == e.y_N.valid;
    const Scalar before2 = square(feed_x_mm_s_) + square(feed_y_mm_s_);
    const Scalar along = e.feed_x_mm_s * feed_x_mm_s_ + e.feed_y_mm_s * feed_y_mm_s_;
    const Scalar across = e.feed_x_mm_s * feed_y_mm_s_ - e.feed_y_mm_s * feed_x_mm_s_;
    const Scalar most = sine_of_widest * before2;
    return is_level && has_same_axes && along > slower * before2 && across < most && -across < most;
}

/// From the present forces, or from those of air: all zero.
template <typename Scalar>
void EnteringCut<Scalar>::begin(const Estimate& e) {
    tangential_N_ = largest_N_ = e.tangential_N.value;
    const Scalar most_N = per_tangential_ * tangential_N_;
    const auto least = [most_N](Scalar force_N) { return force_N < most_N ? force_N - most_N : Scalar(0); };
    const auto from = [least](Scalar force_N) { return Axis{force_N, least(force_N), least(-force_N)}; };
    axes_ = {from(e.x_N.value), from(e.y_N.value)};
    remember_move(e);
}

template <typename Scalar>
void EnteringCut<Scalar>::forget() {
    axes_ = {};
    tangential_N_ = largest_N_ = Scalar(0);
    periods_ = 0;
}

template <typename Scalar>
void EnteringCut<Scalar>::judge(Axis& axis, const Force& force_N, Scalar tangential_noise) {
    using estimation::square;
    if (!force_N.valid) {
        return;
    }
    constexpr Scalar significant2 = Scalar(18);  // three deviations of a difference, squared
    const Scalar most_N = per_tangential_ * tangential_N_;
    const Scalar up_N = axis.mean_N - most_N;
    const Scalar down_N = -axis.mean_N - most_N;
    axis.least_up_N = up_N < axis.least_up_N ? up_N : axis.least_up_N;
    axis.least_down_N = down_N < axis.least_down_N ? down_N : axis.least_down_N;
    const Scalar rise_N = up_N - axis.least_up_N;
    const Scalar fall_N = down_N - axis.least_down_N;
    const Scalar larger_N = rise_N > fall_N ? rise_N : fall_N;
    const Scalar variance =
        force_N.variance - force_N.noise * (Scalar(1) - noise_left) + square(per_tangential_) * tangential_noise;
    contradicts_ = contradicts_ || square(larger_N) > significant2 * variance;
}

}  // namespace millforce::firmware
