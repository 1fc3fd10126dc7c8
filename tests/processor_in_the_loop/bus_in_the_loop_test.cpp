// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "files/toml_reader.hpp"
#include "loop/bounds.hpp"
#include "loop/scenario.hpp"
#include "loop/simulation.hpp"

#include <CppUTest/TestHarness.h>

// A whole scenario milled on an emulated zcu102: the controller's image on its Cortex-R5F, the plant on its Cortex-A53,
// and nothing but CAN frames between them. MILLFORCE_LOOP_SCENARIO names another scenario.

using namespace millforce;

namespace {

std::string bus_scenario_file() {
    const char* named = std::getenv("MILLFORCE_LOOP_SCENARIO");
    return named != nullptr ? named : MILLFORCE_SOURCE_DIR "/sim/scenarios/slot_entry.toml";
}

/// What the plant's program prints. `tool`: number of the scenario's tool in a block of several.
std::string milled_on_zcu102(const std::string& scenario_file, const std::string& tool = "") {
    const std::string source = MILLFORCE_SOURCE_DIR;
    const std::string command = "MILLFORCE_ICOUNT=1 '" + source + "/toolchains/run-on-zcu102' '" + source +
                                "/build/aarch64/tests/target/zcu102_plant/zcu102_plant' '" + source +
                                "/build/cortex-r5f/firmware/boards/zcu102/millforce_zcu102.elf' '" + scenario_file +
                                "' " + tool;
    std::FILE* const pipe = popen(command.c_str(), "r");
    std::string text;
    std::array<char, 256> part{};
    while (pipe != nullptr && std::fgets(part.data(), part.size(), pipe) != nullptr) {
        text += part.data();
    }
    const int status = pipe != nullptr ? pclose(pipe) : -1;
    LONGS_EQUAL_TEXT(0, status, text.c_str());
    return text;
}

sim::RunFigures figures_in(host::TomlFile::Table& told) {
    sim::RunFigures figures;
    figures.finished = told.boolean("finished", false);
    figures.time_s = told.number("time_s", 0.0, 1e9);
    figures.peak_over_limit = told.number("peak_over_limit", 0.0, 1e9);
    figures.late_over_limit_s = told.number("late_over_limit_s", 0.0, 1e9);
    figures.teeth_broken = static_cast<int>(told.number("teeth_broken", 0.0, 1e9));
    return figures;
}

/// That the part was milled as by the controller without a bus.
void check_as_without_a_bus(const sim::RunFigures& figures, const sim::Scenario& scenario) {
    CHECK_TRUE(figures.finished);
    CHECK_TRUE(sim::bounds_hold(figures));
    sim::MillforceController direct(scenario.parameters);
    const sim::RunFigures in_process = sim::simulate(scenario, direct, "millforce").result.figures;
    DOUBLES_EQUAL(in_process.time_s, figures.time_s, 0.03 * in_process.time_s);
    DOUBLES_EQUAL(in_process.peak_over_limit, figures.peak_over_limit, 0.03);
}

}  // namespace

TEST_GROUP(BusInTheLoop){};

TEST(BusInTheLoop, a_Cortex_R5F_mills_a_part_with_nothing_but_frames_between) {
    const sim::Scenario scenario = sim::read_scenario(bus_scenario_file());
    host::TomlFile file = host::TomlFile::from_text(milled_on_zcu102(bus_scenario_file()), "zcu102");
    host::TomlFile::Table told = file.root();
    const auto count = [&](const char* name) { return told.number(name, 0.0, 1e9); };
    const sim::RunFigures figures = figures_in(told);
    check_as_without_a_bus(figures, scenario);
    DOUBLES_EQUAL(0.0, count("lost"), 0.0);
    DOUBLES_EQUAL(0.0, count("calls_of_host"), 0.0);         // from the R5F's start to the end of the cut
    CHECK_COMPARE(count("longest_delay_us"), <, 1000.0);     // a period: the plant keeps up with the bus
    CHECK_COMPARE(count("syncs"), >, 1e3 * figures.time_s);  // none was missed: the spindle's start comes on top
    CHECK_COMPARE(count("sent"), >, 4.0 * count("syncs"));   // a PDO of each drive
    CHECK_COMPARE(count("received"), >, count("syncs"));
}

TEST(BusInTheLoop, a_Cortex_R5F_takes_the_tool_of_its_block_whose_number_the_CNC_tells) {
    const std::string slot = MILLFORCE_SOURCE_DIR "/sim/scenarios/slot_entry.toml";
    host::TomlFile file = host::TomlFile::from_text(milled_on_zcu102(slot, "7"), "zcu102");
    host::TomlFile::Table told = file.root();
    check_as_without_a_bus(figures_in(told), sim::read_scenario(slot));
}
