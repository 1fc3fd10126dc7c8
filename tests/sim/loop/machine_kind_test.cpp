// SPDX-License-Identifier: Apache-2.0
#include "loop/machine_kind.hpp"

#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "files/input_error.hpp"
#include "loop/ensemble.hpp"

using namespace millforce::sim;

namespace {

const std::string scenarios = std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/";

MachineKind kind_named(const std::string& name) {
    return read_machine_kind(scenarios + "kinds/" + name + ".toml");
}

/// The first seconds of the slot, which the tool enters in the first one.
RunFigures in_a_slot(const MachineKind& kind) {
    EnsembleSettings settings;
    settings.longest_run_s = 3.0;
    return run_ensemble(on_machine(read_scenario(scenarios + "slot_entry.toml"), kind), 1, {}, settings).front();
}

std::string refusal(const std::string& text) {
    const millforce::test::TemporaryFolder folder;
    const std::string path = folder.write("kind.toml", text);
    return millforce::test::message_of<millforce::host::InputError>([&] { read_machine_kind(path); });
}

}  // namespace

TEST_GROUP(MachineKind){};

TEST(MachineKind, every_kind_cuts_without_a_fault) {
    int kinds = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scenarios + "kinds")) {
        const RunFigures figures = in_a_slot(read_machine_kind(entry.path().string()));
        STRCMP_EQUAL_TEXT("none", figures.fault.c_str(), entry.path().c_str());
        CHECK_TEXT(figures.peak_over_limit > 0.3, entry.path().c_str());
        CHECK_TEXT(figures.tangential_error < 0.5, entry.path().c_str());
        ++kinds;
    }
    LONGS_EQUAL(7, kinds);
}

TEST(MachineKind, a_slow_load_is_a_worse_force_than_a_current_in_each_cycle) {
    const RunFigures current = in_a_slot(kind_named("1_can"));
    const RunFigures load = in_a_slot(kind_named("5_modbus"));
    CHECK(load.tangential_error > 2.0 * current.tangential_error);
}

TEST(MachineKind, immersion_and_depth_take_the_currents_of_the_axes) {
    const RunFigures all = in_a_slot(kind_named("1_can"));
    const RunFigures spindle = in_a_slot(kind_named("4_step_direction"));
    CHECK(all.estimate_share > 0.5);
    CHECK(all.depth_share > 0.5);
    CHECK(std::isfinite(all.feed_force_error));
    DOUBLES_EQUAL(0.0, spindle.estimate_share, 0.0);
    DOUBLES_EQUAL(0.0, spindle.depth_share, 0.0);
    CHECK(std::isnan(spindle.feed_force_error));
}

TEST(MachineKind, noise_and_gain_hold_for_the_plant_and_for_what_the_controller_is_told) {
    const MachineKind kind = kind_named("3_analogue");
    const Scenario scenario = on_machine(read_scenario(scenarios + "slot_entry.toml"), kind);
    DOUBLES_EQUAL(0.03, scenario.deviation.current_noise_share, 0.0);
    DOUBLES_EQUAL(0.36, static_cast<double>(scenario.parameters.machine.axes[1].current_sd_A), 1e-6);  // of 12 A
    DOUBLES_EQUAL(0.05, static_cast<double>(scenario.parameters.machine.spindle.gain_relative_sd), 1e-6);
}

TEST(MachineKind, a_file_that_is_wrong_is_refused_by_its_key) {
    STRCMP_CONTAINS("title", refusal("machine = \"vmc.toml\"\n").c_str());
    STRCMP_CONTAINS("none.toml", refusal("title = \"t\"\nmachine = \"none.toml\"\n").c_str());
    const std::string head = "title = \"t\"\nmachine = \"" + scenarios + "machines/vmc.toml\"\n";
    STRCMP_CONTAINS("noise_shar", refusal(head + "[currents]\nnoise_shar = 0.03\n").c_str());
    STRCMP_CONTAINS("adc_12_bit", refusal(head + "[currents]\nchannel = \"adc\"\n").c_str());
    STRCMP_CONTAINS("period_s", refusal(head + "[load_meter]\nperiod_s = -0.1\n").c_str());
}
