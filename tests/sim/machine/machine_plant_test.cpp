// SPDX-License-Identifier: Apache-2.0
#include "machine/machine_plant.hpp"

#include <cmath>
#include <numbers>

// Behind Eigen: it replaces operator new by a macro.
#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::sim;

namespace {

constexpr double dt_s = 0.25e-3;

MachinePlantSettings quiet() {
    MachinePlantSettings settings;
    settings.current_noise_share = 0.0;
    settings.current_channel = CurrentChannel::exact;
    return settings;
}

}  // namespace

TEST_GROUP(MachinePlant){};

TEST(MachinePlant, time_goes_on_in_equal_steps) {
    MachinePlant machine(quiet());
    machine.start_at(Eigen::Vector3d::Zero(), 0.0);
    std::uint32_t before = machine.sample().time_us;
    LONGS_EQUAL(0, before);
    for (int k = 0; k < 400000; ++k) {
        machine.advance(dt_s, {}, {});
        const std::uint32_t now = machine.sample().time_us;
        LONGS_EQUAL(250, now - before);
        before = now;
    }
}

TEST(MachinePlant, time_wraps_after_71_6_minutes_and_its_differences_do_not_jump) {
    MachinePlant machine(quiet());
    machine.start_at(Eigen::Vector3d::Zero(), 0.0);
    std::uint32_t before = 0;
    bool wrapped = false;
    for (int k = 1; k <= 4500; ++k) {  // at rest, so a second at a time
        machine.advance(1.0, {}, {});
        const std::uint32_t now = machine.sample().time_us;
        LONGS_EQUAL(1000000, now - before);
        if (now < before) {
            LONGS_EQUAL(4295, k);
            LONGS_EQUAL(4295000000LL - 4294967296LL, now);
            wrapped = true;
        }
        before = now;
    }
    CHECK(wrapped);
    DOUBLES_EQUAL(4500.0, machine.time_s(), 1e-9);
}

TEST(MachinePlant, every_quantity_of_a_sample_is_there_and_of_its_own_axis) {
    MachinePlant machine(quiet());
    machine.start_at({1.0, 2.0, 3.0}, 400.0);
    MachinePlant::Command command;
    command.spindle_speed_rad_s = 400.0;
    for (int k = 1; k <= 4000; ++k) {
        const double t = k * dt_s;
        command.velocity_mm_s = {10.0, -20.0, 5.0};
        command.position_mm = Eigen::Vector3d(1.0, 2.0, 3.0) + command.velocity_mm_s * t;
        machine.advance(dt_s, command, {{300.0, 0.0, 0.0}, 3.0});
    }
    const hal::DriveSample sample = machine.sample();
    LONGS_EQUAL(hal::all_present, sample.present);
    DOUBLES_EQUAL(10.0, sample.axis_velocity_mm_s[0], 0.02);
    DOUBLES_EQUAL(-20.0, sample.axis_velocity_mm_s[1], 0.02);
    DOUBLES_EQUAL(5.0, sample.axis_velocity_mm_s[2], 0.02);
    const auto axes = MachinePlantSettings::standard_axes();
    const double friction_x = axes[0].coulomb_positive_N + axes[0].viscous_positive_N_s_per_mm * 10.0;
    DOUBLES_EQUAL((friction_x + 300.0) / axes[0].force_constant_N_per_A, sample.axis_current_A[0], 0.1);
    const double friction_y = axes[1].coulomb_negative_N + axes[1].viscous_negative_N_s_per_mm * 20.0;
    DOUBLES_EQUAL(-friction_y / axes[1].force_constant_N_per_A, sample.axis_current_A[1], 0.1);
    const double friction_z = axes[2].coulomb_positive_N + axes[2].viscous_positive_N_s_per_mm * 5.0;
    DOUBLES_EQUAL((friction_z + axes[2].weight_N) / axes[2].force_constant_N_per_A, sample.axis_current_A[2], 0.1);
    CHECK(sample.spindle_current_A > 3.0F / 0.7F);
    const double counts = machine.spindle_angle_rad() / (2.0 * std::numbers::pi) * 8192.0;
    LONGS_EQUAL(static_cast<long>(std::floor(counts)), sample.spindle_count);
    LONGS_EQUAL(std::floor((machine.spindle_angle_rad() - 1.0) / (2.0 * std::numbers::pi)) + 1,
                sample.spindle_index_number);
    DOUBLES_EQUAL(0.0, (machine.position_mm() - command.position_mm).norm(), 0.02);
}

TEST(MachinePlant, velocities_come_in_the_steps_of_their_object) {
    MachinePlantSettings settings;
    settings.velocity_resolution_mm_s = 0.5;
    MachinePlant machine(settings);
    machine.start_at(Eigen::Vector3d::Zero(), 0.0);
    for (int k = 1; k <= 2000; ++k) {
        machine.advance(dt_s, {{3.3 * k * dt_s, 0.0, 0.0}, {3.3, 0.0, 0.0}, 0.0}, {});
        const double steps = static_cast<double>(machine.sample().axis_velocity_mm_s[0]) / 0.5;
        DOUBLES_EQUAL(std::round(steps), steps, 1e-6);
    }
    DOUBLES_EQUAL(3.5, machine.sample().axis_velocity_mm_s[0], 1e-6);
}

TEST(MachinePlant, a_seed_repeats_a_run_bit_for_bit_and_gives_each_sensor_its_own_noise) {
    MachinePlantSettings settings;
    settings.current_channel = CurrentChannel::exact;
    settings.seed = 5;
    MachinePlant one(settings);
    MachinePlant same(settings);
    settings.seed = 6;
    MachinePlant other(settings);
    int alike = 0;
    for (int k = 0; k < 500; ++k) {
        for (MachinePlant* machine : {&one, &same, &other}) {
            machine->advance(dt_s, {}, {});
        }
        const hal::DriveSample a = one.sample();
        const hal::DriveSample b = same.sample();
        const hal::DriveSample c = other.sample();
        CHECK(a.spindle_current_A == b.spindle_current_A && a.axis_current_A == b.axis_current_A);
        alike += a.spindle_current_A == c.spindle_current_A ? 1 : 0;
        alike += a.axis_current_A[0] == a.axis_current_A[1] ? 1 : 0;
        alike += a.axis_current_A[0] == a.spindle_current_A ? 1 : 0;
    }
    CHECK(alike < 5);
}
