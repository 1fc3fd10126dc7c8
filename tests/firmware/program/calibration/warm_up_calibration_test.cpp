// SPDX-License-Identifier: Apache-2.0
#include "calibration/warm_up_calibration.hpp"
#include "files/input_error.hpp"
#include "firmware/program/calibration/scaled_column.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>  // before CppUTest, which makes `new` a macro

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

using namespace millforce::host;
using namespace millforce::test;

namespace {

/// 20 Hz; K_t1 0.5 N·m/A, 0.9 N·m warm, 0.3 N·m more when cold, 200 s; the spindle runs up in the first 2 s.
std::string idle_recording(double duration_s, double second_speed_rad_s = 400.0, double excess_Nm = 0.3) {
    std::mt19937 generator(6);
    std::normal_distribution<double> noise(0.0, 0.05);
    std::string text = "time_s,spindle_angle_rad,spindle_current_A\n";
    double angle = 0.0;
    for (double t = 0.0; t < duration_s; t += 0.05) {
        const double speed = t < 2.0 ? 200.0 * t : (t < 0.5 * duration_s ? 400.0 : second_speed_rad_s);
        angle += speed * 0.05;
        const double torque = 0.9 + excess_Nm * std::exp(-t / 200.0) + (t < 2.0 ? 5.0 : 0.0);
        text += fmt::format("{:.2f},{:.4f},{:.5f}\n", t, angle, torque / 0.5 + noise(generator));
    }
    return text;
}

std::string standing_recording() {
    std::string text = "time_s,spindle_angle_rad,spindle_current_A\n";
    for (int k = 0; k < 1000; ++k) {
        text += fmt::format("{:.1f},1,2\n", 0.1 * k);
    }
    return text;
}

struct WarmUpRun {
    int code = -1;
    std::string text;
    std::string error;
    toml::table toml;
};

WarmUpRun calibrate_warm_up_of(const std::string& data,
                               const std::string& machine = "[spindle]\nK_t1_Nm_per_A = 0.5\n") {
    const TemporaryFolder folder;
    WarmUpCalibrationOptions options;
    options.data = folder.write("idle.csv", data);
    options.machine = folder.write("machine.toml", machine);
    options.output = folder.path("out.toml");
    std::ostringstream out;
    WarmUpRun run;
    run.error = message_of<InputError>([&] { run.code = calibrate_warm_up(options, out); });
    run.text = out.str();
    if (run.error.empty()) {
        run.toml = toml::parse(folder.read("out.toml"));
    } else {
        LONGS_EQUAL(2, folder.file_count());
    }
    return run;
}

void refuses_warm_up(const std::string& data, const std::string& part) {
    const std::string error = calibrate_warm_up_of(data).error;
    CHECK_TEXT(error.find(part) != std::string::npos, error.c_str());
    LONGS_EQUAL(0, std::count(error.begin(), error.end(), '\n'));
}

}  // namespace

TEST_GROUP(WarmUpCalibration){};

TEST(WarmUpCalibration, finds_torque_and_time_with_their_standard_errors) {
    const WarmUpRun run = calibrate_warm_up_of(idle_recording(700.0));
    STRCMP_EQUAL("", run.error.c_str());
    const auto within = [&](const std::string& key, double truth) {
        const double error = run.toml["spindle"][key + "_se"].value_or(std::nan(""));
        DOUBLES_EQUAL(truth, run.toml["spindle"][key].value_or(std::nan("")), 4.0 * error);
        CHECK(error < 0.1 * truth);
    };
    within("warm_up_time_s", 200.0);
    within("warm_up_torque_Nm", 0.3);
}

TEST(WarmUpCalibration, refuses_what_does_not_show_the_curve) {
    refuses_warm_up(idle_recording(120.0), "expected a record of");
    refuses_warm_up(idle_recording(700.0, 400.0, 0.0), "does not fall");
    refuses_warm_up(idle_recording(700.0, 300.0), "one speed");
    refuses_warm_up(idle_recording(0.5), "ten minutes");
    refuses_warm_up("time_s,spindle_angle_rad\n0,0\n", "spindle_current_A");
    refuses_warm_up("time_s,spindle_angle_rad,spindle_current_A\n0,0,1\n0,1,1\n",
                    "0 s after 0 s; expected time to grow");
    refuses_warm_up(standing_recording(), "the spindle holds 0 rad/s");
}

TEST(WarmUpCalibration, passes_over_samples_without_an_angle_or_a_current) {
    std::string text = idle_recording(700.0);
    for (const char* time : {"\n100.00,", "\n200.00,"}) {
        const std::size_t row = text.find(time);
        const std::size_t cell = row + std::string(time).size();
        text.erase(cell, text.find(',', cell) - cell);
    }
    const std::size_t end = text.rfind(',');
    text.erase(end + 1, text.size() - end - 2);
    const WarmUpRun run = calibrate_warm_up_of(text);
    STRCMP_EQUAL("", run.error.c_str());
    DOUBLES_EQUAL(200.0, run.toml["spindle"]["warm_up_time_s"].value_or(0.0), 40.0);
}

TEST(WarmUpCalibration, refuses_a_time_or_an_angle_in_another_unit_by_the_speed_that_it_means) {
    const std::string sound = idle_recording(700.0);
    refuses_warm_up(scaled(sound, "time_s", 1000.0),
                    "the spindle turns at 0.4 rad/s, 3.82 1/min; expected 5 to 20000 rad/s; is spindle_angle_rad in "
                    "revolutions, or time_s in ms?");
    refuses_warm_up(scaled(sound, "time_s", 1.0 / 60.0), "is spindle_angle_rad in degrees, or time_s in min?");
    refuses_warm_up(scaled(sound, "time_s", 1.0 / 3600.0), "less than a second; expected ten minutes or more");
    refuses_warm_up(scaled(sound, "spindle_angle_rad", 57.29578), "is spindle_angle_rad in degrees");
}

TEST(WarmUpCalibration, refuses_a_current_in_mA_by_the_amperes_the_rated_current_or_the_idle_torque) {
    const std::string in_mA = scaled(idle_recording(700.0), "spindle_current_A", 1000.0);
    refuses_warm_up(in_mA, "A, 9");
    refuses_warm_up(in_mA, "N·m; expected at most 1000 A; is it in mA?");
    const std::string of_a_small_spindle = scaled(idle_recording(700.0), "spindle_current_A", 100.0);
    const auto error_beside = [&](const std::string& key) {
        return calibrate_warm_up_of(of_a_small_spindle, "[spindle]\nK_t1_Nm_per_A = 0.5\n" + key).error;
    };
    CHECK(contains(error_beside("rated_current_A = 12\n"), "less than the rated 12 A of the machine's file"));
    CHECK(contains(error_beside("K_t2_Nm = -0.9\n"), "about the 0.9 N·m of the machine's file; is it in mA?"));
}

TEST(WarmUpCalibration, asks_about_a_speed_that_is_round_only_in_1_per_s) {
    const std::string at_1000_rpm = scaled(idle_recording(700.0), "spindle_angle_rad", 104.719755 / 400.0);
    LONGS_EQUAL(0, calibrate_warm_up_of(at_1000_rpm).code);
    const WarmUpRun run = calibrate_warm_up_of(scaled(at_1000_rpm, "spindle_angle_rad", 0.15915494));
    LONGS_EQUAL(1, run.code);
    CHECK(contains(run.text, "only in 1/s is each speed a multiple of 50 1/min"));
    CHECK(contains(run.text, "is spindle_angle_rad in revolutions?"));
}
