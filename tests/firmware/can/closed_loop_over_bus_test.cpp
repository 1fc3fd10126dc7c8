#include "controller_on_loopback.hpp"

#include "loop/bounds.hpp"
#include "loop/simulation.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;

namespace {

sim::Scenario scenario_named(const std::string& name) {
    return sim::read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/" + name + ".toml");
}

}  // namespace

TEST_GROUP(ClosedLoopOverBus){};

TEST(ClosedLoopOverBus, a_scenario_gives_the_figures_of_the_loop_without_a_bus) {
    const sim::Scenario scenario = scenario_named("slot_entry");
    sim::MillforceController direct(scenario.parameters);
    const sim::RunFigures in_process = sim::simulate(scenario, direct, "millforce").result.figures;
    ControllerOnLoopback behind_bus(scenario);
    const sim::RunFigures over_bus = sim::simulate(scenario, behind_bus, "millforce").result.figures;
    std::printf("\n    peak %.3f and %.3f, time %.3f and %.3f s, fault %s, immersion rms %.3f and %.3f, share %.3f %.3f rej %d inc %u lost %u\n", in_process.peak_over_limit, over_bus.peak_over_limit,
                in_process.time_s, over_bus.time_s, over_bus.fault.c_str(), in_process.immersion_rms, over_bus.immersion_rms, in_process.estimate_share, over_bus.estimate_share, static_cast<int>(behind_bus.controller.drives().rejects().total()), behind_bus.controller.drives().health().samples_incomplete, behind_bus.controller.drives().health().samples_untaken);
    CHECK(over_bus.finished);
    CHECK(sim::bounds_hold(over_bus));
    DOUBLES_EQUAL(in_process.time_s, over_bus.time_s, 0.03 * in_process.time_s);
    DOUBLES_EQUAL(in_process.peak_over_limit, over_bus.peak_over_limit, 0.05);
}
