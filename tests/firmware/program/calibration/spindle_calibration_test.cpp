// SPDX-License-Identifier: Apache-2.0
#include "calibration/spindle_calibration.hpp"
#include "files/input_error.hpp"
#include "firmware/program/files/temporary_folder.hpp"

#include <toml++/toml.h>  // before CppUTest, which makes `new` a macro

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

using namespace millforce::host;
using namespace millforce::test;

namespace {

struct Run {
    int code = -1;
    std::string text;
    std::string error;
    toml::table toml;

    double value(const std::string& key) const { return toml["spindle"][key].value_or(std::nan("")); }
    void within(const std::string& key, double truth) const {
        DOUBLES_EQUAL(truth, value(key), 3.0 * value(key + "_se"));
    }
};

Run calibrate(std::string_view data) {
    const TemporaryFolder folder;
    SpindleCalibrationOptions options;
    options.data = {folder.write("spindle.csv", data)};
    options.output = folder.path("out.toml");
    Run run;
    std::ostringstream out;
    run.error = message_of<InputError>([&] { run.code = calibrate_spindle(options, out); });
    run.text = out.str();
    if (run.error.empty()) {
        run.toml = toml::parse(folder.read("out.toml"));
    } else {
        LONGS_EQUAL(1, folder.file_count());
    }
    return run;
}

/// One row per cut: K_t1 1.4 N·m/A up to 157 rad/s, K_t2 −0.6 N·m, idle slope 0.002 N·m·s.
std::string table(std::initializer_list<double> speeds, std::initializer_list<double> torques) {
    std::mt19937 generator(4);
    std::normal_distribution<double> normal(0.0, 0.03);
    std::ostringstream text;
    text << "spindle_speed_rad_s,spindle_torque_Nm,spindle_current_A\n";
    for (const double speed : speeds) {
        for (const double torque : torques) {
            const double gain = 1.4 * std::min(1.0, 157.0 / speed);
            text << speed << ',' << torque + normal(generator) << ',' << (torque + 0.6 + 0.002 * speed) / gain << '\n';
        }
        text << speed << ",,1.0\n";  // a row whose torque is not known
    }
    return text.str();
}

}  // namespace

TEST_GROUP(SpindleCalibration){};

TEST(SpindleCalibration, of_a_table_of_cuts_finds_torque_constant_idle_torque_and_field_weakening) {
    const Run run = calibrate(table({60, 90, 120, 220, 300, 400}, {0, 0, 2, 4, 6, 8}));
    STRCMP_EQUAL("", run.error.c_str());
    LONGS_EQUAL(0, run.code);
    run.within("K_t1_Nm_per_A", 1.4);
    run.within("K_t2_Nm", -0.6);
    run.within("idle_torque_slope_Nm_s", 0.002);
    run.within("base_speed_rad_s", 157.0);
    CHECK(run.value("K_t1_Nm_per_A_se") < 0.02);
    DOUBLES_EQUAL(0.0, run.value("inertia_kg_m2"), 0.0);
}

TEST(SpindleCalibration, of_a_recording_with_run_ups_finds_the_inertia_from_the_angle) {
    std::ostringstream text;
    text.precision(10);
    text << "time_s,spindle_angle_rad,spindle_current_A,spindle_torque_Nm\n";
    std::mt19937 generator(6);
    std::normal_distribution<double> normal(0.0, 0.05);
    double angle = 0.0;
    for (int k = 0; k < 8000; ++k) {
        const double t = 0.005 * k;
        const double speed = 100.0 + 30.0 * std::sin(0.9 * t);
        const double acceleration = 27.0 * std::cos(0.9 * t);
        const double torque = std::fmod(t, 10.0) < 5.0 ? 0.0 : 5.0;
        angle = std::fmod(angle + speed * 0.005, 2.0 * std::numbers::pi);
        text << t << ',' << angle << ','
             << (torque + 0.6 + 0.002 * speed + 0.02 * acceleration) / 1.4 + normal(generator) << ',' << torque << '\n';
    }
    const Run run = calibrate(text.str());
    STRCMP_EQUAL("", run.error.c_str());
    DOUBLES_EQUAL(1.4, run.value("K_t1_Nm_per_A"), 0.02);
    DOUBLES_EQUAL(0.02, run.value("inertia_kg_m2"), 0.0006);
    DOUBLES_EQUAL(0.0, run.value("base_speed_rad_s"), 0.0);
}

TEST(SpindleCalibration, refuses_idle_running_alone_and_a_load_that_does_not_vary) {
    const char* refusal = "'K_t1_Nm_per_A' cannot be determined";
    CHECK(contains(calibrate(table({100}, {0, 0, 0, 0, 0, 0})).error, refusal));
    CHECK(contains(calibrate(table({100}, {3, 3, 3, 3, 3, 3})).error, refusal));
    CHECK(contains(calibrate(table({100}, {3})).error, "1 rows with a known torque; expected at least 4"));
}

TEST(SpindleCalibration, with_one_speed_says_what_it_cannot_see) {
    const Run run = calibrate(table({100}, {0, 0, 2, 4, 6, 8}));
    LONGS_EQUAL(0, run.code);
    CHECK(contains(run.text, "one speed only"));
    CHECK(!run.toml["spindle"].as_table()->contains("idle_torque_slope_Nm_s_se"));
}

TEST(SpindleCalibration, names_what_is_missing_in_the_file) {
    CHECK(contains(calibrate("spindle_current_A,spindle_speed_rad_s\n").error,
                   ":1: no column 'spindle_torque_Nm', the known torque of each row"));
    CHECK(contains(calibrate("spindle_current_A,spindle_torque_Nm\n").error, "no column 'spindle_speed_rad_s'"));
    CHECK(contains(calibrate("spindle_current_A,spindle_torque_Nm,spindle_angle_rad\n").error, "no column 'time_s'"));
    CHECK(contains(calibrate("spindle_current_A,spindle_torque_Nm,spindle_speed_rad_s\n1,2,-5\n").error,
                   ":2: column 'spindle_speed_rad_s': '-5' is out of range"));
}
