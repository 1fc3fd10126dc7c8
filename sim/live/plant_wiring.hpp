#pragma once

#include "bus/cnc_on_bus.hpp"
#include "bus/machine_on_bus.hpp"
#include "files/machine_bus.hpp"
#include "loop/scenario.hpp"

namespace millforce::sim {

/// The simulated drives of a scenario's machine, wired as its [bus] tables say.
MachineOnBusSettings drives_on_bus(const Scenario& scenario, const MachineBus& bus);

/// The simulated CNC of a scenario's machine on the same bus.
CncOnBusSettings cnc_on_bus(const Scenario& scenario, const MachineBus& bus);

}  // namespace millforce::sim
