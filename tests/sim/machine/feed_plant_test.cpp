// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>

#include "machine/drive_plant.hpp"

using namespace millforce::sim;

namespace {

constexpr double dt_s = 0.25e-3;

FeedPlantSettings smooth() {
    FeedPlantSettings settings;
    settings.ripple_share = 0.0;
    return settings;
}

/// The axis without its drive: what friction alone does.
FeedPlantSettings free_axis() {
    FeedPlantSettings settings = smooth();
    settings.position_gain_per_s = 0.0;
    settings.velocity_loop_bandwidth_hz = 1e-9;
    return settings;
}

/// Holds a command with a force for a time.
void hold(FeedPlant& axis, double time_s, double force_N, double position_mm = 0.0) {
    for (long k = std::lround(time_s / dt_s); k > 0; --k) {
        axis.advance(dt_s, position_mm, 0.0, force_N);
    }
}

/// Brings a force up or down so slowly that the axis' mass plays no part.
void load(FeedPlant& axis, double from_N, double to_N) {
    constexpr int steps = 20000;
    for (int k = 1; k <= steps; ++k) {
        axis.advance(dt_s, 0.0, 0.0, from_N + (to_N - from_N) * k / steps);
    }
}

/// Moves at a steady speed and gives back the mean force of the motor over the second half.
double motor_force_at(const FeedPlantSettings& settings, double velocity_mm_s, double cutting_force_N,
                      double step_s = dt_s) {
    FeedPlant axis(settings);
    axis.start_at(0.0);
    const long steps = std::lround(std::min(4.0, 0.5 + 5.0 / std::abs(velocity_mm_s)) / step_s);
    double sum_A = 0.0;
    long count = 0;
    for (long k = 1; k <= steps; ++k) {
        axis.advance(step_s, velocity_mm_s * static_cast<double>(k) * step_s, velocity_mm_s, cutting_force_N);
        if (k > steps / 2) {
            DOUBLES_EQUAL(velocity_mm_s, axis.velocity_mm_s(), 0.002 * std::abs(velocity_mm_s) + 1e-4);
            sum_A += axis.current_A();
            ++count;
        }
    }
    return settings.force_constant_N_per_A * sum_A / static_cast<double>(count);
}

/// The steady friction that the parameters imply, from the header's equation.
double steady_friction_N(const FeedPlantSettings& settings, double v) {
    const double coulomb = v > 0.0 ? settings.coulomb_positive_N : settings.coulomb_negative_N;
    const double viscous = v > 0.0 ? settings.viscous_positive_N_s_per_mm : settings.viscous_negative_N_s_per_mm;
    const double ratio = v / settings.stribeck_velocity_mm_s;
    const double level = coulomb * (1.0 + settings.stribeck_excess * std::exp(-ratio * ratio));
    return settings.friction_scale * (std::copysign(level, v) + viscous * v);
}

}  // namespace

TEST_GROUP(FeedPlant){};

TEST(FeedPlant, at_steady_speed_the_current_is_what_friction_weight_and_cut_imply_in_each_direction) {
    FeedPlantSettings settings = smooth();
    for (const double weight : {0.0, 600.0}) {
        settings.weight_N = weight;
        for (const double force : {0.0, 400.0, -400.0}) {
            for (const double v : {-60.0, -10.0, -1.5, 1.5, 10.0, 60.0}) {
                const double expected = steady_friction_N(settings, v) + weight + force;
                DOUBLES_EQUAL(expected, motor_force_at(settings, v, force), 0.005 * std::abs(expected) + 1.0);
            }
        }
    }
}

TEST(FeedPlant, slow_motion_needs_more_force_than_a_little_faster_one) {
    const double crawling = motor_force_at(smooth(), 0.2, 0.0);
    const double creeping = motor_force_at(smooth(), 3.0, 0.0);
    const double fast = motor_force_at(smooth(), 100.0, 0.0);
    CHECK(crawling > creeping + 20.0);
    CHECK(fast > creeping + 300.0);
}

TEST(FeedPlant, the_friction_scale_scales_all_friction_and_nothing_else) {
    FeedPlantSettings settings = smooth();
    settings.weight_N = 500.0;
    settings.friction_scale = 1.2;
    const double expected = 1.2 * steady_friction_N(smooth(), 20.0) + 500.0;
    DOUBLES_EQUAL(expected, motor_force_at(settings, 20.0, 0.0), 2.0);
}

TEST(FeedPlant, friction_ripples_over_the_pitch_of_the_screw) {
    FeedPlantSettings settings;
    settings.ripple_share = 0.1;
    FeedPlant axis(settings);
    axis.start_at(0.0);
    double at_quarter = 0.0;
    double at_three_quarters = 0.0;
    for (int k = 1; k <= 40000; ++k) {
        const double x = 5.0 * k * dt_s;
        axis.advance(dt_s, x, 5.0, 0.0);
        const double turns = axis.position_mm() / settings.screw_pitch_mm;
        const double place = turns - std::floor(turns);
        if (x > 10.0 && std::abs(place - 0.25) < 0.01) {
            at_quarter = axis.current_A();
        }
        if (x > 10.0 && std::abs(place - 0.75) < 0.01) {
            at_three_quarters = axis.current_A();
        }
    }
    const double ripple_N = settings.force_constant_N_per_A * (at_quarter - at_three_quarters);
    DOUBLES_EQUAL(2.0 * 0.1 * settings.coulomb_positive_N, ripple_N, 3.0);
}

TEST(FeedPlant, a_free_axis_holds_a_force_below_break_away_with_the_micrometres_of_dahls_curve) {
    const FeedPlantSettings settings = free_axis();
    for (const double force : {60.0, 170.0, -60.0, -190.0}) {
        FeedPlant axis(settings);
        axis.start_at(0.0);
        load(axis, 0.0, force);
        // A force on the workpiece pushes the axis the other way.
        const double coulomb = force > 0.0 ? settings.coulomb_negative_N : settings.coulomb_positive_N;
        const double level = coulomb * (1.0 + settings.stribeck_excess);
        const double travel = -level / settings.presliding_stiffness_N_per_mm * std::log(1.0 - std::abs(force) / level);
        DOUBLES_EQUAL(std::copysign(travel, -force), axis.position_mm(), 0.03 * travel);
        const double rest_mm = axis.position_mm();
        hold(axis, 5.0, force);
        DOUBLES_EQUAL(rest_mm, axis.position_mm(), 0.02 * travel);  // it creeps while its oscillation dies
        DOUBLES_EQUAL(0.0, axis.velocity_mm_s(), 1e-6);
    }
}

TEST(FeedPlant, a_force_beyond_break_away_makes_a_free_axis_slide) {
    const FeedPlantSettings settings = free_axis();
    const double break_away = settings.coulomb_negative_N * (1.0 + settings.stribeck_excess);
    FeedPlant axis(settings);
    axis.start_at(0.0);
    hold(axis, 1.0, 1.3 * break_away);
    CHECK(axis.position_mm() < -1.0);
}

TEST(FeedPlant, unloading_brings_a_free_axis_back_only_in_part) {
    const FeedPlantSettings settings = free_axis();
    FeedPlant axis(settings);
    axis.start_at(0.0);
    load(axis, 0.0, -150.0);
    const double loaded_mm = axis.position_mm();
    load(axis, -150.0, 0.0);
    const double level = settings.coulomb_negative_N * (1.0 + settings.stribeck_excess);  // it moves back
    const double back_mm = level / settings.presliding_stiffness_N_per_mm * std::log(1.0 + 150.0 / level);
    DOUBLES_EQUAL(loaded_mm - back_mm, axis.position_mm(), 0.03 * loaded_mm);
    CHECK(axis.position_mm() > 0.3 * loaded_mm);
}

TEST(FeedPlant, the_current_of_a_resting_axis_shows_hysteresis) {
    const FeedPlantSettings settings = smooth();
    FeedPlant axis(settings);
    axis.start_at(0.0);
    hold(axis, 2.0, 0.0);
    const auto motor_force = [&](double force_N) {
        hold(axis, 2.0, force_N);
        return settings.force_constant_N_per_A * axis.current_A();
    };
    motor_force(120.0);
    const double after_positive = motor_force(0.0);
    motor_force(-120.0);
    const double after_negative = motor_force(0.0);
    CHECK(std::abs(after_positive - after_negative) > 5.0);    // the same force, two currents
    CHECK(std::abs(after_positive - after_negative) < 100.0);  // and no more than friction can hold
    DOUBLES_EQUAL(0.0, axis.position_mm(), 1e-4);
}

TEST(FeedPlant, a_weight_is_carried_from_the_first_moment_on) {
    FeedPlantSettings settings = smooth();
    settings.weight_N = 620.0;
    FeedPlant axis(settings);
    axis.start_at(3.0);
    for (int k = 0; k < 4000; ++k) {
        axis.advance(dt_s, 3.0, 0.0, 0.0);
        DOUBLES_EQUAL(3.0, axis.position_mm(), 1e-9);
        DOUBLES_EQUAL(620.0 / settings.force_constant_N_per_A, axis.current_A(), 1e-9);
    }
}

TEST(FeedPlant, a_force_step_pushes_the_axis_by_micrometres_and_the_loop_brings_it_back) {
    FeedPlant axis(smooth());
    axis.start_at(0.0);
    double furthest = 0.0;
    for (int k = 1; k <= 8000; ++k) {
        const double t = k * dt_s;
        axis.advance(dt_s, 20.0 * t, 20.0, t > 1.0 ? 500.0 : 0.0);
        if (t > 1.0) {
            furthest = std::max(furthest, std::abs(20.0 * t - axis.position_mm()));
        }
    }
    CHECK(furthest > 0.001);
    CHECK(furthest < 0.1);
    DOUBLES_EQUAL(20.0 * 2.0, axis.position_mm(), 0.02);
}

TEST(FeedPlant, the_step_of_a_quarter_millisecond_is_small_enough) {
    for (const double v : {-40.0, -0.5, 0.5, 5.0, 40.0}) {
        const double coarse = motor_force_at(smooth(), v, 200.0);
        const double fine = motor_force_at(smooth(), v, 200.0, dt_s / 8.0);
        DOUBLES_EQUAL(fine, coarse, 0.01 * std::abs(fine) + 0.5);
    }
    // And a rough ride stays bounded: full rapid, reversals, shocks.
    FeedPlant axis{FeedPlantSettings{}};
    axis.start_at(0.0);
    double x = 0.0;
    for (int k = 0; k < 40000; ++k) {
        const double v = 250.0 * std::sin(k * dt_s * 7.0);
        x += v * dt_s;
        axis.advance(dt_s, x, v, k % 400 < 200 ? 1000.0 : -1000.0);
        CHECK(std::abs(axis.position_mm() - x) < 3.0);
        CHECK(std::abs(axis.current_A()) <= 2.5 * 12.0 + 1e-9);
    }
}

TEST(FeedPlant, an_axis_without_friction_is_an_axis_and_not_a_division_by_zero) {
    FeedPlantSettings settings = smooth();
    settings.coulomb_positive_N = 0.0;
    settings.coulomb_negative_N = 0.0;
    FeedPlant axis(settings);
    axis.start_at(0.0);
    hold(axis, 0.5, 0.0);
    DOUBLES_EQUAL(0.0, axis.position_mm(), 1e-9);
    DOUBLES_EQUAL(settings.viscous_positive_N_s_per_mm * 10.0, motor_force_at(settings, 10.0, 0.0), 0.5);
}
