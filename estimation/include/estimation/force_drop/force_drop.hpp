// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/force_drop/force_drop_detector.hpp"
#include "estimation/force_drop/force_drop_immersion.hpp"
#include "estimation/number/fixed_point.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/signal/revolution_profile.hpp"

#include <array>
#include <cstddef>

/// Radial immersion in process from the force drops of a face mill (Hwang, Oh, Kwon and Chu, "In-process estimation of
/// radial immersion ratio in face milling using cutting force"): samples of two forces in, an immersion with its
/// standard deviation or "no estimate" out, once per `revolutions` of the spindle.
///
/// Forces on the workpiece in the feed frame (x along the feed, y its normal), from a force sensor, or from feed drives
/// where the tooth-passing rate is inside the drives' bandwidth. Neither the hardness of the material nor the depth of
/// cut is needed; the feed per tooth is, for the edge force is a share that depends on it (force_drop_law.hpp).
///
/// The chain: RevolutionProfile (angle-synchronous mean) → ForceDropDetector (the jump, free of the low-pass) →
/// ForceDropImmersion (the two equations). Between two teeth, where none is in cut, the sensor's zero is read and taken
/// off the averages (AirGap). Where the other edge of the cut falls into the window of the jump, its share is worked
/// out for each immersion that is tried and taken off the signal; the solution is the immersion that reproduces itself
/// and leaves the least of the signal unexplained.
///
/// Where this differs from print:
///  - Eq. 6 by the two-argument arctangent: tan⁻¹ fails past 90°.
///  - Eqs. 6, 11, 12 are closed by bracketing, not by iteration: a ≥ 1 needs no proof then (Eqs. 13, 14; 14 is lost).
///  - Edge forces are part of the law; the paper names them as the cause of its largest error, at immersion 0.2.
///  - The size of the drop relative to the average force is used as well as its direction.
///  - Down milling: the jump is a rise where the tooth enters, φ_st = π − θ; the averages run from φ_st to π.
///  - Table 1 prints mm/min for a feed per tooth: read mm. The nomenclature's r is F_R/F_T (Eq. 2), not its inverse.
///
/// Memory (float, 512 bins): 4.2 KB. Cost per sample: some 20 operations; per estimate 2 · Bins · window + 52 × teeth
/// × window × 60 operations, about 0.5 million at 3 teeth; some 4 million where the other edge acts on the window.
/// Not thread-safe. Bodies: force_drop_impl.hpp.

namespace millforce::estimation {

template <typename Scalar>
struct ForceDropSettings {
    ForceDropDetectorSettings<Scalar> detector{};
    ForceDropImmersionSettings<Scalar> immersion{};
    int revolutions{0};               ///< per estimate: more takes noise off and follows a changing cut later
    CutSide side = CutSide::unknown;  ///< unknown: a drop along the mean force is up milling, a rise down milling
    Scalar known_immersion{0};        ///< immersion of a calibration cut; 0: unknown, to be estimated
    Scalar zero_drift_sd_N{0};        ///< drift of the forces' zero since the last air cut; an air gap takes it off
    Scalar mean_force_sd_N{0};  ///< deviation of the mean forces by what no air gap shows: a drive's friction in cut
};

template <typename Scalar>
struct ForceDropSample {
    Scalar spindle_angle_rev{0};  ///< 0…1
    Scalar dt_s{0};               ///< since the last sample
    Scalar fx_N{0};
    Scalar fy_N{0};
};

template <typename Scalar, int Bins = 512>
class ForceDrop {
  public:
    using Estimate = ForceDropEstimate<Scalar>;

    explicit ForceDrop(const ForceDropLaw<Scalar>& law = {}, const ForceDropSettings<Scalar>& settings = {});

    void restart();

    /// Returns true when an estimate was made: read estimate(). `feed_per_tooth_mm` as commanded or measured.
    bool add(const ForceDropSample<Scalar>& sample, Scalar feed_per_tooth_mm);

    /// add() in two steps: collect() for the sampling loop, evaluate() for a slower task. When collect() says that the
    /// revolutions are complete, samples are dropped until evaluate() has taken them.
    bool collect(const ForceDropSample<Scalar>& sample);
    [[nodiscard]] bool complete() const { return complete_; }
    const Estimate& evaluate(Scalar feed_per_tooth_mm);

    [[nodiscard]] const Estimate& estimate() const { return estimate_; }
    /// What the last estimate was made of: for calibration, and to be shown.
    [[nodiscard]] const ForceDropMeasurement<Scalar>& measurement() const { return measurement_; }
    [[nodiscard]] const ForceJump<Scalar>& jump() const { return jump_; }

  private:
    struct Closure;
    void estimate_profile(Scalar feed_per_tooth_mm);
    [[nodiscard]] Scalar largest_theta_rad() const;
    void estimate_from(const ForceJump<Scalar>& jump, Scalar feed_per_tooth_mm, Scalar theta_rad);
    [[nodiscard]] bool other_edge_acts_between(Scalar low_rad, Scalar high_rad) const;
    static constexpr std::size_t closing_nodes = 15;
    static constexpr std::size_t closing_halvings = 2;
    using Closures = std::array<Closure, closing_nodes + 2 * closing_halvings>;

    static constexpr Scalar place_sd_rad = literal<Scalar>(0.03L);
    /// How far off the first θ may be, with the other edge still in the drop: it is searched for within this share of θ
    /// to either side. The closing nodes are then about place_sd_rad apart at a θ of 1 rad.
    static constexpr Scalar first_share_in_doubt = literal<Scalar>(0.2L);

    Closure close_at(Scalar theta_rad, Scalar feed_per_tooth_mm, const ForceJump<Scalar>& first);
    [[nodiscard]] static Scalar misfit(const Closure& closure, Scalar least_residual_N2);
    void close_other_edge(Scalar first_rad, Scalar reach_rad, Scalar feed_per_tooth_mm);
    [[nodiscard]] static Scalar least_residual_N2(const Closures& tried);
    [[nodiscard]] static std::size_t best_of(const Closures& tried);
    [[nodiscard]] bool is_ambiguous(const Closures& tried, const Closure& best) const;
    void join_place(const Closure& best, bool ambiguous);
    void measure_known(Scalar feed_per_tooth_mm);
    [[nodiscard]] static Scalar other_edge_behind_rev(CutSide side, Scalar theta_rad);
    void take_zero_off(const ForceJump<Scalar>& jump, Scalar theta_rad);
    [[nodiscard]] ForceDropMeasurement<Scalar> measurement_of(const ForceJump<Scalar>& jump,
                                                              Scalar feed_per_tooth_mm) const;
    [[nodiscard]] OtherEdge<Scalar> other_edge(Scalar theta_rad, Scalar feed_per_tooth_mm) const;

    ForceDropSettings<Scalar> settings_;
    RevolutionProfile<Scalar, Bins> profile_;
    ForceDropDetector<Scalar, Bins> detector_;
    ForceDropImmersion<Scalar> immersion_;
    ForceDropMeasurement<Scalar> measurement_{};
    ForceJump<Scalar> jump_{};
    Estimate estimate_{};
    bool complete_ = false;
};

extern template class ForceDrop<float>;
extern template class ForceDrop<Fixed>;

}  // namespace millforce::estimation
