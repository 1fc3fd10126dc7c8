// SPDX-License-Identifier: Apache-2.0
#include "controller_on_loopback.hpp"

#include "loop/bounds.hpp"
#include "loop/simulation.hpp"
#include "part_map/way_along_map.hpp"
#include "preview/preview.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;

namespace {

sim::Scenario slot() {
    return sim::read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/slot_entry.toml");
}

/// Position frames do not come through.
class WithoutPosition final : public firmware::WaySource<float> {
  public:
    explicit WithoutPosition(firmware::WaySource<float>& way) : way_(way) {}
    void look_ahead(firmware::ForceControlTick<float>& tick, const hal::ProgramStatus& program) override {
        hal::ProgramStatus without = program;
        without.line = 0;
        way_.look_ahead(tick, without);
    }

  private:
    firmware::WaySource<float>& way_;
};

sim::RunFigures over_bus(firmware::WaySource<float>* way) {
    const sim::Scenario scenario = slot();
    ControllerOnLoopback behind_bus(scenario, nullptr, way);
    return sim::simulate(scenario, behind_bus, "millforce").result.figures;
}

}  // namespace

TEST_GROUP(MapOverBus){};

TEST(MapOverBus, a_part_map_is_worth_as_much_as_without_a_bus_and_a_map_is_learnt) {
    const sim::Scenario scenario = slot();
    const host::PartMap map = sim::preview(scenario);
    sim::MappedController direct(scenario.parameters, map);
    const sim::RunFigures in_process = sim::simulate(scenario, direct, "millforce").result.figures;
    host::MapFollower follower(scenario.parameters, map);
    host::MapLearner learner(scenario.parameters);
    host::WayAlongMap way(&follower, &learner);
    const sim::RunFigures figures = over_bus(&way);
    CHECK(sim::bounds_hold(figures));
    CHECK_FALSE(follower.ahead().is_refuted());
    DOUBLES_EQUAL(in_process.time_s, figures.time_s, 0.03 * in_process.time_s);
    DOUBLES_EQUAL(map.back().path_mm, learner.map().back().path_mm, 0.05 * map.back().path_mm);
}

TEST(MapOverBus, without_a_position_the_map_is_worth_nothing_and_does_no_harm) {
    const sim::Scenario scenario = slot();
    host::MapFollower follower(scenario.parameters, sim::preview(scenario));
    WithoutPosition way(follower);
    const sim::RunFigures blind = over_bus(nullptr);
    const sim::RunFigures figures = over_bus(&way);
    CHECK(sim::bounds_hold(figures));
    DOUBLES_EQUAL(blind.time_s, figures.time_s, 0.03 * blind.time_s);
}
