// SPDX-License-Identifier: Apache-2.0
#include "check/commanded_speed.hpp"

#include <CppUTest/TestHarness.h>

#include <string>
#include <vector>

#include "estimation/number/circle.hpp"
#include "firmware/program/check/made_recording.hpp"

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

constexpr double speed_rad_s = 300.0;

/// A spindle that turns at `ratio` times the commanded speed for so long.
std::vector<MotionWindow> turning(double ratio, double duration_s = 4.0) {
    std::vector<MotionWindow> windows;
    for (double start_s = 0.0; start_s < duration_s; start_s += 0.2) {
        MotionWindow window;
        window.start_s = start_s;
        window.duration_s = 0.2;
        window.turned_rev = speed_rad_s * window.duration_s / estimation::turn_rad<double>;
        window.commanded_rad_s = speed_rad_s / ratio;
        windows.push_back(window);
    }
    return windows;
}

std::string lines_for(const std::vector<MotionWindow>& windows, bool counts_are_proven = false) {
    firmware::MachineParameters<float> machine;
    machine.encoder_counts_per_rev = 1024;
    return lines_of(check_commanded_speed(ratio_to_commanded_speed(windows), machine, counts_are_proven));
}

}  // namespace

TEST_GROUP(CommandedSpeedCheck){};

TEST(CommandedSpeedCheck, finds_nothing_within_a_fifth) {
    for (const double ratio : {0.81, 0.97, 1.0, 1.19}) {
        STRCMP_EQUAL("", lines_for(turning(ratio)).c_str());
    }
}

TEST(CommandedSpeedCheck, finds_the_counts_that_the_encoder_must_have) {
    STRCMP_EQUAL(
        "error: spindle: by the encoder it turns at 4 times the commanded speed: 4096 counts per revolution instead of "
        "1024? [spindle.encoder_counts_per_rev]\n",
        lines_for(turning(4.0)).c_str());
}

TEST(CommandedSpeedCheck, blames_the_command_where_index_pulses_prove_the_counts) {
    STRCMP_EQUAL(
        "error: spindle: by the encoder it turns at 0.5 times the commanded speed, and index pulses prove its counts; "
        "is there a gear, or an override? [commanded_speed_rad_s]\n",
        lines_for(turning(0.5), true).c_str());
}

TEST(CommandedSpeedCheck, finds_a_command_in_another_unit) {
    const struct {
        double units_per_rad_s;
        const char* question;
    } units[] = {{30.0 / 3.14159265, "is it in rpm?"}, {0.159155, "is it in rev/s?"}, {57.29578, "is it in deg/s?"}};
    for (const auto& unit : units) {
        const std::string lines = lines_for(turning(1.0 / unit.units_per_rad_s));
        CHECK_TRUE(lines.find(unit.question) != std::string::npos);
        CHECK_TRUE(lines.find("[commanded_speed_rad_s]") != std::string::npos);
    }
}

TEST(CommandedSpeedCheck, judges_no_spindle_that_has_not_turned_as_commanded_for_a_second) {
    STRCMP_EQUAL("", lines_for(turning(4.0, 1.0)).c_str());
    std::vector<MotionWindow> runs_up = turning(4.0);
    std::vector<MotionWindow> other_command = turning(4.0);
    for (std::size_t k = 0; k < runs_up.size(); k += 4) {
        runs_up[k].spindle_acceleration_rad_s2 = 500.0;
        other_command[k].commanded_rad_s = 0.0;
    }
    STRCMP_EQUAL("", lines_for(runs_up).c_str());
    STRCMP_EQUAL("", lines_for(other_command).c_str());
}

TEST(CommandedSpeedCheck, of_a_whole_recording_needs_no_index_pulses) {
    constexpr float at_3000_rpm = 314.16F;
    const MadeRecording right = made_recording({});
    const firmware::Parameters<float> parameters = right_parameters();
    constexpr bool no_index = false;
    const std::string as_commanded = test::lines_for(right, parameters, no_index, at_3000_rpm);
    STRCMP_CONTAINS("compared with the commanded speed alone", as_commanded.c_str());
    CHECK_TRUE(as_commanded.find("error") == std::string::npos);
    const std::string at_half = test::lines_for(right, parameters, no_index, 0.5F * at_3000_rpm);
    STRCMP_CONTAINS("it turns at 2 times the commanded speed", at_half.c_str());
}
