// SPDX-License-Identifier: Apache-2.0
#include "estimation/cutting/cutting_law.hpp"

namespace millforce::estimation {

template struct CuttingLaw<float>;
template CuttingLaw<float> linear_edge_law(float, float, float, float);
template EngagementIntegrals<float> engagement_integrals(EngagementAngles<float>);
template float mean_chip_thickness_mm(float, EngagementAngles<float>);
template CuttingCoefficients<float> cutting_coefficients(const CuttingLaw<float>&, float);
template AverageForcesWithDoubt<float> average_forces_with_doubt(const CuttingLaw<float>&, const CutConditions<float>&);
template AverageForces<float> average_forces(const CuttingLaw<float>&, const CutConditions<float>&);

}  // namespace millforce::estimation
