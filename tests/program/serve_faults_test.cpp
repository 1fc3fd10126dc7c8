// SPDX-License-Identifier: Apache-2.0
#include "faults/campaign.hpp"
#include "program/bridge.hpp"
#include "program/inputs.hpp"
#include "program/program.hpp"

#include <CppUTest/TestHarness.h>

// `millforce serve` behind its socket, and a part on which something goes wrong.

using namespace millforce;
using namespace millforce::faults;

namespace {

const std::string scenarios = MILLFORCE_SOURCE_DIR "/sim/scenarios/";

/// A connection for each part: that is a run of its own.
ControllerOnLink::Exchange over_socket(const std::string& name) {
    auto bridge = std::make_shared<test::Bridge>(name);
    return [bridge](std::span<const std::uint8_t> message, local_link::OverrideBytes& answer) {
        bridge->send(message);
        return bridge->receive(answer) > 0;
    };
}

}  // namespace

TEST_GROUP(ServeWithFaults) {
    test::Inputs inputs;
    const Part part = part_named("slot_entry");
    const std::string socket = inputs.name("a.sock");
    test::Program serve{{"serve", socket, "--machine", scenarios + "machines/vmc.toml", "--tool",
                         scenarios + "tools/endmill_10mm.toml"}};

    void break_nothing(const Fault& fault, std::uint64_t seed) {
        ControllerOnLink controller(over_socket(socket), seed);
        const auto* of_link = std::get_if<LinkFault>(&fault);
        const auto begin = [&] { controller.begin(of_link != nullptr ? *of_link : LinkFault::none); };
        Tally tally;
        tally.add(mill_with_controller(part, controller, fault, seed, {.begin = begin}));
        LONGS_EQUAL_TEXT(1, tally.runs, name_of(fault));
        LONGS_EQUAL_TEXT(0, tally.violations(), name_of(fault));
        LONGS_EQUAL_TEXT(1, static_cast<long>(tally.reactions_s.size()), name_of(fault));
    }
    void teardown() override {
        serve.interrupt(SIGTERM);
        serve.wait();
        LONGS_EQUAL(0, serve.exit_code());
    }
};

TEST(ServeWithFaults, holds_the_feed_before_a_tooth_breaks) {
    std::uint64_t seed = 10;
    for (const SignalFault fault : {SignalFault::spindle_frozen, SignalFault::spindle_absent, SignalFault::not_a_number,
                                    SignalFault::encoder_double, SignalFault::time_backwards}) {
        break_nothing(fault, ++seed);
    }
    for (const LinkFault fault : {LinkFault::nothing_present, LinkFault::samples_repeated, LinkFault::message_cut,
                                  LinkFault::controller_hangs}) {
        break_nothing(fault, ++seed);
    }
}
