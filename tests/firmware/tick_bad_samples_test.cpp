// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <CppUTest/TestHarness.h>

#include "firmware/tick_milling.hpp"

namespace hal = millforce::hal;
using namespace millforce::test;
using millforce::control::CutState;
using millforce::control::Fault;
using millforce::firmware::ForceControlTick;
using millforce::firmware::step_and_work;

namespace {

constexpr Load below_zero{-1.0F, 0.0F};
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

bool is_sound(const hal::FeedOverride& output) {
    return output.ratio >= 0.1F && output.ratio <= 1.5F;
}

bool are_equal(const hal::FeedOverride& a, const hal::FeedOverride& b) {
    return a.ratio == b.ratio && a.hold == b.hold && a.state == b.state && a.fault == b.fault;
}

}  // namespace

TEST_GROUP(TickOnBadSamples){};

TEST(TickOnBadSamples, counts_its_heartbeat_up_by_one_with_and_without_a_sample) {
    ForceControlTick<float> tick = fresh_tick();
    std::uint32_t expected = 0;
    for (int k = 0; k < 300; ++k) {
        const bool with_sample = k % 7 != 0;
        const auto output = with_sample ? step_and_work(tick, sample_of(k), program())
                                        : tick.step_without_sample(0.001F, 0.001F, program());
        LONGS_EQUAL(++expected, output.heartbeat);
    }
}

TEST(TickOnBadSamples, holds_the_feed_and_latches_a_fault_once_samples_are_stale) {
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

TEST(TickOnBadSamples, does_not_raise_the_feed_while_samples_are_missing) {
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

TEST(TickOnBadSamples, counts_no_revolutions_across_a_sample_without_a_count) {
    for (const bool has_gaps : {false, true}) {
        Milling milling;
        milling.rest(300);
        for (int k = 0; k < 10; ++k) {
            milling.missing = has_gaps ? hal::mask(hal::Present::spindle_count) : std::uint8_t{0};
            milling.mill(below_zero, 1);
            milling.missing = 0;
            milling.has_time_to_work = false;
            milling.mill(below_zero, 20);
            milling.has_time_to_work = true;
            milling.mill(below_zero, 30);
        }
        CHECK((milling.tick().control().fault == Fault::none) == has_gaps);
    }
}

TEST(TickOnBadSamples, lowers_the_feed_no_further_while_samples_are_missing) {
    Parameters p = with_all_currents();
    p.tool.control.slew_down_per_s = 0.5F;
    p.tool.tooth_force_limit_N = 300.0F;
    Milling milling{Tick(p)};
    const float before = milling.mill(air, 200).enter_the_cut(whole, 200).ratio();
    const float now = milling.mill(whole, 20).ratio();
    CHECK(now < before);
    for (int k = 1; k < 40; ++k) {
        milling.tick().step_without_sample(static_cast<float>(k) * 0.001F, 0.001F, program());
        CHECK(milling.ratio() == now);
    }
}

TEST(TickOnBadSamples, takes_what_is_not_finite_for_what_is_not_present) {
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

TEST(TickOnBadSamples,
     holds_the_feed_where_encoder_or_spindle_current_are_missing_for_longer_than_a_sample_may_be_late) {
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

TEST(TickOnBadSamples, holds_the_feed_in_a_cut_whose_feed_is_not_known_because_no_axis_is_that_fast) {
    ForceControlTick<float> tick = fresh_tick();
    for (int k = 0; k < 600; ++k) {
        step_and_work(tick, sample_of(k), program());
    }
    for (int k = 600; k < 700; ++k) {
        hal::DriveSample sample = sample_of(k);
        sample.axis_velocity_mm_s[0] *= 1e6F;
        CHECK_EQUAL(k - 600 >= 50, step_and_work(tick, sample, program()).hold);
    }
    CHECK(tick.control().fault == Fault::stale_input);
}

TEST(TickOnBadSamples, does_not_mind_what_the_velocity_of_an_absent_axis_says) {
    ForceControlTick<float> tick = fresh_tick();
    for (int k = 0; k < 700; ++k) {
        hal::DriveSample sample = sample_of(k);
        sample.present = static_cast<std::uint8_t>(sample.present & ~hal::axis_mask(2));
        sample.axis_velocity_mm_s[2] = k < 300 ? 0.0F : k % 2 == 0 ? 1e6F : not_a_number;
        CHECK_FALSE(step_and_work(tick, sample, program()).hold);
    }
}

TEST(TickOnBadSamples, waits_for_the_first_whole_sample_without_a_fault) {
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

TEST(TickOnBadSamples, faults_where_the_encoder_stands_in_air_and_the_current_says_that_the_tool_cuts) {
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

TEST(TickOnBadSamples, is_not_touched_by_the_wrap_of_the_time) {
    ForceControlTick<float> plain = fresh_tick();
    ForceControlTick<float> wrapping = fresh_tick();
    for (int k = 0; k < 900; ++k) {
        const auto output = step_and_work(plain, sample_of(k), program());
        CHECK(are_equal(output, step_and_work(wrapping, sample_of(k, 0xFFFFFFFFU - 450123U), program())));
    }
    CHECK(wrapping.control().state == CutState::in_cut);
}

TEST(TickOnBadSamples, is_not_touched_by_the_wrap_of_the_encoder_count) {
    ForceControlTick<float> plain = fresh_tick();
    ForceControlTick<float> wrapping = fresh_tick();
    for (int k = 0; k < 900; ++k) {
        hal::DriveSample wrapped = sample_of(k);
        wrapped.spindle_count -= 4096U * 30U;
        const auto output = step_and_work(plain, sample_of(k), program());
        CHECK(are_equal(output, step_and_work(wrapping, wrapped, program())));
    }
}

TEST(TickOnBadSamples, gives_a_sound_ratio_whatever_the_sample_and_the_program_say) {
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
