// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "estimation/depth_shape/cut_category.hpp"

/// Eqs. 4 and 10–12 of Yang, DeVor & Kapoor: steps on the way to others, which no estimator needs.

namespace millforce::sim::yang {

using Mill = estimation::FluteGeometry<double>;
using Depths = estimation::DepthsOfCut<double>;

/// Eq. 4, with β = α_en + α_sw: the largest number of flutes in cut at once.
inline int flutes_in_cut(const estimation::FluteAngles<double>& angles) {
    return static_cast<int>(std::ceil((angles.engagement_rad + angles.sweep_rad) / angles.pitch_rad));
}

/// Eq. 10: change of α_sw with a relative change of the axial depth.
inline double sweep_change_rad(const Mill& mill, const Depths& nominal, double axial_variation) {
    return axial_variation * nominal.axial_mm / mill.cutter_radius_mm * std::tan(mill.helix_rad);
}

/// Eq. 11: change of α_en with a relative change of the radial depth.
inline double engagement_change_rad(const Mill& mill, const Depths& nominal, double radial_variation) {
    const double immersion = nominal.radial_mm / mill.cutter_radius_mm;
    return std::acos(1.0 - immersion * (1.0 + radial_variation)) - std::acos(1.0 - immersion);
}

/// Eq. 12: the same to first order.
inline double small_engagement_change_rad(const Mill& mill, const Depths& nominal, double radial_variation) {
    const double immersion = nominal.radial_mm / mill.cutter_radius_mm;
    return radial_variation * immersion / std::sqrt(2.0 * immersion - immersion * immersion);
}

}  // namespace millforce::sim::yang
