// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "loop/scenario.hpp"
#include "part_map/map_learner.hpp"
#include "part_map/part_map.hpp"
#include "report/run_result.hpp"

namespace millforce::sim {

/// A part milled, and the map that its run leaves behind.
struct LearntPart {
    RunFigures figures;
    host::PartMap map;
    bool is_refuted = false;  ///< the map that was looked ahead with
};

/// Mills the scenario's part, with a map to look ahead with or without one. The map that is learnt allows for blanks
/// that lie off by `stock_tolerance_mm`.
[[nodiscard]] LearntPart mill_and_learn(const Scenario& scenario, const std::optional<host::PartMap>& map = {},
                                        double stock_tolerance_mm = host::MapLearner::default_stock_tolerance_mm);

/// What a first part without a map leaves behind for the second.
[[nodiscard]] inline host::PartMap memory_of(const Scenario& scenario,
                                             double stock_tolerance_mm = host::MapLearner::default_stock_tolerance_mm) {
    return mill_and_learn(scenario, {}, stock_tolerance_mm).map;
}

}  // namespace millforce::sim
