#include <csignal>
#include <cstdlib>
#include <fstream>

#include "emulated_bus.hpp"
#include "files/parameter_files.hpp"
#include "firmware/parameter_block.hpp"
#include "live/plant_on_can.hpp"
#include "live/plant_wiring.hpp"
#include "loop/bounds.hpp"
#include "loop/scenario.hpp"
#include "loop/simulation.hpp"

#include <CppUTest/TestHarness.h>

// A whole scenario milled by the controller's image on a Cortex-R5F, with nothing but CAN frames between it and the plant:
// two CAN controllers on one bus, one of the image, one of the plant. MILLFORCE_LOOP_SCENARIO names another scenario.

using namespace millforce;

namespace {

std::string bus_scenario_file() {
    const char* named = std::getenv("MILLFORCE_LOOP_SCENARIO");
    return named != nullptr ? named : MILLFORCE_SOURCE_DIR "/sim/scenarios/slot_entry.toml";
}

std::string parameter_file(const EmulatorPipes& pipes, const firmware::Parameters<float>& parameters) {
    std::string name = pipes.folder().path("parameters.bin").string();
    const firmware::ParameterBlock block = firmware::encoded(parameters, 1);
    std::ofstream(name, std::ios::binary)
        .write(reinterpret_cast<const char*>(block.data()), static_cast<std::streamsize>(block.size()));
    return name;
}

}  // namespace

TEST_GROUP(BusInTheLoop) {
    void setup() override { std::signal(SIGPIPE, SIG_IGN); }
    void teardown() override { std::signal(SIGPIPE, SIG_DFL); }
};

TEST(BusInTheLoop, a_Cortex_R5F_mills_a_part_with_nothing_but_frames_between) {
    const sim::Scenario scenario = sim::read_scenario(bus_scenario_file());
    const auto bus = sim::read_machine_bus(scenario.machine_file);
    CHECK_TRUE(bus.has_value());
    sim::PlantOnCanSettings settings;
    settings.interface = "zcu102";
    settings.machine = sim::drives_on_bus(scenario, *bus);
    settings.cnc = sim::cnc_on_bus(scenario, *bus);
    settings.sync_id = bus->drives.sync_id;
    EmulatorPipes pipes;
    auto port = std::make_unique<EmulatedBus>(pipes, parameter_file(pipes, scenario.parameters));
    const EmulatedBus& wire = *port;
    CHECK_TRUE_TEXT(pipes.works(), "the emulator does not start");
    sim::PlantOnCan plant(settings, std::move(port));

    const sim::RunFigures figures = sim::simulate(scenario, plant, "zcu102").result.figures;
    CHECK_TRUE(pipes.works());
    CHECK_TRUE(figures.finished);
    CHECK_TRUE(sim::bounds_hold(figures));
    UNSIGNED_LONGS_EQUAL(0, wire.lost);
    CHECK_COMPARE(plant.syncs(), >, 5000);
    CHECK_COMPARE(wire.sent, >, 4 * plant.syncs());  // a PDO of each drive
    CHECK_COMPARE(wire.received, >, plant.syncs());

    sim::MillforceController direct(scenario.parameters);
    const sim::RunFigures in_process = sim::simulate(scenario, direct, "millforce").result.figures;
    DOUBLES_EQUAL(in_process.time_s, figures.time_s, 0.03 * in_process.time_s);
    DOUBLES_EQUAL(in_process.peak_over_limit, figures.peak_over_limit, 0.03);
}
