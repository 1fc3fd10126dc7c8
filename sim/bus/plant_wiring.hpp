// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bus/cnc_on_bus.hpp"
#include "bus/machine_on_bus.hpp"
#include "bus/plant_on_can.hpp"
#include "loop/scenario.hpp"
#include "parameters/machine_bus.hpp"

namespace millforce::sim {

/// The simulated drives of a scenario's machine, wired as its [bus] tables say.
MachineOnBusSettings drives_on_bus(const Scenario& scenario, const host::MachineBus& bus);

/// The simulated CNC of a scenario's machine on the same bus.
CncOnBusSettings cnc_on_bus(const Scenario& scenario, const host::MachineBus& bus);

/// Both, as the scenario's machine file has them on an interface; InputError where no drive of it is on a bus. Its time
/// is the clock's.
PlantOnCanSettings plant_on_bus(const Scenario& scenario, const std::string& interface);

}  // namespace millforce::sim
