// SPDX-License-Identifier: Apache-2.0
#include "calibration/spindle_calibration.hpp"
#include "files/input_error.hpp"
#include "firmware/program/calibration/scaled_column.hpp"
#include "temporary_folder.hpp"

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

    bool has(const char* key) const { return toml["spindle"].as_table()->contains(key); }
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

/// What is wrong with a table.
struct Wrong {
    double current_scale = 1.0;
    double speed_scale = 1.0;
    double torque_scale = 1.0;
    int outlier_every = 0;  ///< this row, and so on, has another current
    double outlier_A = 0.0;
};

/// One row per cut: K_t1 1.4 N·m/A up to 157 rad/s, K_t2 −0.6 N·m, idle slope 0.002 N·m·s.
std::string table(const std::vector<double>& speeds, const std::vector<double>& torques, const Wrong& wrong = {}) {
    std::mt19937 generator(4);
    std::normal_distribution<double> normal(0.0, 0.03);
    std::ostringstream text;
    text << "spindle_speed_rad_s,spindle_torque_Nm,spindle_current_A\n";
    int row = 0;
    for (const double speed : speeds) {
        for (const double torque : torques) {
            const double gain = 1.4 * std::min(1.0, 157.0 / speed);
            const bool is_outlier = wrong.outlier_every > 0 && ++row % wrong.outlier_every == 0;
            const double current = is_outlier ? wrong.outlier_A : (torque + 0.6 + 0.002 * speed) / gain;
            text << speed * wrong.speed_scale << ',' << (torque + normal(generator)) * wrong.torque_scale << ','
                 << current * wrong.current_scale << '\n';
        }
        text << speed << ",,1.0\n";  // a row whose torque is not known
    }
    return text.str();
}

struct RecordingOptions {
    double acceleration_sign = 1.0;
    double angle_scale = 1.0;
    int spike_every = 0;
    double spike_A = 0.0;
};

/// 40 s at 200 Hz, run-ups all the time, idle and 5 N·m in turn.
std::string recording(const RecordingOptions& options) {
    std::ostringstream text;
    text.precision(10);
    text << "time_s,spindle_angle_rad,spindle_current_A,spindle_torque_Nm\n";
    std::mt19937 generator(6);
    std::normal_distribution<double> normal(0.0, 0.05);
    double angle = 0.0;
    for (int k = 0; k < 8000; ++k) {
        const double t = 0.005 * k;
        const double speed = 100.0 + 30.0 * std::sin(0.9 * t);
        const double acceleration = 27.0 * std::cos(0.9 * t) * options.acceleration_sign;
        const double torque = std::fmod(t, 10.0) < 5.0 ? 0.0 : 5.0;
        const bool is_spike = options.spike_every > 0 && (k + 1) % options.spike_every == 0;
        angle = std::fmod(angle + speed * 0.005, 2.0 * std::numbers::pi);
        text << t << ',' << angle * options.angle_scale << ','
             << (torque + 0.6 + 0.002 * speed + 0.02 * acceleration) / 1.4 + normal(generator) +
                    (is_spike ? options.spike_A : 0.0)
             << ',' << torque << '\n';
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
    CHECK(!run.has("inertia_kg_m2"));  // without acceleration nothing is known of it
}

TEST(SpindleCalibration, of_a_recording_with_run_ups_finds_the_inertia_from_the_angle) {
    const Run run = calibrate(recording({}));
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

TEST(SpindleCalibration, leaves_out_outliers_and_names_their_rows) {
    std::vector<double> torques;
    for (int k = 0; k < 20; ++k) {
        torques.insert(torques.end(), {0, 1, 2, 4, 6, 8});
    }
    for (const double outlier_A : {40.0, -15.0, 0.0}) {
        const Run run = calibrate(table({60, 90, 120}, torques, {.outlier_every = 50, .outlier_A = outlier_A}));
        STRCMP_EQUAL("", run.error.c_str());
        run.within("K_t1_Nm_per_A", 1.4);
        run.within("K_t2_Nm", -0.6);
        run.within("idle_torque_slope_Nm_s", 0.002);
        CHECK(run.value("K_t1_Nm_per_A_se") < 0.002);
        CHECK(contains(run.text, "rows are outliers"));
        CHECK(contains(run.text, "spindle.csv:51, spindle.csv:101"));
    }
    CHECK(!contains(calibrate(table({60, 90, 120}, torques)).text, "outliers"));
}

TEST(SpindleCalibration, replaces_spikes_of_a_recording_before_the_low_pass_smears_them) {
    const Run clean = calibrate(recording({}));
    const Run spiky = calibrate(recording({.spike_every = 50, .spike_A = 60.0}));
    STRCMP_EQUAL("", spiky.error.c_str());
    DOUBLES_EQUAL(1.4, spiky.value("K_t1_Nm_per_A"), 0.02);
    DOUBLES_EQUAL(0.02, spiky.value("inertia_kg_m2"), 0.0006);
    CHECK(contains(spiky.text, "160 spikes of the current were replaced: spindle.csv:51"));
    CHECK(!contains(clean.text, "spikes"));
}

TEST(SpindleCalibration, counts_a_repeated_row_once_and_says_so) {
    const std::string rows = table({60, 90, 120}, {0, 1, 2, 4, 6, 8});
    const std::string only_rows = rows.substr(rows.find('\n') + 1);
    const Run once = calibrate(rows);
    const Run twice = calibrate(rows + only_rows);
    DOUBLES_EQUAL(once.value("K_t1_Nm_per_A_se"), twice.value("K_t1_Nm_per_A_se"), 0.0);
    CHECK(contains(twice.text, "repeat an earlier row exactly and are not counted again"));
}

TEST(SpindleCalibration, refuses_reversed_signs_by_name) {
    const std::vector<double> torques{0, 1, 2, 4, 6, 8};
    CHECK(contains(calibrate(table({60, 90, 120}, torques, {.current_scale = -1.0})).error,
                   "the current falls as the torque rises"));
    CHECK(contains(calibrate(table({60, 90, 120}, torques, {.current_scale = -1.0, .torque_scale = -1.0})).error,
                   "are current and torque both reversed?"));
    CHECK(contains(calibrate(recording({.acceleration_sign = -1.0})).error, "sign of the acceleration reversed?"));
}

TEST(SpindleCalibration, refuses_other_units_by_name) {
    const std::vector<double> torques{0, 1, 2, 4, 6, 8};
    CHECK(contains(calibrate(table({60, 90, 120}, torques, {.current_scale = 1000.0})).error, "in mA?"));
    CHECK(contains(calibrate(table({60, 90, 120}, torques, {.current_scale = 100.0, .torque_scale = 0.1})).error,
                   "'K_t1_Nm_per_A' = 0.0014"));
    CHECK(contains(calibrate(table({120}, {0, 10, 20, 40, 60}, {.speed_scale = 50.0})).error,
                   "spindle_speed_rad_s in 1/min"));
    CHECK(contains(calibrate(recording({.angle_scale = 180.0 / std::numbers::pi})).error,
                   "column 'spindle_angle_rad': "));
    CHECK(contains(calibrate(recording({.angle_scale = 180.0 / std::numbers::pi})).error, "is it in degrees?"));
}

TEST(SpindleCalibration, warns_of_a_speed_that_only_few_spindles_have) {
    const Run fast = calibrate(table({60, 90, 120}, {0, 0.1, 0.2, 0.3, 0.4, 0.5}, {.speed_scale = 30.0}));
    CHECK(contains(fast.text, "warning: the spindle turns at up to 3600 rad/s, 34377.5 1/min; is its speed in 1/min"));
    LONGS_EQUAL(1, fast.code);
    const Run usual = calibrate(table({60, 90, 120}, {0, 1, 2, 4, 6, 8}));
    CHECK(!contains(usual.text, "warning"));
    LONGS_EQUAL(0, usual.code);
}

TEST(SpindleCalibration, warns_of_round_speeds_that_are_chosen_in_1_per_min) {
    const std::vector<double> torques{0, 1, 2, 4, 6, 8};
    const Run round = calibrate(table({600, 850, 1200}, torques));
    CHECK(contains(round.text,
                   "warning: each speed is a multiple of 50, up to 1200 rad/s, which is 11459.2 1/min; is "
                   "spindle_speed_rad_s in 1/min?"));
    LONGS_EQUAL(1, round.code);
    CHECK(!contains(calibrate(table({600, 850, 1210}, torques)).text, "warning"));
}

TEST(SpindleCalibration, refuses_a_torque_in_N_cm_by_the_power_that_no_drive_gives_for_an_ampere) {
    const std::string sound = table({60, 90, 120}, {0, 1, 2, 4, 6, 8});
    const std::string error = calibrate(scaled(sound, "spindle_torque_Nm", 100.0)).error;
    CHECK(contains(error, "column 'spindle_torque_Nm': 801.97 N·m at 120 rad/s and 6.314 A are 1.524e+04 W"));
    CHECK(contains(error, "W for each ampere; expected at most 2400 W, as from 690 V; is it in N·cm or N·mm"));
    CHECK(contains(calibrate(scaled(recording({}), "spindle_torque_Nm", 100.0)).error, "is it in N·cm or N·mm"));
}

TEST(SpindleCalibration, asks_about_a_torque_in_N_cm_of_a_spindle_with_less_than_24_V) {
    const std::string sound = table({10, 15}, {0, 1, 2, 4, 6, 8});
    const Run run = calibrate(scaled(sound, "spindle_torque_Nm", 100.0));
    LONGS_EQUAL(1, run.code);
    CHECK(contains(run.text, "warning: the drive gives"));
    CHECK(contains(run.text, "is spindle_torque_Nm in N·cm"));
}

TEST(SpindleCalibration, refuses_a_torque_in_kN_m_by_a_motor_of_less_than_a_volt) {
    const std::string sound = table({60, 90, 120}, {0, 1, 2, 4, 6, 8}, {.current_scale = 0.3});
    CHECK(contains(calibrate(scaled(sound, "spindle_torque_Nm", 1e-3)).error,
                   "expected at least 1 W, or the motor takes less than a volt; is it in kN·m"));
}

TEST(SpindleCalibration, asks_about_a_speed_in_1_per_s_by_the_voltage_at_which_the_field_is_weakened) {
    const std::string sound = table({60, 90, 120, 220, 300, 400}, {0, 0, 2, 4, 6, 8});
    LONGS_EQUAL(0, calibrate(sound).code);
    const Run run = calibrate(scaled(sound, "spindle_speed_rad_s", 0.5 / std::numbers::pi));
    LONGS_EQUAL(1, run.code);
    CHECK(contains(run.text, "warning: the field is weakened above 24.9"));
    CHECK(contains(run.text, "is the speed in 1/s, or the angle in revolutions?"));
}

TEST(SpindleCalibration, asks_about_a_speed_in_1_per_s_by_the_voltage_of_the_fastest_cut) {
    const std::string sound = table({60, 90, 120}, {0, 1, 2, 4, 6, 8});
    const Run run = calibrate(scaled(sound, "spindle_speed_rad_s", 0.5 / std::numbers::pi));
    LONGS_EQUAL(1, run.code);
    CHECK(contains(run.text, "warning: the spindle turns at up to 19.1 rad/s, 182.38 1/min, and gives at most 2"));
}

TEST(SpindleCalibration, asks_about_a_speed_that_is_round_only_in_1_per_s) {
    const Run run = calibrate(table({16.67, 33.33, 133.33}, {0, 1, 2, 4, 6, 8}));
    LONGS_EQUAL(1, run.code);
    CHECK(
        contains(run.text, "warning: only in 1/s is each speed a multiple of 50 1/min, 133.33 1/s being 7999.8 1/min"));
    CHECK(!contains(calibrate(table({16.67, 33.33, 134.3}, {0, 1, 2, 4, 6, 8})).text, "warning"));
    CHECK(!contains(calibrate(table({104.7, 209.4, 523.6}, {0, 1, 2, 4, 6, 8})).text, "warning"));  // 1/min
}

TEST(SpindleCalibration, refuses_an_angle_in_revolutions_and_a_time_in_ms) {
    CHECK(contains(calibrate(recording({.angle_scale = 0.5 / std::numbers::pi})).error,
                   "column 'spindle_angle_rad': it begins again at 1; expected rad, which begin again at 6.283 or go "
                   "on; is it in revolutions?"));
    CHECK(contains(calibrate(scaled(recording({}), "time_s", 1000.0)).error,
                   "the spindle turns at 0.13 rad/s, 1.241 1/min; expected 5 to 20000 rad/s; is spindle_angle_rad in "
                   "revolutions, or time_s in ms?"));
}

TEST(SpindleCalibration, leaves_out_a_term_that_is_smaller_than_its_error) {
    std::mt19937 generator(11);
    std::normal_distribution<double> normal(0.0, 0.05);
    std::ostringstream text;
    text << "spindle_speed_rad_s,spindle_torque_Nm,spindle_current_A\n";
    for (int k = 0; k < 40; ++k) {  // the idle current was taken off
        text << 100 + 20 * (k % 3) << ',' << k % 8 << ',' << (k % 8 + normal(generator)) / 1.4 << '\n';
    }
    const Run run = calibrate(text.str());
    STRCMP_EQUAL("", run.error.c_str());
    for (const char* key : {"K_t2_Nm", "idle_torque_slope_Nm_s"}) {
        CHECK(!run.has(key));
        CHECK(contains(run.text, key));
    }
    CHECK(contains(run.text, "not determined by these data"));
    run.within("K_t1_Nm_per_A", 1.4);
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

TEST(SpindleCalibration, names_the_row_of_a_recording_that_does_not_fit) {
    const std::string header = "time_s,spindle_angle_rad,spindle_current_A,spindle_torque_Nm\n";
    CHECK(contains(calibrate(header + "0,0,1,1\n0,1,1,1\n").error,
                   "spindle.csv:3: column 'time_s': 0 s after 0 s; expected time to grow"));
    CHECK(contains(calibrate(header + "0,0,1,1\n0.01,1,,1\n").error, "spindle.csv:3: column 'spindle_current_A'"));
    CHECK(contains(calibrate(header + "0,0,1,1\n0.01,1,1,1\n").error,
                   "2 rows with 'spindle_angle_rad'; expected at least 20"));
    std::string uneven = header;
    for (int k = 0; k < 40; ++k) {
        uneven += std::to_string(0.01 * k + (k == 30 ? 0.004 : 0.0)) + "," + std::to_string(k) + ",1,1\n";
    }
    CHECK(contains(calibrate(uneven).error, "column 'time_s': uneven step of"));
    CHECK(contains(calibrate("spindle_current_A,spindle_torque_Nm\n1,1\n").error, "nor 'spindle_angle_rad'"));
}

TEST(SpindleCalibration, of_a_recording_leaves_out_where_the_torque_is_not_known) {
    std::string text = recording({});
    std::size_t row = 0;
    std::string with_gaps;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line); ++row) {
        const bool is_gap = row > 0 && row % 2000 < 400;  // the first rows, too
        with_gaps += (is_gap ? line.substr(0, line.rfind(',') + 1) : line) + "\n";
    }
    const Run run = calibrate(with_gaps);
    STRCMP_EQUAL("", run.error.c_str());
    DOUBLES_EQUAL(1.4, run.value("K_t1_Nm_per_A"), 0.02);
    DOUBLES_EQUAL(0.02, run.value("inertia_kg_m2"), 0.0006);
}

TEST(SpindleCalibration, of_a_table_takes_the_acceleration_from_its_column) {
    std::ostringstream text;
    text << "spindle_speed_rad_s,spindle_torque_Nm,spindle_current_A,spindle_acceleration_rad_s2\n";
    for (int k = 0; k < 60; ++k) {
        const double speed = 60.0 + 20.0 * (k % 3);
        const double torque = 2.0 * (k % 4);
        const double acceleration = 30.0 * (k % 5 - 2);
        const double ripple = 0.002 * (k % 7 - 3);
        text << speed << ',' << torque << ',' << (torque + 0.6 + 0.002 * speed + 0.02 * acceleration) / 1.4 + ripple
             << ',' << acceleration << '\n';
    }
    const Run run = calibrate(text.str());
    STRCMP_EQUAL("", run.error.c_str());
    DOUBLES_EQUAL(0.02, run.value("inertia_kg_m2"), 0.001);
}
