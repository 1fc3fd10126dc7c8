// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "loop/scenario.hpp"

namespace millforce::test {

/// One of sim/scenarios, in material of `hardness` times its K_s.
inline sim::Scenario scenario_named(const std::string& name, double hardness = 1.0) {
    sim::Scenario scenario = sim::read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/" + name + ".toml");
    scenario.deviation.cutting_force_scale = hardness;
    return scenario;
}

}  // namespace millforce::test
