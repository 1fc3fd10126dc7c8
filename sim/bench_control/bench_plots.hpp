// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench_control/bench_table.hpp"

namespace millforce::sim {

/// A plot as an SVG document of its own: no script, no font, colours that stand on light and on dark pages.
struct BenchPlot {
    std::string file_name;  ///< e.g. "time_over_bound.svg"
    std::string title;
    std::string svg;
};

/// Three: the time over the bound by controller, the peaks by controller, and the median time by part of ours, of the
/// constant feed and of the fastest rival.
[[nodiscard]] std::vector<BenchPlot> bench_plots(const std::vector<ContenderFigures>& contenders,
                                                 const std::vector<PartFigures>& parts);

}  // namespace millforce::sim
