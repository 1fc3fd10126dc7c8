// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>

#include "machine/drive_plant.hpp"

using namespace millforce::sim;

namespace {

constexpr double dt_s = 0.25e-3;

void drive(SpindlePlant& spindle, double time_s, double commanded_rad_s, double torque_Nm, double step_s = dt_s) {
    for (long k = std::lround(time_s / step_s); k > 0; --k) {
        spindle.advance(step_s, commanded_rad_s, torque_Nm);
    }
}

/// Friction that does not drift: warm from the start.
SpindlePlantSettings warm() {
    SpindlePlantSettings settings;
    settings.cold_excess = 0.0;
    return settings;
}

}  // namespace

TEST_GROUP(SpindlePlant){};

TEST(SpindlePlant, in_steady_state_the_current_is_torque_over_the_torque_constant) {
    const SpindlePlantSettings settings = warm();
    for (const double speed : {100.0, 400.0, 600.0}) {
        for (const double torque : {0.0, 1.0, 5.0}) {
            SpindlePlant spindle(settings);
            spindle.start_at(speed);
            drive(spindle, 2.0, speed, torque);
            const double idle = settings.bearing_torque_Nm + settings.bearing_viscous_Nm_s * speed;
            DOUBLES_EQUAL((torque + idle) / settings.torque_constant_Nm_per_A, spindle.current_A(), 1e-6);
            DOUBLES_EQUAL(speed, spindle.speed_rad_s(), 1e-6);
        }
    }
}

TEST(SpindlePlant, above_the_base_speed_the_same_torque_takes_more_current) {
    const SpindlePlantSettings settings = warm();
    const double speed = 1.5 * settings.base_speed_rad_s;
    SpindlePlant spindle(settings);
    spindle.start_at(speed);
    drive(spindle, 2.0, speed, 2.0);
    const double torque = 2.0 + settings.bearing_torque_Nm + settings.bearing_viscous_Nm_s * speed;
    DOUBLES_EQUAL(1.5 * torque / settings.torque_constant_Nm_per_A, spindle.current_A(), 1e-6);
}

TEST(SpindlePlant, a_torque_step_dips_the_speed_and_the_loop_brings_it_back) {
    SpindlePlant spindle(warm());
    spindle.start_at(400.0);
    drive(spindle, 0.1, 400.0, 0.0);
    double lowest = 400.0;
    double overshoot = 400.0;
    for (int k = 0; k < 2000; ++k) {
        spindle.advance(dt_s, 400.0, 5.0);
        lowest = std::min(lowest, spindle.speed_rad_s());
        overshoot = std::max(overshoot, spindle.speed_rad_s());
    }
    // Loop of bandwidth ω_c: the dip is of the size of T/(J ω_c) = 5/(0.004 · 157) = 8 rad/s.
    CHECK(lowest < 400.0 - 4.0);
    CHECK(lowest > 400.0 - 8.0);
    CHECK(overshoot < 401.0);
    DOUBLES_EQUAL(400.0, spindle.speed_rad_s(), 0.01);
}

TEST(SpindlePlant, the_step_of_a_quarter_millisecond_is_small_enough) {
    for (const double torque : {1.0, 6.0}) {
        SpindlePlant coarse(warm());
        SpindlePlant fine(warm());
        coarse.start_at(400.0);
        fine.start_at(400.0);
        for (int k = 0; k < 400; ++k) {
            drive(coarse, dt_s, 400.0, torque);
            drive(fine, dt_s, 400.0, torque, dt_s / 16.0);
            DOUBLES_EQUAL(fine.speed_rad_s(), coarse.speed_rad_s(), 0.06 * torque);
            DOUBLES_EQUAL(fine.current_A(), coarse.current_A(), 0.12 * torque);
        }
    }
}

TEST(SpindlePlant, the_idle_current_falls_as_the_spindle_warms) {
    const SpindlePlantSettings settings;
    SpindlePlant spindle(settings);
    spindle.start_at(400.0);
    drive(spindle, 1.0, 400.0, 0.0);
    const double cold_A = spindle.current_A();
    drive(spindle, settings.warm_up_time_s - 1.0, 400.0, 0.0, 1e-3);
    const double later_A = spindle.current_A();
    const double warm_A =
        (settings.bearing_torque_Nm + settings.bearing_viscous_Nm_s * 400.0) / settings.torque_constant_Nm_per_A;
    DOUBLES_EQUAL(warm_A * (1.0 + settings.cold_excess * std::exp(-1.0 / settings.warm_up_time_s)), cold_A, 1e-4);
    DOUBLES_EQUAL(warm_A * (1.0 + settings.cold_excess * std::exp(-1.0)), later_A, 1e-4);
}

TEST(SpindlePlant, runs_up_from_rest_under_its_current_limit_and_stops_again_to_stand_still) {
    const SpindlePlantSettings settings = warm();
    SpindlePlant spindle(settings);
    spindle.start_at(0.0);
    double largest_A = 0.0;
    for (int k = 0; k < 8000; ++k) {
        spindle.advance(dt_s, 500.0, 0.0);
        largest_A = std::max(largest_A, std::abs(spindle.current_A()));
    }
    CHECK(largest_A <= 2.5 * settings.rated_current_A + 1e-9);
    CHECK(largest_A > 2.0 * settings.rated_current_A);
    DOUBLES_EQUAL(500.0, spindle.speed_rad_s(), 0.01);
    drive(spindle, 3.0, 0.0, 0.0);
    const double angle_rad = spindle.angle_rad();
    drive(spindle, 1.0, 0.0, 0.0);
    DOUBLES_EQUAL(0.0, spindle.speed_rad_s(), 1e-9);
    DOUBLES_EQUAL(angle_rad, spindle.angle_rad(), 1e-9);
}

TEST(SpindlePlant, friction_holds_a_standing_spindle_against_a_small_torque_and_not_against_a_large_one) {
    SpindlePlantSettings settings = warm();
    settings.speed_loop_bandwidth_hz = 1e-9;  // no drive
    SpindlePlant held(settings);
    held.start_at(0.0);
    drive(held, 1.0, 0.0, -0.9 * settings.bearing_torque_Nm);
    DOUBLES_EQUAL(0.0, held.speed_rad_s(), 0.0);
    SpindlePlant turned(settings);
    turned.start_at(0.0);
    drive(turned, 1.0, 0.0, -1.5 * settings.bearing_torque_Nm);
    CHECK(turned.speed_rad_s() > 1.0);
}

TEST(SpindlePlant, the_other_direction_is_the_mirror_image) {
    for (const double speed : {300.0, 900.0}) {
        SpindlePlant forward{SpindlePlantSettings{}};
        SpindlePlant backward{SpindlePlantSettings{}};
        forward.start_at(speed);
        backward.start_at(-speed);
        drive(forward, 0.3, 1.1 * speed, 1.0);
        drive(backward, 0.3, -1.1 * speed, -1.0);
        DOUBLES_EQUAL(forward.speed_rad_s(), -backward.speed_rad_s(), 1e-9);
        DOUBLES_EQUAL(forward.current_A(), -backward.current_A(), 1e-9);
    }
}

TEST(SpindlePlant, starts_at_speed_in_equilibrium) {
    for (const double speed : {-500.0, 20.0, 500.0, 1000.0}) {
        SpindlePlant spindle{SpindlePlantSettings{}};
        spindle.start_at(speed);
        for (int k = 0; k < 100; ++k) {
            spindle.advance(dt_s, speed, 0.0);
            DOUBLES_EQUAL(speed, spindle.speed_rad_s(), 1e-3);
        }
    }
}
