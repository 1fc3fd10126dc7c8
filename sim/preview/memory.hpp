// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "loop/scenario.hpp"
#include "part_map/part_map.hpp"
#include "report/run_result.hpp"

namespace millforce::sim {

/// A part milled, and the map that its run leaves behind.
struct LearntPart {
    RunFigures figures;
    host::PartMap map;
    bool is_refuted = false;  ///< the map that was looked ahead with
};

/// Mills the scenario's part, with a map to look ahead with or without one.
[[nodiscard]] LearntPart mill_and_learn(const Scenario& scenario, const std::optional<host::PartMap>& map = {});

/// What a first part without a map leaves behind for the second.
[[nodiscard]] inline host::PartMap memory_of(const Scenario& scenario) {
    return mill_and_learn(scenario).map;
}

}  // namespace millforce::sim
