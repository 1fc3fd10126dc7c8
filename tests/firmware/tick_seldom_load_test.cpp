// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "firmware/tick.hpp"
#include "tick_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;

namespace {

Parameters spindle_with_a_seldom_load() {
    Parameters p = machine_and_tool();
    for (auto& axis : p.machine.axes) {
        axis.K_x4_N_per_A = 0.0F;
    }
    p.machine.spindle.current_sd_A = 0.04F;
    p.machine.spindle_load_period_s = 0.1F;
    p.machine.spindle_load_age_s = 0.1F;
    return p;
}

/// The cut of tick_bench.hpp whose force follows the feed, and the feed the override. Its load comes ten times a
/// second, 0.1 s old and rounded to 0.1 A.
class Machine {
  public:
    hal::FeedOverride run(int samples) {
        hal::FeedOverride output;
        for (const int end = index_ + samples; index_ < end; ++index_) {
            output = firmware::step_and_work(tick, sample(), status);
            feed_ = output.hold ? 0.0F : feed_mm_s * program_share * output.ratio;
        }
        return output;
    }

    int samples_until_a_fault() {
        int samples = 0;
        while (samples < 6000 && tick.control().fault == control::Fault::none) {
            run(1);
            ++samples;
        }
        return samples;
    }

    firmware::ForceControlTick<float> tick{spindle_with_a_seldom_load()};
    hal::ProgramStatus status = program();
    bool load_stands_still = false;
    std::uint32_t counted_more = 0;  ///< by the encoder
    float program_share = 1.0F;      ///< of the feed
    float heavier = 1.0F;

  private:
    hal::DriveSample sample() {
        constexpr int period = 100;
        constexpr float idle_A = 0.95F / 0.7F;
        hal::DriveSample sample = sample_of(index_);
        sample.axis_velocity_mm_s = {feed_, 0.0F, 0.0F};
        sample.spindle_count += counted_more;
        const float load_A = index_ < 500 ? 0.0F : 3.0F * heavier * (0.2F + 0.8F * feed_ / feed_mm_s);
        if (index_ % period == 0 && !load_stands_still) {
            told_A_ = measured_A_;
            const float flicker = index_ / period % 2 == 0 ? 0.4F : -0.4F;  // of the last digit: so are its steps known
            measured_A_ = std::round((idle_A + load_A) * 10.0F + flicker) / 10.0F;
        }
        sample.spindle_current_A = told_A_;
        return sample;
    }

    int index_ = 0;
    float feed_ = feed_mm_s;
    float told_A_ = 1.4F;
    float measured_A_ = 1.4F;
};

}  // namespace

TEST_GROUP(TickOnSeldomLoad) {
    Machine machine;
};

TEST(TickOnSeldomLoad, mills_on_by_a_load_that_answers) {
    for (int second = 0; second < 30; ++second) {
        const hal::FeedOverride output = machine.run(1000);
        CHECK_FALSE(output.hold);
        UNSIGNED_LONGS_EQUAL(0, output.fault);
    }
    CHECK(machine.tick.control().state == control::CutState::in_cut);
}

TEST(TickOnSeldomLoad, asks_a_load_that_stands_still_in_the_cut_and_finds_it) {
    machine.run(6000);
    machine.load_stands_still = true;
    const float before = machine.run(1).ratio;
    float highest = 0.0F;
    bool was_asked = false;
    hal::FeedOverride output;
    for (int k = 0; k < 5000 && output.fault == 0; ++k) {
        output = machine.run(1);
        highest = std::fmax(highest, output.ratio);
        was_asked = was_asked || machine.tick.control().limit == control::Limit::load_unanswered;
    }
    CHECK(was_asked);
    CHECK(output.hold);
    UNSIGNED_LONGS_EQUAL(static_cast<unsigned>(control::Fault::signal_stuck), output.fault);
    CHECK(highest < 1.25F * before);
}

TEST(TickOnSeldomLoad, changes_the_feed_once_for_a_cut_that_becomes_heavier_and_not_for_each_sample_of_a_late_load) {
    machine.run(6000);
    machine.heavier = 1.8F;
    float lowest = 10.0F;
    for (int k = 0; k < 1000; ++k) {
        lowest = std::fmin(lowest, machine.run(1).ratio);
    }
    const float settled = machine.run(1500).ratio;
    CHECK(lowest > 0.85F * settled);
}

TEST(TickOnSeldomLoad, sees_a_contact_though_the_feed_has_just_changed) {
    const Machine begun = machine;
    for (const bool is_steady : {true, false}) {
        machine = begun;
        int k = 0;
        while (k < 3000 && machine.tick.control().state == control::CutState::air) {
            machine.program_share = is_steady || k % 100 < 50 ? 1.0F : 0.8F;
            machine.run(1);
            ++k;
        }
        CHECK(machine.tick.feed_is_settled() == is_steady);
        CHECK(k < 1000);
    }
}

TEST(TickOnSeldomLoad, asks_nothing_while_the_feed_is_held) {
    machine.run(6000);
    machine.status.feed_hold = true;
    machine.run(6000);
    CHECK(machine.tick.control().state == control::CutState::hold);
    CHECK(machine.tick.control().fault == control::Fault::none);
}

TEST(TickOnSeldomLoad, begins_to_wait_again_after_a_hold_and_after_a_break_of_the_encoder) {
    machine.run(6000);
    machine.load_stands_still = true;
    machine.run(1500);
    Machine held = machine;
    held.status.feed_hold = true;
    held.run(50);
    held.status.feed_hold = false;
    Machine broken = machine;
    broken.counted_more = 2'000'000;
    const int waits = machine.samples_until_a_fault();
    CHECK(held.samples_until_a_fault() > waits + 1400);
    CHECK(broken.samples_until_a_fault() > waits + 1400);
}

TEST(TickOnSeldomLoad, does_not_belong_to_a_feed_that_the_same_estimate_shows_for_the_first_time) {
    machine.run(6000);
    const float before_mm_s = machine.tick.estimate().feed_mm_s;
    CHECK(machine.tick.feed_is_settled());
    machine.program_share = 0.5F;  // as in a corner
    int samples = 0;
    while (samples < 200 && machine.tick.estimate().feed_mm_s > 0.9F * before_mm_s) {
        machine.run(1);
        ++samples;
    }
    CHECK(samples < 200);
    CHECK_FALSE(machine.tick.feed_is_settled());
}
