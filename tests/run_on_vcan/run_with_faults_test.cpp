// SPDX-License-Identifier: Apache-2.0
#include <csignal>

#include "bus/plant_wiring.hpp"
#include "faults/campaign.hpp"
#include "run_on_vcan/live_bench.hpp"

#include <CppUTest/TestHarness.h>

// `millforce run` on vcan0 in lock-step with a machine in this process, on which something goes wrong.

using namespace millforce;
using namespace millforce::vcan;
using faults::SignalFault;

namespace {

std::unique_ptr<sim::PlantOnCan> plant_on_vcan(const sim::Scenario& scenario) {
    sim::PlantOnCanSettings settings = sim::plant_on_bus(scenario, "vcan0");
    settings.time.in_lock_step = true;
    socketcan::CanSocketSettings socket;
    CHECK(socket.set_interface("vcan0"));
    return std::make_unique<sim::PlantOnCan>(settings, std::make_unique<host::SocketPort>(socket));
}

}  // namespace

TEST_GROUP(RunWithFaults) {
    const LiveFolder folder;
    const faults::Part part = faults::part_named("slot_entry");

    faults::Tally mill_with(SignalFault fault, std::uint64_t seed) {
        std::vector<std::string> words = folder.run_words();
        words.emplace_back("--lock-step");
        test::Program controller(words);
        faults::Tally tally;
        tally.add(faults::mill_with_controller(part, *plant_on_vcan(part.scenario), fault, seed));
        controller.interrupt(SIGTERM);
        controller.wait();
        LONGS_EQUAL(0, controller.exit_code());
        return tally;
    }
};

TEST(RunWithFaults, holds_the_feed_before_a_tooth_breaks) {
    folder.write("machine.toml", test::text_of(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml"));
    std::uint64_t seed = 10;
    for (const SignalFault fault : {SignalFault::spindle_frozen, SignalFault::x_tenfold, SignalFault::encoder_double,
                                    SignalFault::spindle_reversed, SignalFault::encoder_frozen}) {
        const faults::Tally tally = mill_with(fault, ++seed);
        LONGS_EQUAL_TEXT(1, tally.runs, faults::name_of(fault));
        LONGS_EQUAL_TEXT(0, tally.violations(), faults::name_of(fault));
        LONGS_EQUAL_TEXT(1, static_cast<long>(tally.reactions_s.size()), faults::name_of(fault));
    }
}
