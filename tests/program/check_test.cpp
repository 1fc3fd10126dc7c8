// SPDX-License-Identifier: Apache-2.0
#include "inputs.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

/// As a user runs it. What is found in a recording and in the files: tests/firmware/program/check.
TEST_GROUP(Check) {
    Inputs inputs;

    Ended check(const std::vector<std::string>& recording = {}) const {
        std::vector<std::string> words{"check", inputs.name("machine.toml"), inputs.name("tool.toml")};
        words.insert(words.end(), recording.begin(), recording.end());
        return run_millforce(words);
    }
    std::string simulated_recording() const {
        LONGS_EQUAL(0,
                    run_millforce({"simulate", inputs.name("scenario.toml"), "--record", "--out", inputs.name("run")})
                        .exit_code);
        return inputs.path("run/recording.csv").string();
    }
};

TEST(Check, finds_nothing_in_the_files_and_the_recording_of_a_right_machine) {
    const Ended files = check();
    STRCMP_EQUAL("nothing found; 0 notes\n", files.out.c_str());
    STRCMP_EQUAL("", files.error.c_str());
    LONGS_EQUAL(0, files.exit_code);
    const Ended all = check({simulated_recording()});
    CHECK_FALSE(contains(all.out, "warning: "));
    CHECK_FALSE(contains(all.out, "error: "));
    CHECK(contains(all.out, "nothing found; "));
    LONGS_EQUAL(0, all.exit_code);
}

TEST(Check, names_each_mistake_and_ends_with_exit_code_1) {
    inputs.write("machine.toml", machine_text + "[cnc]\noverride_min = 0.8\noverride_max = 0.7\n");
    const Ended ended = check();
    STRCMP_EQUAL(
        "error: override_max = 0.7 is not above override_min = 0.8: the controller would hold the feed "
        "[cnc.override_max]\n"
        "1 found: 1 error, 0 warnings; 0 notes\n",
        ended.out.c_str());
    LONGS_EQUAL(1, ended.exit_code);
}

TEST(Check, finds_a_reversed_sign_in_the_file_by_the_recording) {
    const std::string recording = simulated_recording();
    inputs.write("machine.toml", with(machine_text, "K_t2_Nm = -0.953", "K_t2_Nm = 0.953\nidle_torque_sd_Nm = 0.1"));
    const Ended ended = check({recording});
    CHECK(contains(ended.out, "is the sign wrong? [spindle.K_t2_Nm]"));
    CHECK(contains(ended.out, "error: spindle: the current is reversed"));
    LONGS_EQUAL(1, ended.exit_code);
}

TEST(Check, says_what_a_machine_without_axis_currents_cannot_know) {
    inputs.write("machine.toml", with(machine_text, "K_x4_N_per_A = 120.0", "K_x4_N_per_A = 0.0"));
    const Ended ended = check();
    CHECK(contains(ended.out, "note: neither x nor y gives a force (K_x4_N_per_A)"));
    CHECK(contains(ended.out, "nothing found; 1 note\n"));
    LONGS_EQUAL(0, ended.exit_code);
}

TEST(Check, refuses_files_that_cannot_be_read) {
    STRCMP_EQUAL("", not_refused(check({inputs.name("none.csv")}), {"none.csv", "cannot be opened"}).c_str());
    inputs.write("log.csv", "time_s,spindle_angle_rad\n0,0\n");
    STRCMP_EQUAL("", not_refused(check({inputs.name("log.csv")}), {"log.csv", "spindle_current_A"}).c_str());
    inputs.write("log.csv", "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s\n");
    STRCMP_EQUAL("", not_refused(check({inputs.name("log.csv")}), {"log.csv: no rows after the header"}).c_str());
    inputs.write("tool.toml", with(tool_text, "teeth = 4", "teeth = 400"));
    STRCMP_EQUAL("", not_refused(check(), {"tool.toml", "teeth"}).c_str());
}

TEST(Check, is_made_of_the_files_when_the_live_controller_starts) {
    inputs.write("machine.toml", machine_text + "[cnc]\noverride_min = 0.8\noverride_max = 0.7\n");
    Program serve({"serve", inputs.name("no/such/folder/socket"), "--machine", inputs.name("machine.toml"), "--tool",
                   inputs.name("tool.toml")});
    serve.wait();
    CHECK(contains(serve.error(), "millforce: error: override_max = 0.7 is not above override_min = 0.8"));
}
