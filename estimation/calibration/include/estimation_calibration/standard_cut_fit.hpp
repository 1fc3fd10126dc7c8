// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/least_squares.hpp"

#include <cmath>
#include <span>

/// Gains of the spindle and of one feed drive from standard cuts: cuts whose forces are known from a database of
/// coefficients, with running in air between them (Kim & Chung, section 3.2).
///
///   T + k ω = K_t1 I + K_t2                              their Eq. 8 times the cutter radius
///   F_ax = K_x4 (I − I_g − κ I_f(w)) + K_x5/w            their Eq. 10; w in m/min, with its sign
///
/// Their Table 3 prints for K_x4 and K_x5 the two numbers of Eq. 8 once more; they cannot be the feed drive's. Both are
/// fitted here. K_x5/w is singular at rest: no stretch slower than the drive's velocity floor may be given.
///
/// What is noisy is the current; the forces are known. So the current is the left side of the fit,
///   I = (T + k ω)/K_t1 − K_t2/K_t1 + d · drift           drift: how cold the bearing still is, 0 when warm
///   I − I_g = κ I_f(w) + F_ax/K_x4 − (K_x5/K_x4)/w       in air F_ax = 0
/// and the standard errors of K_t1 = 1/a, K_t2 = −b/a and so on follow by first-order propagation. κ tells how the
/// friction stands today to that of the air cuts which I_f comes from: a nuisance here.
///
/// A relative error of the database is one of K_t1 and K_x4 alike; it is not in these standard errors.
/// Memory: two fits of three parameters. Cost: one pass. No heap, not thread-safe.

namespace millforce::estimation {

/// One stretch of steady feed and speed, in air or in a standard cut.
template <typename Scalar>
struct StandardCutStretch {
    Scalar spindle_current_A{0};
    Scalar torque_Nm{0};           ///< T + k ω: of the cut by the database, 0 in air, plus the idle slope's share
    Scalar drift{0};               ///< e^(−t/τ), or the share of the recording that is still to come
    Scalar feed_current_A{0};      ///< of the axis that feeds, without I_g
    Scalar friction_current_A{0};  ///< I_f(w) by the air cuts, with the sign of w
    Scalar feed_m_per_min{0};      ///< w, with its sign
    Scalar feed_force_N{0};        ///< F_ax by the database along the axis' + direction, 0 in air
    Scalar weight{1};              ///< 1/sd of the mean currents, up to a common factor: √duration
    bool in_cut = false;
};

/// What the stretches lack for a fit.
enum class StandardCutLack : unsigned char {
    nothing,
    cut,          ///< no standard cut at all
    air,          ///< no running in air: idle current and cutting current cannot be told apart
    second_load,  ///< all cuts load the drive alike
    second_feed,  ///< all cuts have the same feed: K_x5/w cannot be told from the other terms
    rows,         ///< no degree of freedom is left for a standard error
    response,     ///< the current does not follow the load beyond its noise
};

template <typename Scalar>
struct DriveGainFit {
    StandardCutLack lack = StandardCutLack::nothing;  ///< beside `nothing` the values are not to be used
    Scalar gain{0};                                   ///< K_t1 in N·m/A, or K_x4 in N/A
    Scalar gain_se{0};
    Scalar offset{0};  ///< K_t2 in N·m with the bearing warm, or K_x5 in N·m/min
    Scalar offset_se{0};
    Scalar nuisance{0};  ///< excess of the cold idle current in A, or κ
    Scalar nuisance_se{0};
    Scalar residual_A{0};  ///< standard deviation of the mean currents about the fit
    int rows{0};
};

struct StandardCutRules {
    /// Largest over smallest load (torque or force) of the cuts, and of their feeds.
    float least_load_ratio = 1.2F;
    float least_feed_ratio = 1.5F;
};

namespace detail {

/// gain = 1/a, offset = sign · b/a, of I = a load + b column + c third.
template <typename Scalar>
void fill_drive_gain(const LeastSquaresSolution<Scalar, 3>& s, int gain, int offset, int nuisance, Scalar sign,
                     DriveGainFit<Scalar>& fit) {
    using std::sqrt;
    const Scalar a = s.parameters(gain);
    const Scalar b = s.parameters(offset);
    const Scalar per_a = Scalar(1) / a;
    fit.rows = s.rows;
    fit.residual_A = s.residual_sd;
    fit.gain = per_a;
    fit.gain_se = per_a * per_a * s.standard_error(gain);
    fit.offset = sign * b * per_a;
    const Scalar ratio = b * per_a;
    fit.offset_se = per_a * sqrt(s.covariance(offset, offset) + ratio * ratio * s.covariance(gain, gain) -
                                 Scalar(2) * ratio * s.covariance(gain, offset));
    fit.nuisance = s.parameters(nuisance);
    fit.nuisance_se = s.standard_error(nuisance);
}

template <typename Scalar>
class Extent {
  public:
    void add(Scalar value) {
        const Scalar size = value < Scalar(0) ? -value : value;
        smallest_ = count_ == 0 || size < smallest_ ? size : smallest_;
        largest_ = size > largest_ ? size : largest_;
        ++count_;
    }
    [[nodiscard]] bool spans(float ratio) const { return largest_ > static_cast<Scalar>(ratio) * smallest_; }
    [[nodiscard]] int count() const { return count_; }

  private:
    Scalar smallest_{0};
    Scalar largest_{0};
    int count_ = 0;
};

template <typename Scalar>
StandardCutLack lack_of_fit(const LeastSquaresSolution<Scalar, 3>& s, int gain, int offset, int most_free) {
    if (s.rows < most_free + 1) {
        return StandardCutLack::rows;
    }
    const bool determined = s.determined(gain) && s.determined(offset);
    const bool follows = s.parameters(gain) > Scalar(3) * s.standard_error(gain);
    return determined && follows ? StandardCutLack::nothing : StandardCutLack::response;
}

}  // namespace detail

/// K_t1 (gain) and K_t2 (offset) of the spindle. Without a drift in the stretches d stays 0.
template <typename Scalar>
DriveGainFit<Scalar> fit_spindle_gain(std::span<const StandardCutStretch<Scalar>> stretches,
                                      const StandardCutRules& rules = {}) {
    constexpr int by_torque = 0;
    constexpr int constant = 1;
    constexpr int cold = 2;
    LeastSquares<Scalar, 3> fit;
    detail::Extent<Scalar> loads;
    bool drifts = false;
    for (const auto& s : stretches) {
        if (s.in_cut) {
            loads.add(s.torque_Nm);
        }
        drifts = drifts || s.drift != stretches.front().drift;
        fit.add({s.torque_Nm, Scalar(1), s.drift}, s.spindle_current_A, s.weight);
    }
    if (!drifts) {
        fit.add_prior(cold, Scalar(0), Scalar(1e3F));
    }
    DriveGainFit<Scalar> result;
    const auto solution = fit.solve();
    const int in_air = fit.rows() - loads.count();
    result.lack = loads.count() == 0 ? StandardCutLack::cut
                  : in_air == 0      ? StandardCutLack::air
                  : !loads.spans(rules.least_load_ratio)
                      ? StandardCutLack::second_load
                      : detail::lack_of_fit(solution, by_torque, constant, drifts ? 3 : 2);
    if (result.lack == StandardCutLack::nothing) {
        detail::fill_drive_gain(solution, by_torque, constant, cold, Scalar(-1), result);
    }
    return result;
}

/// K_x4 (gain) and K_x5 (offset) of the axis that feeds.
template <typename Scalar>
DriveGainFit<Scalar> fit_feed_gain(std::span<const StandardCutStretch<Scalar>> stretches,
                                   const StandardCutRules& rules = {}) {
    constexpr int friction = 0;
    constexpr int by_force = 1;
    constexpr int by_slowness = 2;
    LeastSquares<Scalar, 3> fit;
    detail::Extent<Scalar> loads;
    detail::Extent<Scalar> feeds;
    for (const auto& s : stretches) {
        if (s.in_cut) {
            loads.add(s.feed_force_N);
            feeds.add(s.feed_m_per_min);
        }
        fit.add({s.friction_current_A, s.feed_force_N, Scalar(-1) / s.feed_m_per_min}, s.feed_current_A, s.weight);
    }
    DriveGainFit<Scalar> result;
    const auto solution = fit.solve();
    const int in_air = fit.rows() - loads.count();
    result.lack = loads.count() == 0                     ? StandardCutLack::cut
                  : in_air == 0                          ? StandardCutLack::air
                  : !feeds.spans(rules.least_feed_ratio) ? StandardCutLack::second_feed
                  : !loads.spans(rules.least_load_ratio) ? StandardCutLack::second_load
                                                         : detail::lack_of_fit(solution, by_force, by_slowness, 3);
    if (result.lack == StandardCutLack::nothing) {
        detail::fill_drive_gain(solution, by_force, by_slowness, friction, Scalar(1), result);
    }
    return result;
}

}  // namespace millforce::estimation
