// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reproduce/kim_campaign.hpp"
#include "reproduce/reproduction.hpp"

#include <vector>

/// Checks of our own about Kim & Chung: the equations against the plant's integration and against values calculated
/// outside of the program, and what the three steps find on simulated machines that the paper does not print.

namespace millforce::sim {

/// The plant's mean forces of a down-milling cut at the standard depth, from edge elements.
[[nodiscard]] estimation::AverageForces<double> kim_forces_by_integration(const AverageChipLaw& law,
                                                                          double radial_immersion,
                                                                          double feed_per_tooth_mm);

/// Over all machines: errors, and how many lie within two standard errors.
struct KimTally {
    double largest = 0.0;  ///< relative
    int within = 0;

    void add(double error, double standard_error, double truth);
};

void check_kim_equations(Reproduction& out);
void check_kim_gains(const std::vector<KimCampaign>& campaigns, Reproduction& out);

/// Immersion and depth of new cuts, by the coefficients and gains that the machine found itself.
void check_kim_engagement(const std::vector<KimCampaign>& campaigns, const std::vector<KimUnknownTool>& tools_found,
                          const AverageChipLaw& law, Reproduction& out);

}  // namespace millforce::sim
