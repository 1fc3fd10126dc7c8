// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "reproduce/hwang_laws.hpp"
#include "reproduce/hwang_thresholds.hpp"
#include "reproduce/reproduction.hpp"

/// Hwang, Oh, Kwon and Chu's figures, redrawn from our data.

namespace millforce::sim {

/// Figs. 4 and 5: the forces of one revolution, one insert and two inserts in cut.
void add_signal_plots(std::uint64_t seed, Reproduction& out);

/// Fig. 7: r over r_av, our line and the paper's slope.
void add_slope_plot(const HwangLaws& laws, Reproduction& out);

/// Figs. 9–14: one plot per group of rows of Table 1.
void add_table_plots(const std::vector<TableRow>& rows, const std::vector<TableResult>& results, Reproduction& out);

/// Fig. 15
void add_varying_plot(const std::vector<ForceDropRun>& runs, Reproduction& out);

/// The direction's equations with the edge force taken out, and left in.
void add_edge_plot(const std::vector<TableResult>& ours, const std::vector<TableResult>& without, Reproduction& out);

/// From feed-drive currents.
void add_drive_plot(const std::vector<TableCut>& cuts, Reproduction& out);

void add_threshold_plot(const std::vector<ThresholdPoint>& points, Reproduction& out);

}  // namespace millforce::sim
