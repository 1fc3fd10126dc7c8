// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "reproduce/hwang_laws.hpp"
#include "reproduce/hwang_table.hpp"
#include "reproduce/hwang_thresholds.hpp"
#include "reproduce/reproduction.hpp"

/// Checks of our own about immersion from force drops: what the paper says nothing of.

namespace millforce::sim {

/// Errors over the table, answers, and whether the stated deviations hold.
void check_table(const std::vector<TableResult>& results, Reproduction& out);

/// The whole table again with other noise, drift and mounting of the cutter.
void check_other_seeds(const std::vector<TableRow>& rows, const HwangLaws& laws, Reproduction& out);

/// The table's rows with another force law and another runout: the method does not depend on those of the bench.
void check_other_plants(Reproduction& out);

/// The paper's equations (direction alone, e = 0) on the same samples, and ours with the edge taken out.
void check_edges(const std::vector<TableResult>& ours, const std::vector<TableResult>& without, Reproduction& out);

/// a, b and the edge lengths.
void check_laws(const HwangLaws& laws, Reproduction& out);

/// Row 17, the varying immersion.
void check_varying_part(const std::vector<ForceDropRun>& runs, Reproduction& out);

/// Down milling at all conditions but six inserts, where entry and exit of neighbours coincide.
void check_down_milling(const HwangLaws& laws, Reproduction& out);

/// Immersion from feed-drive currents in place of a dynamometer.
struct DriveResult {
    std::vector<TableCut> diagonal;  ///< 200 rpm, 3 inserts: row 10
    ForceDropTally inside{};
    ForceDropTally too_fast{};
    ForceDropTally along_x{};
};
[[nodiscard]] DriveResult mill_on_drives(const FittedForceDropLaw& law);
void check_drives(const DriveResult& drives, Reproduction& out);

void check_thresholds(const std::vector<ThresholdPoint>& points, Reproduction& out);

}  // namespace millforce::sim
