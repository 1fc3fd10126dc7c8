// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "estimation/cutting/cutting_law.hpp"

namespace millforce::host {

/// What the largest force on a tooth is worked out from.
struct ToothForceQuestion {
    double diameter_mm = 0.0;
    int teeth = 0;
    double overhang_mm = 0.0;                ///< from the holder to the tip
    double deepest_cut_mm = 0.0;             ///< axial depth
    double strength_N_per_mm2 = 0.0;         ///< transverse rupture strength of carbide; of HSS the yield strength
    double largest_feed_per_tooth_mm = 0.0;  ///< the maker's, for a slot 0.5 D deep
    estimation::CuttingLaw<double> law{};
};

struct ToothForceAdvice {
    double bending_N = 0.0;            ///< what the core withstands
    double makers_feed_N = 0.0;        ///< what the tool meets at the maker's feed
    double advised_N = 0.0;            ///< two thirds of the smaller of the two: for a worn edge, and to begin with
    std::vector<std::string> reasons;  ///< lines for the user, each with its source
};

/// Strengths to begin with, N/mm². Carbide: transverse rupture strength of a fine-grained grade, as ISO 3327 measures
/// it. HSS: compressive yield strength of M2 by AZoM's data sheet. The maker's own is better.
inline constexpr double carbide_strength_N_per_mm2 = 3500.0;
inline constexpr double hss_strength_N_per_mm2 = 3250.0;

/// F_tooth,max from the tool's data: sim/scenarios/tools/README.md.
///
///  - bending of the core as a cantilever: σ = 32 F_total l / (π d_c³) ≤ strength/3, d_c = 0.65 D, l = overhang −
///  a_p/2;
///    F_tooth = F_total / (1.2 max(1, teeth/4)), the ratio of both in a slot
///  - the maker's feed: F = √((K_s h)² + (r_1 K_s h)²) a_p in a slot 0.5 D deep at h = the largest feed per tooth
///
/// All lengths are positive, the overhang longer than half the depth.
ToothForceAdvice advise_tooth_force(const ToothForceQuestion& question);

/// Force on one tooth without helix: √(1 + r_1²) K_s h a_p, in N.
double straight_tooth_force_N(const estimation::CuttingLaw<double>& law, double chip_mm, double depth_mm);

/// The feed per tooth at which a slot of this depth loads a tooth to `force_N`: the ceiling for entering what is not
/// known yet. At most `largest_mm`.
double feed_for_tooth_force_mm(const estimation::CuttingLaw<double>& law, double force_N, double depth_mm,
                               double largest_mm);

/// Of a tool in a collet, where nobody has measured it.
inline constexpr double usual_runout_mm = 0.005;

/// K_s of a batch or with a worn edge, over what is known of the material.
inline constexpr double hardest_batch = 1.3;

/// The feed per tooth at which the tool may enter what is not known yet: in a slot of the deepest cut, in the hardest
/// batch, the tooth that stands out carries the limit. Its chip is r sin(π/z) thicker, r the runout, the largest
/// difference between the radii of two teeth. At least a third of the feed without runout.
double entry_feed_per_tooth_mm(const ToothForceQuestion& question, double limit_N, double runout_mm = usual_runout_mm);

}  // namespace millforce::host
