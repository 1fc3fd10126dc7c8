// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reproduce/kim_campaign.hpp"
#include "reproduce/reproduction.hpp"

#include <string>

/// Kim & Chung's figures, redrawn in kind.

namespace millforce::sim {

struct KimDrawn {
    std::string name;
    std::string figure;  ///< "Fig. 3"
    AverageChipLaw law;
};

struct KimPressureLaw {
    double k_s = 0.0;
    double p_s = 0.0;
};

/// Figs. 3 and 7: K_s and r_1 over the mean chip thickness, published and from currents.
void add_coefficient_plot(const KimDrawn& drawn, const KimUnknownTool& tool, Reproduction& result);

/// Figs. 5 and 6, and the spindle's counterpart.
void add_drive_plots(const KimCampaign& campaign, Reproduction& result);

/// Fig. 8: K_s by forces, by the paper's currents and by ours.
void add_comparison_plot(const KimDrawn& drawn, const KimPressureLaw& by_published_currents, const KimUnknownTool& tool,
                         Reproduction& result);

}  // namespace millforce::sim
