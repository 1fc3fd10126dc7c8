// SPDX-License-Identifier: Apache-2.0
#include "calibration/friction_calibration.hpp"
#include "calibration/axis_motion.hpp"
#include "estimation_calibration/friction_fit.hpp"
#include "files/input_error.hpp"
#include "firmware/program/calibration/scaled_column.hpp"
#include "temporary_folder.hpp"

#include <toml++/toml.h>  // before CppUTest, which makes `new` a macro

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <random>
#include <sstream>

using namespace millforce::host;
using namespace millforce::test;

namespace {

const std::filesystem::path measured_axis = MILLFORCE_TEST_DATA "/ball_screw_axis_200hz.csv";

struct Run {
    int code = -1;
    std::string text;
    std::string error;
    toml::table toml;
};

Run calibrate(const std::vector<std::filesystem::path>& data, std::optional<double> force_constant_N_per_A = {}) {
    const TemporaryFolder folder;
    FrictionCalibrationOptions options;
    options.data = data;
    options.output = folder.path("out.toml");
    options.force_constant_N_per_A = force_constant_N_per_A;
    Run run;
    std::ostringstream out;
    run.error = message_of<InputError>([&] { run.code = calibrate_friction(options, out); });
    run.text = out.str();
    if (run.error.empty()) {
        run.toml = toml::parse(folder.read("out.toml"));
    } else {
        LONGS_EQUAL(0, folder.file_count());
    }
    return run;
}

double value(const Run& run, const char* axis, const char* key) {
    return run.toml[axis][key].value_or(std::nan(""));
}

/// What an axis in air does besides the usual.
struct AirAxis {
    double current_scale = 1.0;
    double velocity_scale = 1.0;
    double drift = 0.0;  ///< how much of its friction it has lost at the end
    double quadratic = 0.012;
};

/// A recording of air cuts: each feed of `feeds_mm_s` for half a second, with ramps between, at 200 Hz.
std::string recording(const std::vector<double>& feeds_mm_s, double noise_A, const AirAxis& air = {}) {
    std::mt19937 generator(9);
    std::normal_distribution<double> normal;
    std::ostringstream text;
    text << "x_current_A,time_s,x_velocity_mm_s,y_velocity_mm_s,y_current_A\n";
    double time_s = 0.0;
    const auto row = [&](double v, double acceleration) {
        const double w = 0.06 * v;
        const double size = std::abs(w);
        const double kept = 1.0 - air.drift * time_s / (0.7 * static_cast<double>(feeds_mm_s.size()));
        const double friction = v == 0.0 ? 0.0 : kept * (air.quadratic * w * w + 0.09 * size + 1.9);
        const double current =
            -0.4 + (w > 0.0 ? friction : -friction) + 0.01 * acceleration + noise_A * normal(generator);
        text << current * air.current_scale << ',' << time_s << ','
             << (v + 0.02 * normal(generator)) * air.velocity_scale << ",0,0.3\n";
        time_s += 0.005;
    };
    double last = 0.0;
    for (const double feed : feeds_mm_s) {
        for (int k = 0; k < 40; ++k) {
            row(last + (feed - last) * k / 40.0, (feed - last) / 0.2);
        }
        for (int k = 0; k < 100; ++k) {
            row(feed, 0.0);
        }
        last = feed;
    }
    return text.str();
}

}  // namespace

TEST_GROUP(FrictionCalibration){};

TEST(FrictionCalibration, of_the_measured_axis_gives_the_published_mass_and_friction) {
    const Run run = calibrate({measured_axis});
    LONGS_EQUAL(0, run.code);
    DOUBLES_EQUAL(95.11, value(run, "x", "mass_kg"), 0.01 * 95.11);
    DOUBLES_EQUAL(203.5, value(run, "x", "viscous_N_s_per_m"), 0.03 * 203.5);
    DOUBLES_EQUAL(20.39, value(run, "x", "coulomb_N"), 0.03 * 20.39);
    DOUBLES_EQUAL(-3.16, value(run, "x", "offset_N"), 0.03 * 3.16);
    CHECK(value(run, "x", "residual_rms_N") < 3.0);
    CHECK(value(run, "x", "residual_rms_N") > 1.0);  // an axis that is too quiet was not measured
    CHECK(contains(run.text, "phantom force in the second"));
}

TEST(FrictionCalibration, sees_that_viscous_friction_of_the_measured_axis_differs_by_direction) {
    const Run run = calibrate({measured_axis});
    const double difference =
        value(run, "x", "negative_viscous_N_s_per_m") - value(run, "x", "positive_viscous_N_s_per_m");
    const double error =
        std::hypot(value(run, "x", "negative_viscous_N_s_per_m_se"), value(run, "x", "positive_viscous_N_s_per_m_se"));
    CHECK(difference > 5.0 * error);
}

TEST(FrictionCalibration, of_a_motion_with_the_motors_force_constant_gives_what_the_controller_uses) {
    STRCMP_CONTAINS("the controller does not use friction in newtons", calibrate({measured_axis}).text.c_str());
    const Run run = calibrate({measured_axis}, 50.0);
    const auto force_N = [&](double velocity_m_s) {
        const bool forward = velocity_m_s > 0.0;
        const double w = 60.0 * std::abs(velocity_m_s);
        const double friction_A =
            value(run, "x", forward ? "K_x2_positive_A_min_per_m" : "K_x2_negative_A_min_per_m") * w +
            value(run, "x", "K_x3_A");
        return value(run, "x", "K_x4_N_per_A") * (value(run, "x", "gravity_A") + (forward ? friction_A : -friction_A));
    };
    DOUBLES_EQUAL(value(run, "x", "positive_viscous_N_s_per_m") * 0.1 + value(run, "x", "positive_coulomb_N"),
                  force_N(0.1), 1e-6);
    DOUBLES_EQUAL(-value(run, "x", "negative_viscous_N_s_per_m") * 0.1 - value(run, "x", "negative_coulomb_N"),
                  force_N(-0.1), 1e-6);
}

TEST(FrictionCalibration, on_the_first_half_of_the_measured_axis_sees_no_cutting_force_in_the_second) {
    const AxisMotion motion = read_axis_motion(measured_axis, 20.0);
    const std::size_t n = motion.velocity_m_s.size();
    millforce::estimation::MechanicalFrictionFit fit(0.002);
    for (std::size_t k = 0; k < n / 2; ++k) {
        fit.add(motion.velocity_m_s[k], motion.acceleration_m_s2[k], motion.motor_force_N[k]);
    }
    const auto friction = millforce::estimation::directional_friction(fit.directional());
    double sum = 0.0;
    int count = 0;
    for (std::size_t k = n / 2; k < n; ++k) {
        if (std::abs(motion.velocity_m_s[k]) > 0.002) {
            const double phantom =
                motion.motor_force_N[k] - friction.force_N(motion.velocity_m_s[k], motion.acceleration_m_s2[k]);
            sum += phantom * phantom;
            ++count;
        }
    }
    const double rms = std::sqrt(sum / count);
    CHECK(rms < 3.5);
    CHECK(rms > 0.5);
    CHECK(count > 2000);
}

TEST(FrictionCalibration, of_a_recording_in_air_gives_the_quadratic_current_by_direction_and_gravity) {
    const TemporaryFolder folder;
    const Run run = calibrate({folder.write(
        "air.csv", recording({10, 30, 60, 100, 150, -10, -30, -60, -100, -150, 10, -10, 30, -30, 60, -60}, 0.05))});
    STRCMP_EQUAL("", run.error.c_str());
    LONGS_EQUAL(0, run.code);
    const auto within = [&](const char* key, double truth) {
        const double error = value(run, "x", (std::string(key) + "_se").c_str());
        DOUBLES_EQUAL(truth, value(run, "x", key), 3.0 * error);
        CHECK(error < 0.05 * std::abs(truth) + 0.01);
    };
    within("K_x1_positive_A_min2_per_m2", 0.012);
    within("K_x2_positive_A_min_per_m", 0.09);
    within("K_x1_negative_A_min2_per_m2", 0.012);
    within("K_x2_negative_A_min_per_m", 0.09);
    within("K_x3_A", 1.9);
    within("gravity_A", -0.4);
    CHECK(!run.toml.contains("y"));  // it stood still
    CHECK(
        contains(run.text, "y: left out: no steady feed faster than 2 mm/s; if it moved, is y_velocity_mm_s in m/s?"));
}

TEST(FrictionCalibration, refuses_a_recording_that_lacks_feeds_or_a_direction_and_says_which) {
    const TemporaryFolder folder;
    const auto error = [&](const std::vector<double>& feeds) {
        return calibrate({folder.write("air.csv", recording(feeds, 0.05))}).error;
    };
    CHECK(contains(error({20, -20, 20, -20, 20, -20, 20, -20}),
                   "'x.K_x1_positive_A_min2_per_m2' cannot be determined: 1 steady feed(s) in air in +x"));
    CHECK(contains(error({20, 40, 60, 80, -20, -20, -40}), "K_x1_negative_A_min2_per_m2"));
    CHECK(contains(error({20, 40, 60, 80, 100, 120, 140}),
                   "'x.gravity_A' cannot be separated from K_x3_A: no steady "
                   "travel in air in -x"));
    CHECK(contains(error({0, 0, 0}), "'K_x1' to 'K_x3' cannot be determined"));
}

TEST(FrictionCalibration, refuses_a_motion_at_rest_in_one_direction_or_without_acceleration) {
    const TemporaryFolder folder;
    std::mt19937 generator(3);
    std::normal_distribution<double> normal;
    const auto error = [&](auto position) {
        std::ostringstream text;
        text.precision(12);
        text << "time_s,position_m,motor_force_N\n";
        for (int k = 0; k < 2000; ++k) {
            const double t = 0.005 * k;
            text << t << ',' << position(t) << ',' << 20.0 + normal(generator) << '\n';
        }
        return calibrate({folder.write("axis.csv", text.str())}).error;
    };
    CHECK(contains(error([](double) { return 0.1; }), "'coulomb_N' cannot be determined: the axis is never faster"));
    CHECK(contains(error([](double t) { return 0.1 * t + 0.01 * std::sin(3.0 * t); }), "'negative_coulomb_N' cannot"));
    CHECK(contains(error([](double t) { return 0.1 * std::abs(std::fmod(t, 4.0) - 2.0); }), "cannot be determined"));
}

TEST(FrictionCalibration, leaves_out_of_fit_and_file_what_the_feeds_do_not_determine) {
    const TemporaryFolder folder;
    // 0.36 to 0.58 m/min: on so short a piece a parabola cannot be distinguished from a line.
    int left_out = 0;
    for (const std::vector<double>& feeds : {std::vector<double>{6.0, -6.0, 7.8, -7.8, 9.7, -9.7, 6.0, -6.0, 9.7, -9.7},
                                             {6.0, 7.8, 9.7, -6.0, -7.8, -9.7, 6.0, 9.7, -6.0, -9.7},
                                             {9.7, 7.8, 6.0, -9.7, -7.8, -6.0, 7.8, -7.8, 6.0, -6.0}}) {
        const Run run = calibrate({folder.write("air.csv", recording(feeds, 0.05))});
        STRCMP_EQUAL("", run.error.c_str());
        const auto& table = *run.toml["x"].as_table();
        for (const char* key : {"K_x1_positive_A_min2_per_m2", "K_x2_positive_A_min_per_m",
                                "K_x1_negative_A_min2_per_m2", "K_x2_negative_A_min_per_m", "K_x3_A", "gravity_A"}) {
            CHECK(contains(run.text, key));
            if (table.contains(key)) {
                CHECK(value(run, "x", (std::string(key) + "_se").c_str()) < std::abs(value(run, "x", key)));
            } else {
                CHECK(!table.contains(std::string(key) + "_se"));
                CHECK(contains(run.text, "not determined by these data; fitted without it, not written"));
                ++left_out;
            }
        }
        const auto or_none = [&](const char* key) { return table.contains(key) ? value(run, "x", key) : 0.0; };
        const double far_beyond_A = 9.0 * or_none("K_x1_positive_A_min2_per_m2") +
                                    3.0 * or_none("K_x2_positive_A_min_per_m") + or_none("K_x3_A");
        DOUBLES_EQUAL(0.012 * 9.0 + 0.09 * 3.0 + 1.9, far_beyond_A, 0.5);
    }
    CHECK(left_out >= 3);
}

TEST(FrictionCalibration, writes_from_which_feeds_it_is_and_what_they_leave_open_beyond) {
    const TemporaryFolder folder;
    const std::vector<double> feeds{6.0, -6.0, 7.8, -7.8, 9.7, -9.7, 6.0, -6.0, 9.7, -9.7};
    const Run run = calibrate({folder.write("air.csv", recording(feeds, 0.05))});
    DOUBLES_EQUAL(0.36, value(run, "x", "friction_speed_min_m_per_min"), 0.002);
    DOUBLES_EQUAL(0.582, value(run, "x", "friction_speed_max_m_per_min"), 0.002);
    CHECK(value(run, "x", "K_x1_sd_A_min2_per_m2") > 0.1);
    CHECK(contains(run.text, "known from 0.36 to 0.582 m/min"));
    const Run wide = calibrate({folder.write(
        "wide.csv", recording({10.0, -10.0, 50.0, -50.0, 200.0, -200.0, 10.0, -10.0, 200.0, -200.0}, 0.05))});
    CHECK(value(wide, "x", "K_x1_sd_A_min2_per_m2") < 0.01);
}

TEST(FrictionCalibration, refuses_a_recording_with_reversed_current_or_in_other_units) {
    const TemporaryFolder folder;
    const std::vector<double> feeds{10, 30, 60, -10, -30, -60, 10, -10, 30, -30};
    const auto error = [&](const AirAxis& air) {
        return calibrate({folder.write("air.csv", recording(feeds, 0.05, air))}).error;
    };
    CHECK(contains(error({.current_scale = -1.0}), "x: the current is opposite to the motion: -2."));
    CHECK(contains(error({.velocity_scale = -1.0}), "x: the current is opposite to the motion: -2."));
    CHECK(contains(error({.current_scale = 1000.0}), "is x_current_A in mA?"));
    CHECK(contains(error({.velocity_scale = 60.0}), "column 'x_velocity_mm_s': "));
    CHECK(contains(error({.velocity_scale = 60.0}), "is it in mm/min?"));
}

TEST(FrictionCalibration, asks_about_a_velocity_in_mm_per_min_of_a_slow_axis) {
    const TemporaryFolder folder;
    const auto run = [&](const std::vector<double>& feeds, double scale) {
        return calibrate({folder.write("air.csv", recording(feeds, 0.05, {.velocity_scale = scale}))});
    };
    const std::vector<double> slow{2, 5, 10, 20, -2, -5, -10, -20, 10, -10};
    LONGS_EQUAL(0, run(slow, 1.0).code);
    const Run fast = run(slow, 60.0);
    LONGS_EQUAL(1, fast.code);
    CHECK(contains(fast.text, "warning: x moves at up to 12"));
    CHECK(contains(fast.text, "mm/s; usual are 1000 mm/s (60 m/min) or less; is x_velocity_mm_s in mm/min?"));
}

TEST(FrictionCalibration, asks_about_a_velocity_in_m_per_min_by_an_axis_that_hardly_accelerates) {
    const TemporaryFolder folder;
    const std::vector<double> feeds{40, 60, 80, 100, 60, -40, -60, -80, -100, -60};
    const Run run = calibrate({folder.write("air.csv", recording(feeds, 0.05, {.velocity_scale = 0.06}))});
    STRCMP_EQUAL("", run.error.c_str());
    LONGS_EQUAL(1, run.code);
    CHECK(contains(run.text, "warning: x never accelerates by more than 0.0"));
    CHECK(contains(run.text, "is x_velocity_mm_s in m/min or m/s, or time_s in ms?"));
}

TEST(FrictionCalibration, refuses_a_time_in_ms_by_a_travel_that_no_axis_has) {
    const TemporaryFolder folder;
    const std::string sound = recording({10, 30, 60, -10, -30, -60, 10, -10, 30, -30}, 0.05);
    CHECK(contains(calibrate({folder.write("air.csv", scaled(sound, "time_s", 1000.0))}).error,
                   "air.csv: column 'time_s': 5 s from sample to sample, in which x travels 2"));
    CHECK(contains(calibrate({folder.write("axis.csv", scaled(text_of_file(measured_axis), "time_s", 1000.0))}).error,
                   "axis.csv: column 'time_s': 5 s from sample to sample; expected at most 0.2 s; is it in ms?"));
}

TEST(FrictionCalibration, asks_about_a_current_in_mA_of_an_axis_with_little_friction) {
    const TemporaryFolder folder;
    const std::vector<double> feeds{10, 30, 60, -10, -30, -60, 10, -10, 30, -30};
    const Run run = calibrate({folder.write("air.csv", recording(feeds, 0.05, {.current_scale = 20.0}))});
    LONGS_EQUAL(1, run.code);
    CHECK(contains(run.text, "A of friction on average; usual is less than 20 A; is x_current_A in mA?"));
}

TEST(FrictionCalibration, of_a_force_in_another_unit_is_seen_by_the_mass_that_it_means) {
    const TemporaryFolder folder;
    const auto in_unit = [&](double factor) {
        return calibrate({folder.write("axis.csv", scaled(text_of_file(measured_axis), "motor_force_N", factor))});
    };
    CHECK(contains(in_unit(1e-3).error, "'mass_kg' = 0.09503; expected 0.2 to 200000; is motor_force_N in kN"));
    const Run mN = in_unit(1e3);
    LONGS_EQUAL(1, mN.code);
    CHECK(contains(mN.text, "usual are 5 to 20000 kg; is motor_force_N in mN"));
}

TEST(FrictionCalibration, of_a_recording_whose_friction_drifts_is_a_broken_bound) {
    const TemporaryFolder folder;
    std::vector<double> sweeps;
    for (int k = 0; k < 3; ++k) {
        sweeps.insert(sweeps.end(), {10, -10, 30, -30, 60, -60, 100, -100});
    }
    const Run drifts = calibrate({folder.write("warming.csv", recording(sweeps, 0.05, {.drift = 0.3}))});
    LONGS_EQUAL(1, drifts.code);
    CHECK(contains(drifts.text, "BROKEN: the friction changed"));
    const Run keeps = calibrate({folder.write("warm.csv", recording(sweeps, 0.05))});
    LONGS_EQUAL(0, keeps.code);
    CHECK(contains(keeps.text, "bound 10 %: holds"));
}

TEST(FrictionCalibration, does_not_judge_a_drift_that_the_feeds_hide) {
    const TemporaryFolder folder;
    const Run run =
        calibrate({folder.write("air.csv", recording({10, -10, 30, -30, 60, -60, 100, -100}, 1.0, {.drift = 0.1}))});
    LONGS_EQUAL(0, run.code);
    CHECK(contains(run.text, "cannot tell"));
}

TEST(FrictionCalibration, counts_a_recording_that_is_given_twice_once) {
    const TemporaryFolder folder;
    const std::vector<double> feeds{10, 30, 60, 100, -10, -30, -60, -100, 10, -10};
    const auto air = folder.write("air.csv", recording(feeds, 0.05));
    const Run once = calibrate({air});
    const Run twice = calibrate({air, air});
    DOUBLES_EQUAL(value(once, "x", "K_x3_A_se"), value(twice, "x", "K_x3_A_se"), 0.0);
    CHECK(contains(twice.text, "10 steady feeds repeat earlier ones exactly"));
}

TEST(FrictionCalibration, names_the_line_of_an_uneven_step_and_of_a_bad_cell) {
    const TemporaryFolder folder;
    std::string text = "time_s,position_m,motor_force_N\n";
    for (int k = 0; k < 30; ++k) {
        text += std::to_string(0.005 * (k + (k > 20 ? 1 : 0))) + ",0,0\n";
    }
    CHECK(contains(calibrate({folder.write("a.csv", text)}).error, "a.csv:3: column 'time_s'"));
    CHECK(contains(calibrate({folder.write("b.csv", "time_s,position_m\n0,0\n")}).error,
                   "b.csv:1: no column 'motor_force_N'"));
    CHECK(contains(calibrate({folder.write("c.csv", "time_s,position_m,motor_force_N\n0,,1\n")}).error,
                   "c.csv:2: column 'position_m': the cell is empty"));
    CHECK(contains(calibrate({measured_axis, folder.write("d.csv", recording({10}, 0.0))}).error, "of another kind"));
}

namespace {

/// An axis to and fro: 90 kg, 20 N and 50 N·s/m.
struct Motion {
    double seconds = 12.0;
    double force_sign = 1.0;
    double mass_kg = 90.0;
    double later_friction = 1.0;  ///< in the second half
    double noise_N = 1.0;
    double position_scale = 1.0;
    double still_until = 0.0;  ///< share of the time
};

std::string motion(const Motion& m) {
    std::mt19937 generator(8);
    std::normal_distribution<double> normal(0.0, m.noise_N);
    std::ostringstream text;
    text.precision(12);
    text << "time_s,position_m,motor_force_N\n";
    const int rows = static_cast<int>(m.seconds * 200.0);
    for (int k = 0; k < rows; ++k) {
        const bool still = k < m.still_until * rows;
        const double t = 0.005 * k;
        const double phase = still ? 0.0 : 3.0 * (t - 0.005 * m.still_until * rows);
        const double v = still ? 0.0 : 0.3 * std::sin(phase);
        const double a = still ? 0.0 : 0.9 * std::cos(phase);
        const double friction = (20.0 + 50.0 * std::abs(v)) * (2 * k < rows ? 1.0 : m.later_friction);
        text << t << ',' << 0.1 * (1.0 - std::cos(phase)) * m.position_scale << ','
             << m.force_sign * (m.mass_kg * a + (still ? 0.0 : std::copysign(friction, v))) + normal(generator) << '\n';
    }
    return text.str();
}

}  // namespace

TEST_GROUP(MotionFriction){};

TEST(MotionFriction, refuses_a_force_opposite_to_the_motion_or_to_the_acceleration) {
    const TemporaryFolder folder;
    CHECK(contains(calibrate({folder.write("a.csv", motion({.force_sign = -1.0}))}).error,
                   "the motor's force is opposite to the motion: -"));
    CHECK(contains(calibrate({folder.write("b.csv", motion({.position_scale = -1.0}))}).error,
                   "the motor's force is opposite to the motion: -"));
    const std::string of_mass = calibrate({folder.write("c.csv", motion({.mass_kg = -9000.0}))}).error;
    CHECK(contains(of_mass, "'mass_kg' = -9"));
    CHECK(contains(of_mass, "opposite to the acceleration"));
}

TEST(MotionFriction, refuses_a_position_in_millimetres) {
    const TemporaryFolder folder;
    const std::string error = calibrate({folder.write("a.csv", motion({.position_scale = 1000.0}))}).error;
    CHECK(contains(error, "column 'position_m': the axis moves at up to 3"));
    CHECK(contains(error, "is it in mm"));
}

TEST(MotionFriction, that_changes_between_the_halves_is_a_broken_bound) {
    const TemporaryFolder folder;
    const Run keeps = calibrate({folder.write("a.csv", motion({}))});
    LONGS_EQUAL(0, keeps.code);
    CHECK(contains(keeps.text, "holds"));
    for (const double later : {0.8, 1.2}) {
        const Run changes = calibrate({folder.write("b.csv", motion({.later_friction = later}))});
        LONGS_EQUAL(1, changes.code);
        CHECK(contains(changes.text, "BROKEN: the friction changed"));
    }
}

TEST(MotionFriction, is_not_judged_from_a_half_that_does_not_determine_it) {
    const TemporaryFolder folder;
    for (const double still_until : {0.45, 0.6}) {
        const Run run = calibrate({folder.write("a.csv", motion({.noise_N = 6.0, .still_until = still_until}))});
        STRCMP_EQUAL("", run.error.c_str());
        LONGS_EQUAL(0, run.code);
        CHECK(contains(run.text, "cannot tell"));
    }
}
