// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "cnc/move.hpp"

namespace millforce::sim {

/// What a canned cycle does at one hole, as plunges. G81: to the bottom. G82: with a dwell there. G73: in pecks, lifted
/// a little after each. G83: in pecks, lifted to R after each.
struct DrillingCycle {
    int code = 81;
    double bottom_mm = 0.0;
    double retract_mm = 0.0;  ///< R, where the feed begins
    double peck_mm = 0.0;     ///< Q; 0: none
    double dwell_s = 0.0;     ///< P of G82
    double clear_mm = 0.0;  ///< where the tool goes in the end: R (G99) or the height before the cycle, if higher (G98)

    struct Step {
        MoveKind kind = MoveKind::rapid;
        double z_mm = 0.0;
        double dwell_s = 0.0;  ///< length of a dwell
    };
    /// From R down and back. Needs bottom_mm < retract_mm; pecks of less than a thousandth of the way are taken as
    /// that.
    [[nodiscard]] std::vector<Step> steps() const;
};

}  // namespace millforce::sim
