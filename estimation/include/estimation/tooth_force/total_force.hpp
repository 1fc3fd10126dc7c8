// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cut_estimate.hpp"
#include "estimation/cutting/peak_factors.hpp"

/// Peak and threshold of the total in-plane force, as an operator sees them:
///
///   F_peak = F_tooth g,    F_limit = F_tooth,max g,    g = κ/τ (peak_factors.hpp)
///
/// The controller compares F_tooth with F_tooth,max, which says the same. So neither belongs in the tick: whoever shows
/// them works them out of what the tick knows anyway.

namespace millforce::estimation {

/// What the peaks of an estimate were read at.
template <typename Scalar>
struct TotalForceInput {
    Scalar tooth_force_N{0};  ///< CutEstimate::worst_tooth_force_N
    Scalar radial_immersion{0};
    Scalar axial_depth_mm{0};
    CutSide side = CutSide::unknown;
};

template <typename Scalar>
[[nodiscard]] PeakFactorSettings<Scalar> peak_factor_settings(const CutEstimatorSettings<Scalar>& settings,
                                                              CutSide side) {
    PeakFactorSettings<Scalar> peak;
    peak.teeth = settings.teeth;
    peak.cutter_radius_mm = settings.cutter_radius_mm;
    peak.helix_rad = settings.helix_rad;
    peak.nominal_feed_per_tooth_mm = settings.nominal_feed_per_tooth_mm;
    peak.side = side;
    peak.centre_offset_in_radii = settings.centre_offset_in_radii;
    return peak;
}

template <typename Scalar>
class TotalForce {
  public:
    struct Forces {
        Scalar peak_N{0};
        Scalar limit_N{0};
    };

    TotalForce(const CutEstimatorSettings<Scalar>& settings, const CuttingLaw<Scalar>& law)
        : settings_(settings), law_(law) {}

    /// Cost: about 300 single-tooth forces. Not for the real-time path.
    [[nodiscard]] Forces of(const TotalForceInput<Scalar>& cut) const {
        const PeakFactors<Scalar> factors =
            peak_factors(law_, peak_factor_settings(settings_, cut.side), cut.radial_immersion, cut.axial_depth_mm);
        const Scalar g = factors.threshold_factor();
        return {cut.tooth_force_N * g, settings_.tooth_force_limit_N * g};
    }

  private:
    CutEstimatorSettings<Scalar> settings_;
    CuttingLaw<Scalar> law_;
};

}  // namespace millforce::estimation
