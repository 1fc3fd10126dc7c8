// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "loop/scenario.hpp"
#include "report/run_result.hpp"

namespace millforce::sim {

/// What a report says about the scenario. `constant_ratio`: override of the constant feed that is safe everywhere.
ScenarioInfo info_of(const Scenario& scenario, double constant_ratio);

}  // namespace millforce::sim
