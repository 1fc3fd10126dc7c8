// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cut_estimate.hpp"
#include "estimation/tooth_force/engagement_peaks.hpp"

namespace millforce::estimation {

/// The peak force of one tooth from the mean tangential force, with its deviation or its bound; what it would be at
/// another immersion; and how it grows.
///
///   F_tooth = F_at τ [1 − c + c (1 + e/(f_z sin φ))^(1+p_s)]     τ: engagement_peaks.hpp, c: cutting share
///
/// e: runout (runout_meter.hpp), φ: where the mean chip is thickest; 90° where the arc is not known.
///
/// Cost: three exponentials and two logarithms. Not thread-safe. Bodies: tooth_force_impl.hpp.
template <typename Scalar>
class ToothForce {
  public:
    using Table = typename EngagementSolver<Scalar>::Table;

    ToothForce() = default;
    ToothForce(const CutEstimatorSettings<Scalar>& settings, const CuttingLaw<Scalar>& law);

    /// Fills in what F_at, feed and engagement of `e` say about one tooth. The peaks are those at the immersion that is
    /// known, else at the last one, else at the assumed one.
    /// `runout_mm`: runout_meter.hpp.
    void fill(CutEstimate<Scalar>& e, const EngagementPeaks<Scalar>& peaks, const Table& table, Scalar runout_mm);

    /// m of F ∝ f^m at the last engagement.
    [[nodiscard]] Scalar force_exponent() const { return force_exponent_; }

  private:
    using Factors = typename EngagementPeaks<Scalar>::Factors;

    Scalar follow_growth(CutEstimate<Scalar>& e) const;
    void estimate_tooth_force(CutEstimate<Scalar>& e, const Factors& factors, Scalar newest_N) const;
    [[nodiscard]] Scalar runout_factor(const CutEstimate<Scalar>& e) const;
    [[nodiscard]] static typename CutEstimate<Scalar>::Change change_to(const typename Table::Forces& forces_then,
                                                                        Scalar factor, Scalar tooth_N_per_mm_now);

    Scalar teeth_{4};
    Scalar cutter_radius_mm_{5};
    Scalar feed_exponent_{usual_feed_exponent<Scalar>};
    bool load_is_held_ = false;
    Scalar force_exponent_{usual_feed_exponent<Scalar>};
};

}  // namespace millforce::estimation
