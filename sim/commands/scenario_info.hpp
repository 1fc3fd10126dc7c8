// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "loop/scenario.hpp"
#include "report/run_result.hpp"

namespace millforce::sim {

/// Overrides of the constant feeds that a run is compared with; 0: none.
struct ConstantFeeds {
    double safe_ratio = 0.0;       ///< safe everywhere, even where K_s is `hardest` times as high
    double hindsight_ratio = 0.0;  ///< safe for exactly this material
    double hardest = 1.0;
};

/// What a report says about the scenario.
ScenarioInfo info_of(const Scenario& scenario, const ConstantFeeds& feeds);

}  // namespace millforce::sim
