// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick.hpp"

#include <cmath>
#include <cstdint>

#include <CppUTest/TestHarness.h>

#include "firmware/tick_bench.hpp"

namespace hal = millforce::hal;
using namespace millforce::test;
using millforce::control::CutState;
using millforce::firmware::ForceControlTick;
using millforce::firmware::step_and_work;

namespace {

/// With an encoder so fine that one window gives the torque.
Parameters with_fine_encoder() {
    Parameters p = machine_and_tool();
    p.machine.encoder_counts_per_rev = 65536;
    return p;
}

/// At 4000 rpm with the axes at rest, or feeding along +x, under an even torque.
hal::DriveSample sample_under(float torque_Nm, int index, float speed_mm_s) {
    hal::DriveSample sample = sample_of(index);
    const Parameters p = with_fine_encoder();
    sample.spindle_count = static_cast<std::uint32_t>(std::lround(static_cast<double>(index) * 65536.0 / 15.0));
    const auto& x = p.machine.axes[0];
    sample.spindle_current_A = (torque_Nm - p.machine.spindle.K_t2_Nm) / p.machine.spindle.K_t1_Nm_per_A;
    sample.axis_current_A[0] = speed_mm_s > 0.0F ? x.positive.at(speed_mm_s * 0.06F) + x.K_x3_A : 0.0F;
    sample.axis_velocity_mm_s[0] = speed_mm_s;
    return sample;
}

ForceControlTick<float> fresh_tick_with_fine_encoder() {
    static const ForceControlTick<float> tick(with_fine_encoder());
    return tick;
}

}  // namespace

TEST_GROUP(Tick){};

TEST(Tick, finds_the_cut_in_the_drives_signals) {
    ForceControlTick<float> tick = fresh_tick();
    for (int k = 0; k < 200; ++k) {
        CHECK(step_and_work(tick, sample_of(k), program()).state == static_cast<std::uint8_t>(CutState::air));
    }
    double sum_N = 0.0;
    for (int k = 200; k < 800; ++k) {
        step_and_work(tick, sample_of(k), program());
        sum_N += k >= 500 ? static_cast<double>(tick.estimate().tangential_N.value) : 0.0;
    }
    CHECK(tick.control().state == CutState::in_cut);
    CHECK(tick.estimate().tooth_force_N.valid);
    DOUBLES_EQUAL(250.0, sum_N / 300.0, 12.5);
}

TEST(Tick, does_not_learn_a_light_cut_as_idle_torque_though_it_begins_with_the_spindle) {
    ForceControlTick<float> tick = fresh_tick_with_fine_encoder();
    for (int k = 0; k < 3000; ++k) {
        step_and_work(tick, sample_under(0.3F, k, feed_mm_s), program());
    }
    DOUBLES_EQUAL(60.0, static_cast<double>(tick.estimate().tangential_N.value), 3.0);
}

TEST(Tick, learns_the_idle_torque_while_the_axes_rest_or_in_a_rapid_and_not_in_the_light_cut_that_follows) {
    for (const bool is_rapid : {false, true}) {
        ForceControlTick<float> tick = fresh_tick_with_fine_encoder();
        hal::ProgramStatus before_the_cut = program();
        before_the_cut.rapid = is_rapid;
        for (int k = 0; k < 200; ++k) {
            step_and_work(tick, sample_under(0.25F, k, is_rapid ? 200.0F : 0.0F), before_the_cut);
        }
        DOUBLES_EQUAL(0.0, static_cast<double>(tick.estimate().tangential_N.value), 5.0);
        for (int k = 200; k < 3000; ++k) {
            step_and_work(tick, sample_under(0.25F + 0.3F, k, feed_mm_s), program());
        }
        DOUBLES_EQUAL(60.0, static_cast<double>(tick.estimate().tangential_N.value), 6.0);
    }
}

TEST(Tick, does_not_take_the_first_index_pulse_for_a_force) {
    for (std::uint32_t index_count = 1000; index_count < 65536; index_count += 5000) {
        ForceControlTick<float> tick = fresh_tick_with_fine_encoder();
        for (int k = 0; k < 200; ++k) {
            hal::DriveSample sample = sample_under(0.0F, k, 0.0F);
            const bool has_passed = sample.spindle_count >= index_count;
            sample.spindle_index_count = has_passed ? index_count : 0;
            sample.spindle_index_number = has_passed ? 1 : 0;
            step_and_work(tick, sample, program());
            CHECK(tick.control().state == CutState::air);
            DOUBLES_EQUAL(0.0, static_cast<double>(tick.estimate().tangential_N.value), 3.0);
        }
    }
}

TEST(Tick, estimates_in_its_work_and_answers_with_the_next_step) {
    ForceControlTick<float> tick = fresh_tick();
    for (int k = 0; k < 500; ++k) {
        step_and_work(tick, sample_of(k), program());
    }
    const float before_N = tick.estimate().tangential_N.value;
    for (int k = 500; k < 520 && !tick.work_due(); ++k) {  // until a tooth period ends
        tick.step(sample_of(k), program());
    }
    CHECK(tick.estimate().tangential_N.value == before_N);
    millforce::firmware::finish_work(tick);
    CHECK(tick.estimate().tangential_N.value != before_N);
    CHECK_FALSE(tick.work_due());
}

TEST(Tick, finds_the_same_cut_one_slice_a_step_even_where_teeth_pass_faster_than_slices) {
    for (const std::uint8_t teeth : {std::uint8_t{4}, std::uint8_t{12}}) {  // a tooth in 3.75 and in 1.25 steps
        Parameters parameters = well_known_machine();
        parameters.tool.teeth = teeth;
        ForceControlTick<float> at_once(parameters);
        ForceControlTick<float> in_slices(parameters);
        constexpr int settled = 1200;
        constexpr int compared = 300;  // 20 revolutions: the encoder's grain shows in a single one
        double immersion_more = 0.0;
        double at_once_N = 0.0;
        double in_slices_N = 0.0;
        for (int k = 0; k < settled + compared; ++k) {
            step_and_work(at_once, sample_of(k), program());
            in_slices.step(sample_of(k), program());
            in_slices.work();
            if (k >= settled) {
                const auto& a = at_once.estimate();
                const auto& b = in_slices.estimate();
                CHECK(a.engagement.immersion_valid && b.engagement.immersion_valid);
                immersion_more += static_cast<double>(b.engagement.radial_immersion - a.engagement.radial_immersion);
                at_once_N += static_cast<double>(a.tooth_force_N.value);
                in_slices_N += static_cast<double>(b.tooth_force_N.value);
            }
        }
        CHECK(in_slices.control().state == CutState::in_cut);
        DOUBLES_EQUAL(0.0, immersion_more / compared, 0.01);
        DOUBLES_EQUAL(1.0, in_slices_N / at_once_N, 0.02);
    }
}

TEST(Tick, finds_the_same_cut_again_after_a_gap_in_the_samples_with_work_left) {
    ForceControlTick<float> tick = fresh_tick();
    for (int k = 0; k < 900; ++k) {
        step_and_work(tick, sample_of(k), program());
    }
    CHECK(tick.estimate().engagement.immersion_valid);
    for (int k = 900; k < 920 && !tick.work_due(); ++k) {
        tick.step(sample_of(k), program());
    }
    tick.work();
    tick.step_without_sample(0.001F, 0.001F, program());
    CHECK_FALSE(tick.work_due());
    CHECK_FALSE(tick.estimate().engagement.immersion_valid);
    for (int k = 910; k < 1100; ++k) {
        step_and_work(tick, sample_of(k), program());
    }
    CHECK(tick.estimate().engagement.immersion_valid);
}
