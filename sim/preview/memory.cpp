// SPDX-License-Identifier: Apache-2.0
#include "preview/memory.hpp"

#include "loop/simulation.hpp"

namespace millforce::sim {

LearntPart mill_and_learn(const Scenario& scenario, const std::optional<host::PartMap>& map,
                          double stock_tolerance_mm) {
    host::MapLearner learner(scenario.parameters);
    learner.set_stock_tolerance(stock_tolerance_mm);
    MappedController controller(scenario.parameters, map, &learner);
    LearntPart part;
    part.figures = simulate(scenario, controller, "millforce").result.figures;
    part.map = learner.map();
    part.is_refuted = controller.is_refuted();
    return part;
}

}  // namespace millforce::sim
