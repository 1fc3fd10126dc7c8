// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "report/run_result.hpp"

/// A pocket in two levels, milled from the middle outwards, with slots, corners, rapid moves, noise and stretches
/// without an estimate: what a report must be able to show. The forces follow a simple law; nothing here is a claim
/// about cutting.
namespace millforce::sim::synthetic {

ScenarioInfo pocket_scenario();

/// The pocket under a controller: "millforce" follows the force, any other keeps a constant feed.
RunResult pocket_run(const std::string& controller);

}  // namespace millforce::sim::synthetic
