// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstdint>

#include "estimation/cut_estimate.hpp"
#include "estimation/number/literal.hpp"

namespace millforce::firmware {

/// The radial immersion is known well enough to stand for the cut's width.
template <typename Scalar>
[[nodiscard]] bool is_width_known(const estimation::EngagementEstimate<Scalar>& engagement) {
    constexpr Scalar well_known_sd = estimation::literal<Scalar>(0.2L);
    return engagement.immersion_valid && engagement.radial_immersion_sd < well_known_sd;
}

/// The tooth force of a cut that seems to change slowly in width and depth at once.
///
/// A current that drifts within one cut looks like such a change: a smaller spindle current like a narrower and deeper
/// cut, a smaller axis current like a wider and shallower one, and by either the force on a tooth seems to fall. No
/// third signal tells a drift from a cut that really changes so. Both are thought possible, and the largest force
/// counts:
///
///   F_tooth = max(F_tooth by the present immersion, F_at (F_tooth/F_at)₀, F_ax (F_tooth/F_ax)₀)
///
/// F_at is the force by the spindle's current, F_ax the one along the feed by the axes' currents: a drift of one leaves
/// the other. ₀: 16 estimates after the cut had begun, or after both forces had changed by a quarter at once beyond
/// what the feed explains, which no drift of one current does. The cut has changed in width and depth where the mean of
/// 16 estimates has moved from ₀ by more than the immersion's standard deviation, and by more than 15 % of the depth
/// and its deviation by the forces.
///
/// A wall that converges changes the width alone, a ramp the depth alone. A ramp is believed. A wall need not be one: a
/// drift of F_ax may hide that the depth changes. Where the present immersion makes F_tooth a sixth smaller than ₀
/// does, that is a question (has_question), which a dip of the feed can answer (feed_dip.hpp). What changes faster than
/// a current can drift is none:
///
///   m = mean of F_ax − F_at (F_ax/F_at)₀,    H = H + clamp(m − H, ±d T)    d: drift of an axis, T: time of an estimate
///
/// A cut in which m and H are apart by a quarter of F_at has changed, and begins anew.
///
/// Doubt outlasts the cut, until re-zeroing in air finds the currents as they should be.
///
/// Not seen: a drift of a machine that knows no force along the feed, and one before ₀. Where the width is not known,
/// or is no longer: lone_fall.hpp.
///
/// Cost: some 60 operations, three divisions an estimate. No heap. One thread.
template <typename Scalar>
class SteadyCut {
  public:
    /// `drift_N_per_s`: as fast as an axis' current can drift, as a force; 0: not known, any change may be a drift.
    explicit SteadyCut(Scalar drift_N_per_s) : drift_N_per_s_(drift_N_per_s) {}

    /// The tool is out of the cut: what was known says nothing of the next one, unless a current may have drifted.
    void leave_cut() { estimates_ = is_doubtful_ ? estimates_ : std::uint8_t{0}; }
    /// Re-zeroing in air has found the currents to be as they should.
    void clear() { *this = SteadyCut(drift_N_per_s_); }

    /// A new estimate in a cut that neither begins nor ends. `per_root_feed`: 1/√f, since a force grows with the feed
    /// by a power between 0, of edge force alone, and 0.8, by 1/2 roughly; 0 without a feed. `period_s`: of a tooth.
    void follow(const estimation::CutEstimate<Scalar>& e, Scalar per_root_feed, Scalar period_s);

    [[nodiscard]] bool is_doubtful() const { return is_doubtful_; }
    /// The last estimate was the first of another cut.
    [[nodiscard]] bool begins() const { return estimates_ == 1; }
    /// ₀ is known.
    [[nodiscard]] bool has_settled() const { return estimates_ == settled; }
    /// The width alone has moved, so that the present force is much smaller than that of ₀.
    [[nodiscard]] bool has_question() const { return has_question_; }
    /// Its answer. `is_sound`: no current has drifted, and the cut is what it seems to be. Else the width is doubted as
    /// long as it is another than ₀.
    void take_answer(bool is_sound) {
        estimates_ = is_sound ? std::uint8_t{0} : estimates_;
        is_doubtful_ = is_doubtful_ && !is_sound;
        is_refuted_ = !is_sound;
        has_question_ = false;
    }

    /// The tooth force that the new estimate leaves possible, not below `tooth_force_N`.
    [[nodiscard]] Scalar largest_force_N(const estimation::CutEstimate<Scalar>& e, Scalar tooth_force_N) const;

  private:
    enum Quantity { spindle, axes, immersion, depth, quantities };
    using Cut = Eigen::Matrix<Scalar, quantities, 1, Eigen::DontAlign>;

    [[nodiscard]] bool is_step(const Cut& cut) const;
    void begin(const estimation::CutEstimate<Scalar>& e);
    void judge(const estimation::CutEstimate<Scalar>& e);
    [[nodiscard]] bool is_faster_than_a_drift(const estimation::CutEstimate<Scalar>& e, Scalar period_s);
    [[nodiscard]] bool has_width_moved(const estimation::EngagementEstimate<Scalar>& engagement) const;
    [[nodiscard]] bool has_depth_moved(const estimation::EngagementEstimate<Scalar>& engagement) const;

    static constexpr std::uint8_t settled = 16;  // estimates that the mean is of

    Scalar drift_N_per_s_;
    std::uint8_t estimates_ = 0;  // since the last step, up to `settled`
    bool is_doubtful_ = false;
    bool has_question_ = false;
    bool is_refuted_ = false;  // the width, by an answer
    Cut mean_ = Cut::Zero();
    Scalar first_immersion_{0};  // when the mean had settled
    Scalar first_depth_mm_{0};
    Scalar tooth_per_tangential_{0};
    Scalar tooth_per_feed_force_{0};  // 0: the feed force is too small to tell
    Scalar feed_per_tangential_{0};
    Scalar missing_N_{0};  // m
    Scalar drift_N_{0};    // H
};

}  // namespace millforce::firmware
