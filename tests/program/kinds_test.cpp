// SPDX-License-Identifier: Apache-2.0
#include "inputs.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

/// As a user runs it. What the kinds of sim/scenarios get: tests/sim/loop.
TEST_GROUP(Kinds) {
    Inputs inputs;

    Ended kinds(const std::string& kind) const {
        inputs.write("kind.toml", kind);
        return run_millforce(
            {"kinds", inputs.name("scenario.toml"), "--kind", inputs.name("kind.toml"), "--runs", "2"});
    }
};

TEST(Kinds, are_a_row_each_of_what_is_known_and_of_what_it_is_good_for) {
    const Ended ended = kinds("title = \"all currents\"\nmachine = \"machine.toml\"\npart_map = true\n");
    LONGS_EQUAL(0, ended.exit_code);
    STRCMP_EQUAL("", ended.error.c_str());
    STRCMP_CONTAINS("| immersion known |", ended.out.c_str());
    STRCMP_CONTAINS("| teeth broken | time: scenario |", ended.out.c_str());
    const std::string after_first_row = ended.out.substr(ended.out.find("| all currents |") + 1);
    STRCMP_CONTAINS("| all currents |", after_first_row.c_str());
}

TEST(Kinds, without_a_machine_are_refused) {
    STRCMP_EQUAL("", not_refused(kinds("title = \"t\"\n"), {"kind.toml", "machine"}).c_str());
}
