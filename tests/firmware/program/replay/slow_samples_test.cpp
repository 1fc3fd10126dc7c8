// SPDX-License-Identifier: Apache-2.0
#include "replay/slow_samples.hpp"
#include "files/input_error.hpp"
#include "firmware/tick.hpp"
#include "firmware/tick_bench.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <random>
#include <sstream>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

constexpr double period_s = 0.02;
constexpr double turns_per_s = 3200.0 / 60.0;

/// In a control's trace: a rapid, then a feed move in air along x, then a cut of `torque_Nm`.
hal::DriveSample traced(int index, double torque_Nm, std::mt19937& random) {
    const Parameters p = machine_and_tool();
    const auto& x = p.machine.axes[0];
    const float speed_mm_s = index < 100 ? 60.0F : 8.0F;
    std::normal_distribution<float> noise_A(0.0F, 0.05F);
    hal::DriveSample sample;
    sample.present = hal::all_present;
    sample.time_us = static_cast<std::uint32_t>(std::lround(1e6 * period_s * index));
    const double turns = turns_per_s * period_s * index;
    sample.spindle_count = static_cast<std::uint32_t>(turns * p.machine.encoder_counts_per_rev);
    sample.spindle_index_count = static_cast<std::uint32_t>(std::floor(turns)) * p.machine.encoder_counts_per_rev;
    sample.spindle_index_number = static_cast<std::uint8_t>(static_cast<int>(turns) % 256);
    const double drive_Nm = torque_Nm - static_cast<double>(p.machine.spindle.K_t2_Nm);
    sample.spindle_current_A = static_cast<float>(drive_Nm) / p.machine.spindle.K_t1_Nm_per_A + noise_A(random);
    sample.axis_current_A[0] = x.gravity_A + x.positive.at(speed_mm_s * 0.06F) + x.K_x3_A + noise_A(random);
    sample.axis_velocity_mm_s[0] = speed_mm_s;
    return sample;
}

}  // namespace

TEST_GROUP(SlowSamples){};

TEST(SlowSamples, of_fifty_hertz_at_3200_rpm_show_the_mean_force_of_a_cut) {
    constexpr int parts = 22;
    Parameters p = machine_and_tool();
    for (float* sd_A : {&p.machine.spindle.current_sd_A, &p.machine.axes[0].current_sd_A}) {
        *sd_A = 0.05F;
    }
    p.machine = for_slow_samples(p.machine, parts);
    firmware::ForceControlTick<float> tick(p);
    std::mt19937 random(4);
    hal::DriveSample last = traced(0, 0.0, random);
    for (int k = 1; k < 400; ++k) {
        hal::ProgramStatus program;
        program.rapid = k < 100;
        const hal::DriveSample now = traced(k, k < 200 ? 0.0 : 2.0, random);
        for (int part = 1; part < parts; ++part) {
            firmware::step_and_work(tick, sample_between(last, now, static_cast<double>(part) / parts), program);
        }
        firmware::step_and_work(tick, now, program);
        last = now;
    }
    const auto& F_at = tick.estimate().tangential_N;
    const double expected_N = 2000.0 / (0.5 * static_cast<double>(p.tool.diameter_mm));
    CHECK(F_at.valid);
    DOUBLES_EQUAL(expected_N, static_cast<double>(F_at.value), 0.05 * expected_N);
    CHECK(std::abs(static_cast<double>(F_at.value) - expected_N) < 3.0 * std::sqrt(static_cast<double>(F_at.variance)));
    CHECK(tick.control().state != control::CutState::air);
}

TEST(SlowSamples, are_divided_by_how_far_the_spindle_turns_and_refused_where_it_turns_too_far) {
    const TemporaryFolder folder;
    const auto log_with = [&folder](double turn_rev) {
        std::ostringstream text;
        text << "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s\n";
        for (int k = 0; k < 50; ++k) {
            text << 0.02 * k << ',' << 6.2831853 * turn_rev * k << ",1,1,8\n";
        }
        return folder.write("trace.csv", text.str());
    };
    LONGS_EQUAL(1, parts_of_slow_samples(log_with(0.3), 8192));
    LONGS_EQUAL(22, parts_of_slow_samples(log_with(1.07), 8192));
    const std::string refusal = message_of<InputError>([&] { (void)parts_of_slow_samples(log_with(25.0), 8192); });
    STRCMP_CONTAINS("the spindle turns by 25 revolutions between two samples", refusal.c_str());
}
