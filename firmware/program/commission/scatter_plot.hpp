// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace millforce::host {

/// Measured points and a fitted line, as a picture in a page (SVG).
struct ScatterPlot {
    std::string title;
    std::string x_label;
    std::string y_label;
    std::vector<std::pair<double, double>> points;
    std::vector<std::pair<double, double>> line;  ///< may be empty
};

/// At least one point.
std::string plot_html(const ScatterPlot& plot);

}  // namespace millforce::host
