// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of ToothPeakTable. Included by src/peak_table.cpp, and wherever another scalar is needed.

#include "estimation/cutting/peak_factors.hpp"

namespace millforce::estimation {

template <typename Scalar, int ImmersionNodes, int SweepNodes>
void ToothPeakTable<Scalar, ImmersionNodes, SweepNodes>::build(const CuttingLaw<Scalar>& law,
                                                               const PeakFactorSettings<Scalar>& settings) {
    using elementary::tan;
    sweep_rad_per_mm_ = tan(settings.helix_rad) / settings.cutter_radius_mm;
    side_ = settings.side;
    centre_offset_in_radii_ = settings.centre_offset_in_radii;
    for (int i = 0; i < ImmersionNodes; ++i) {
        const Scalar immersion = immersion_of(Scalar(i));
        const Scalar engagement_rad = engagement_at(immersion);
        for (int k = 0; k < SweepNodes; ++k) {
            const Scalar sweeps = sweeps_of(Scalar(k));
            const Scalar depth =
                sweep_rad_per_mm_ > Scalar(0) ? sweeps * engagement_rad / sweep_rad_per_mm_ : Scalar(1);
            const Scalar scaled = tooth_peak_factor(law, settings, immersion, depth) * scale_at(immersion, sweeps);
            nodes_[index(i)][index(k)] = static_cast<Stored<Scalar>>(scaled);
        }
    }
}

template <typename Scalar, int ImmersionNodes, int SweepNodes>
Scalar ToothPeakTable<Scalar, ImmersionNodes, SweepNodes>::at_angle(Scalar theta_rad, Scalar radial_immersion,
                                                                    Scalar axial_depth_mm) const {
    const Scalar immersion = clamp(radial_immersion, least_immersion, Scalar(2));
    const Scalar theta = clamp(theta_rad, first_rad, pi<Scalar>);
    const Scalar engagement_rad = side_ == CutSide::centred ? engagement_at(immersion) : theta;
    const Scalar sweeps = axial_depth_mm * sweep_rad_per_mm_ / engagement_rad;
    const Place across = place((theta - first_rad) * steps_per_rad, ImmersionNodes);
    const Place along = place(node_of(sweeps), SweepNodes);
    const auto between = [&](std::size_t k) {
        const Scalar low(nodes_[across.node][k]);
        return low + (Scalar(nodes_[across.node + 1][k]) - low) * across.share;
    };
    const Scalar first = between(along.node);
    return (first + (between(along.node + 1) - first) * along.share) / scale_at(immersion, sweeps);
}

}  // namespace millforce::estimation
