// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "reproduce/hwang_thresholds.hpp"
#include "reproduce/reproduction.hpp"

/// Hwang, Oh, Kwon and Chu's figures, redrawn from our data.

namespace millforce::sim {

/// Fig. 4: the forces of one revolution.
void add_signal_plot(std::uint64_t seed, Reproduction& out);

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
