// SPDX-License-Identifier: Apache-2.0
#include "calibration/conditions.hpp"

#include <fmt/format.h>

#include <cmath>

#include "estimation/number/circle.hpp"

namespace millforce::host {

double CutRow::feed_per_tooth_mm() const {
    return feed_mm_s * estimation::turn_rad<double> / (flutes * spindle_rad_s);
}

estimation::EngagementAngles<double> CutRow::engagement(estimation::CutSide side, double width_mm) const {
    return estimation::engagement_angles(side, width_mm / radius_mm());
}

estimation::CuttingMeasurement CutRow::measurement(estimation::CutSide side) const {
    estimation::CuttingMeasurement result;
    result.cut = {feed_per_tooth_mm(), axial_depth_mm, engagement(side, radial_width_mm), flutes};
    result.tangential_N = spindle_torque_Nm * 1000.0 / radius_mm();
    result.feed_N = feed_force_N;
    result.normal_N = -normal_force_N;
    return result;
}

ConditionsReader::ConditionsReader(const std::filesystem::path& file)
    : csv_(file),
      diameter_(csv_.require("tool_diameter_mm")),
      flutes_(csv_.require("flutes")),
      spindle_(csv_.require("spindle_rad_s")),
      feed_(csv_.require("feed_mm_s")),
      depth_(csv_.find("axial_depth_mm")),
      width_(csv_.find("radial_width_mm")),
      torque_(csv_.find("spindle_torque_Nm")),
      normal_(csv_.find("normal_force_N")),
      feed_force_(csv_.find("feed_force_N")) {}

bool ConditionsReader::next(CutRow& row) {
    if (!csv_.next_row()) {
        return false;
    }
    row.tool_diameter_mm = csv_.required_number(diameter_, 0.01, 1000.0);
    row.flutes = csv_.required_number(flutes_, 1.0, 100.0);
    if (row.flutes != std::floor(row.flutes)) {
        csv_.fail(flutes_, fmt::format("{} is not whole; expected a number of flutes", row.flutes));
    }
    row.spindle_rad_s = csv_.required_number(spindle_, 0.1, 1e6);
    row.feed_mm_s = csv_.required_number(feed_, 1e-4, 1e4);
    const auto optional = [&](std::optional<CsvColumn> column, double low, double high) {
        const double value = csv_.number(column);
        return std::isnan(value) ? value : csv_.required_number(*column, low, high);
    };
    constexpr double smallest_mm = 1e-6;
    row.axial_depth_mm = optional(depth_, smallest_mm, 1000.0);
    row.radial_width_mm = optional(width_, smallest_mm, row.tool_diameter_mm);
    row.spindle_torque_Nm = optional(torque_, -1e6, 1e6);
    row.normal_force_N = optional(normal_, -1e7, 1e7);
    row.feed_force_N = optional(feed_force_, -1e7, 1e7);
    return true;
}

}  // namespace millforce::host
