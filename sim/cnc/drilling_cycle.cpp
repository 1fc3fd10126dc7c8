// SPDX-License-Identifier: Apache-2.0
#include "cnc/drilling_cycle.hpp"

#include <algorithm>

namespace millforce::sim {

std::vector<DrillingCycle::Step> DrillingCycle::steps() const {
    constexpr double lift_mm = 0.25;  // as RS-274 interpreters have it
    constexpr double most_pecks = 1000.0;
    const double way_mm = retract_mm - bottom_mm;
    const bool pecks = (code == 73 || code == 83) && peck_mm > 0.0;
    const double peck = pecks ? std::max(peck_mm, way_mm / most_pecks) : way_mm;
    std::vector<Step> steps;
    double z_mm = retract_mm;
    while (z_mm > bottom_mm) {
        const double next_mm = std::max(bottom_mm, z_mm - peck);
        steps.push_back({MoveKind::feed_line, next_mm});
        z_mm = next_mm;
        if (z_mm > bottom_mm && code == 83) {
            steps.push_back({MoveKind::rapid, retract_mm});
            steps.push_back({MoveKind::rapid, std::min(retract_mm, z_mm + lift_mm)});
        } else if (z_mm > bottom_mm) {
            steps.push_back({MoveKind::rapid, std::min(retract_mm, z_mm + lift_mm)});
        }
    }
    if (code == 82 && dwell_s > 0.0) {
        steps.push_back({MoveKind::dwell, bottom_mm, dwell_s});
    }
    steps.push_back({MoveKind::rapid, clear_mm});
    return steps;
}

}  // namespace millforce::sim
