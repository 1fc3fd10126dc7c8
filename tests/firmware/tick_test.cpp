// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include <CppUTest/TestHarness.h>

namespace hal = millforce::hal;
using millforce::control::CutState;
using millforce::control::Fault;
using millforce::firmware::ForceControlTick;
using millforce::firmware::step_and_work;
using Parameters = millforce::firmware::Parameters<float>;

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float feed_mm_s = 20.0F;

Parameters machine_and_tool() {
    Parameters p;
    p.machine.spindle.K_t1_Nm_per_A = 0.7F;
    p.machine.spindle.K_t2_Nm = -0.95F;
    p.machine.spindle.inertia_kg_m2 = 0.004F;
    for (auto& axis : p.machine.axes) {
        axis.positive.K_x2_A_min_per_m = 0.65F;
        axis.negative.K_x2_A_min_per_m = 0.65F;
        axis.K_x3_A = 1.6F;
        axis.K_x4_N_per_A = 120.0F;
        axis.mass_kg = 250.0F;
    }
    p.tool.side = millforce::estimation::CutSide::down;
    p.tool.tooth_force_limit_N = 700.0F;
    p.tool.law = millforce::estimation::linear_edge_law(1650.0F, 22.0F, 620.0F, 28.0F);
    return p;
}

/// A straight way along +x at 1 kHz and 4000 rpm: 0.2 s of air, then a cut with F_at = 250 N, F_ax = −150 N.
hal::DriveSample sample_of(int index, std::uint32_t first_time_us = 0) {
    const Parameters p = machine_and_tool();
    const float turned_rev = static_cast<float>(index) * 0.001F * 4000.0F / 60.0F;
    const float ripple = 1.0F + 0.3F * std::sin(8.0F * std::numbers::pi_v<float> * turned_rev);
    const float load = index < 200 ? 0.0F : ripple;
    hal::DriveSample sample;
    sample.time_us = first_time_us + static_cast<std::uint32_t>(index) * 1000U;
    sample.spindle_count = static_cast<std::uint32_t>(turned_rev * 4096.0F);
    sample.present = hal::all_present;
    sample.spindle_current_A = (load * 250.0F * 0.005F - p.machine.spindle.K_t2_Nm) / p.machine.spindle.K_t1_Nm_per_A;
    const auto& x = p.machine.axes[0];
    sample.axis_current_A[0] = x.positive.at(feed_mm_s * 0.06F) + x.K_x3_A - load * 150.0F / x.K_x4_N_per_A;
    sample.axis_velocity_mm_s[0] = feed_mm_s;
    return sample;
}

hal::ProgramStatus program() {
    hal::ProgramStatus status;
    status.programmed_feed_mm_s = feed_mm_s;
    return status;
}

/// So well known that one solution is like the next.
Parameters well_known_machine() {
    Parameters p = machine_and_tool();
    p.machine.spindle.current_sd_A = 0.02F;
    p.machine.spindle.inertia_kg_m2 = 0.0005F;
    for (auto& axis : p.machine.axes) {
        axis.friction_relative_sd = 0.01F;
        axis.friction_ripple_A = 0.01F;
        axis.current_sd_A = 0.02F;
        axis.gain_relative_sd = 0.01F;
    }
    return p;
}

/// With an encoder so fine that one window tells the torque.
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

bool is_sound(const hal::FeedOverride& output) {
    return output.ratio >= 0.1F && output.ratio <= 1.5F;
}

bool are_equal(const hal::FeedOverride& a, const hal::FeedOverride& b) {
    return a.ratio == b.ratio && a.hold == b.hold && a.state == b.state && a.fault == b.fault;
}

/// A tick's tables take longer to build than a thousand samples, minutes on a slow emulator: the cases begin with
/// copies.
ForceControlTick<float> fresh_tick() {
    static const ForceControlTick<float> tick(machine_and_tool());
    return tick;
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
    for (int k = 500; !tick.work_due(); ++k) {  // until a tooth period ends
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
    for (int k = 900; !tick.work_due(); ++k) {
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

TEST(Tick, counts_its_heartbeat_up_by_one_with_and_without_a_sample) {
    ForceControlTick<float> tick = fresh_tick();
    std::uint32_t expected = 0;
    for (int k = 0; k < 300; ++k) {
        const bool with_sample = k % 7 != 0;
        const auto output = with_sample ? step_and_work(tick, sample_of(k), program())
                                        : tick.step_without_sample(0.001F, 0.001F, program());
        LONGS_EQUAL(++expected, output.heartbeat);
    }
}

TEST(Tick, holds_the_feed_and_latches_a_fault_once_samples_are_stale) {
    ForceControlTick<float> tick = fresh_tick();
    for (int k = 0; k < 600; ++k) {
        step_and_work(tick, sample_of(k), program());
    }
    hal::FeedOverride output;
    for (int k = 1; k <= 49; ++k) {
        output = tick.step_without_sample(static_cast<float>(k) * 0.001F, 0.001F, program());
        CHECK_FALSE(output.hold);
    }
    output = tick.step_without_sample(0.051F, 0.001F, program());
    CHECK(output.hold);
    LONGS_EQUAL(static_cast<int>(Fault::stale_input), output.fault);
    for (int k = 700; k < 900; ++k) {
        output = step_and_work(tick, sample_of(k), program());
    }
    CHECK(output.hold);
    DOUBLES_EQUAL(0.1, static_cast<double>(output.ratio), 1e-6);
    tick.reset_fault();
    output = step_and_work(tick, sample_of(900), program());
    CHECK_FALSE(output.hold);
    LONGS_EQUAL(0, output.fault);
}

TEST(Tick, does_not_raise_the_feed_while_samples_are_missing) {
    ForceControlTick<float> tick = fresh_tick();
    for (int k = 0; k < 600; ++k) {
        step_and_work(tick, sample_of(k), program());
    }
    float before = tick.control().ratio;
    for (int k = 1; k < 50; ++k) {
        const auto output = tick.step_without_sample(static_cast<float>(k) * 0.001F, 0.001F, program());
        CHECK(output.ratio <= before);
        before = output.ratio;
    }
}

TEST(Tick, takes_what_is_not_finite_for_what_is_not_present) {
    for (int channel = 0; channel < 4; ++channel) {
        ForceControlTick<float> with_nan = fresh_tick();
        ForceControlTick<float> without = fresh_tick();
        for (int k = 0; k < 900; ++k) {
            hal::DriveSample spoilt = sample_of(k);
            hal::DriveSample missing = spoilt;
            if (k > 400 && k < 600) {
                const auto bit = 2U << static_cast<unsigned>(channel);
                missing.present = static_cast<std::uint8_t>(hal::all_present & ~bit);
                const auto axis = static_cast<std::size_t>(channel > 0 ? channel - 1 : 0);
                float& value = channel == 0 ? spoilt.spindle_current_A
                               : k % 2 == 0 ? spoilt.axis_current_A[axis]
                                            : spoilt.axis_velocity_mm_s[axis];
                value = k % 3 == 0 ? not_a_number : k % 3 == 1 ? std::numeric_limits<float>::infinity() : -INFINITY;
            }
            const auto output = step_and_work(with_nan, spoilt, program());
            CHECK(is_sound(output));
            CHECK(are_equal(output, step_and_work(without, missing, program())));
        }
    }
}

TEST(Tick, holds_the_feed_where_encoder_or_spindle_current_are_missing_for_longer_than_a_sample_may_be_late) {
    for (const hal::Present missing : {hal::Present::spindle_count, hal::Present::spindle_current}) {
        for (const bool in_cut : {false, true}) {
            ForceControlTick<float> tick = fresh_tick();
            const int first = in_cut ? 600 : 100;
            for (int k = 0; k < first; ++k) {
                step_and_work(tick, sample_of(k), program());
            }
            float before = tick.control().ratio;
            for (int k = first; k < first + 100; ++k) {
                hal::DriveSample sample = sample_of(k);
                sample.present = static_cast<std::uint8_t>(sample.present & ~hal::mask(missing));
                const auto output = step_and_work(tick, sample, program());
                CHECK(is_sound(output));
                CHECK(output.ratio <= before || !in_cut);
                before = output.ratio;
                CHECK_EQUAL(k - first >= 50, output.hold);
            }
            CHECK(tick.control().fault == Fault::stale_input);
        }
    }
}

TEST(Tick, waits_for_the_first_whole_sample_without_a_fault) {
    ForceControlTick<float> tick = fresh_tick();
    const float at_rest = tick.control().ratio;
    for (int k = 0; k < 500; ++k) {
        hal::DriveSample sample = sample_of(k);
        sample.present = static_cast<std::uint8_t>(sample.present & ~hal::mask(hal::Present::spindle_current));
        const auto output = step_and_work(tick, sample, program());
        CHECK(output.fault == 0);
        CHECK(output.ratio <= std::fmax(at_rest, 0.1F));
    }
}

TEST(Tick, faults_where_the_encoder_stands_in_air_and_the_current_says_that_the_tool_cuts) {
    for (const bool is_cutting : {false, true}) {
        ForceControlTick<float> tick = fresh_tick();
        for (int k = 0; k < 150; ++k) {
            step_and_work(tick, sample_of(k), program());
        }
        CHECK(tick.control().state == CutState::air);
        const std::uint32_t last_count = sample_of(150).spindle_count;
        for (int k = 150; k < 400; ++k) {
            hal::DriveSample sample = sample_of(is_cutting ? k + 400 : 150);
            sample.time_us = sample_of(k).time_us;
            sample.spindle_count = last_count;
            step_and_work(tick, sample, program());
        }
        CHECK(tick.control().fault == (is_cutting ? Fault::spindle_stopped : Fault::none));
    }
}

TEST(Tick, is_not_touched_by_the_wrap_of_the_time) {
    ForceControlTick<float> plain = fresh_tick();
    ForceControlTick<float> wrapping = fresh_tick();
    for (int k = 0; k < 900; ++k) {
        const auto output = step_and_work(plain, sample_of(k), program());
        CHECK(are_equal(output, step_and_work(wrapping, sample_of(k, 0xFFFFFFFFU - 450123U), program())));
    }
    CHECK(wrapping.control().state == CutState::in_cut);
}

TEST(Tick, is_not_touched_by_the_wrap_of_the_encoder_count) {
    ForceControlTick<float> plain = fresh_tick();
    ForceControlTick<float> wrapping = fresh_tick();
    for (int k = 0; k < 900; ++k) {
        hal::DriveSample wrapped = sample_of(k);
        wrapped.spindle_count -= 4096U * 30U;
        const auto output = step_and_work(plain, sample_of(k), program());
        CHECK(are_equal(output, step_and_work(wrapping, wrapped, program())));
    }
}

TEST(Tick, gives_a_sound_ratio_whatever_the_sample_and_the_program_say) {
    std::mt19937 random(4711);
    const auto engine = [&random] { return static_cast<std::uint32_t>(random()); };
    const auto anything = [&engine](float sensible) {
        const float extremes[] = {not_a_number, INFINITY, -INFINITY, 3e38F, -3e38F, 1e-40F, 0.0F, -1.0F};
        return engine() % 6U == 0U ? extremes[engine() % 8U] : sensible;
    };
    ForceControlTick<float> tick = fresh_tick();
    for (int k = 0; k < 20000; ++k) {
        hal::DriveSample sample = sample_of(k % 2000);
        sample.spindle_count = static_cast<std::uint32_t>(k) * 273U + (engine() % 50U == 0U ? engine() % 9000U : 0U);
        sample.time_us = static_cast<std::uint32_t>(k) * 1000U + (engine() % 50U == 0U ? engine() % 90000U : 0U);
        sample.present = static_cast<std::uint8_t>(engine() % 4U == 0U ? engine() % 256U : 0x1FU);
        sample.spindle_current_A = anything(sample.spindle_current_A);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sample.axis_current_A[axis] = anything(sample.axis_current_A[axis]);
            sample.axis_velocity_mm_s[axis] = anything(sample.axis_velocity_mm_s[axis]);
        }
        hal::ProgramStatus status = program();
        status.programmed_feed_mm_s = anything(feed_mm_s);
        status.operator_override = anything(1.0F);
        status.rapid = engine() % 20U == 0U;
        CHECK(is_sound(step_and_work(tick, sample, status)));
        if (engine() % 50U == 0U) {
            tick.reset_fault();
        }
    }
}
