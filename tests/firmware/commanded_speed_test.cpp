// SPDX-License-Identifier: Apache-2.0
#include "firmware/commanded_speed.hpp"

#include <limits>

#include <CppUTest/TestHarness.h>

#include "firmware/tick_bench.hpp"
#include "supervisor_bench.hpp"

namespace hal = millforce::hal;
using namespace millforce::test;
using millforce::control::Fault;
using millforce::firmware::ForceControlTick;
using millforce::firmware::step_and_work;

namespace {

constexpr float window_s = 0.01F;

struct Spindle {
    millforce::firmware::CommandedSpeed<float> watched{};

    /// Whether the command was missed at the end of so many seconds.
    bool turns(float commanded_rad_s, float speed_rad_s, float duration_s) {
        bool is_missed = false;
        for (float time_s = 0.0F; time_s < duration_s; time_s += window_s) {
            is_missed = watched.is_missed(commanded_rad_s, speed_rad_s, window_s);
        }
        return is_missed;
    }
};

constexpr float turns_at_rad_s = 418.9F;  // 4000/min, of sample_of()

/// Of a move through air.
Fault fault_of(float commanded_rad_s, bool is_rapid) {
    ForceControlTick<float> tick = fresh_tick();
    for (int k = 0; k < 1400; ++k) {
        hal::DriveSample sample = sample_of(k);
        sample.spindle_current_A = sample_of(0).spindle_current_A;
        sample.axis_current_A = sample_of(0).axis_current_A;
        hal::ProgramStatus status = program();
        status.rapid = is_rapid;
        status.commanded_speed_rad_s = commanded_rad_s;
        (void)step_and_work(tick, sample, status);
    }
    return tick.control().fault;
}

hal::ProgramStatus program_with_half_the_speed() {
    hal::ProgramStatus status = program();
    status.commanded_speed_rad_s = 0.5F * turns_at_rad_s;
    return status;
}

/// Of a supervisor, after so many revolutions of 15 ms in air.
Fault after_revolutions_at_twice_the_command(Supervisor& supervisor, int revolutions, float feed = feed_mm_s) {
    Estimate e = revolution();
    e.feed_mm_s = feed;
    return judged(supervisor, e, revolutions, CutState::air, program_with_half_the_speed());
}

}  // namespace

TEST_GROUP(CommandedSpeed){};

TEST(CommandedSpeed, is_missed_by_an_encoder_whose_counts_are_taken_four_times) {
    for (const float taken : {4.0F, 2.0F, 0.5F, 0.25F}) {
        Spindle spindle;
        CHECK_FALSE(spindle.turns(300.0F, taken * 300.0F, 1.0F));
        CHECK_TRUE(spindle.turns(300.0F, taken * 300.0F, 0.1F));
    }
}

TEST(CommandedSpeed, leaves_a_converter_its_slip) {
    CHECK_FALSE(Spindle().turns(300.0F, 285.0F, 10.0F));
    CHECK_FALSE(Spindle().turns(300.0F, 345.0F, 10.0F));
    CHECK_TRUE(Spindle().turns(300.0F, 230.0F, 10.0F));
}

TEST(CommandedSpeed, waits_for_a_spindle_that_runs_up_within_ten_seconds) {
    Spindle spindle;
    bool is_missed = false;
    for (float speed_rad_s = 6.0F; speed_rad_s < 600.0F; speed_rad_s += 60.0F * window_s) {
        is_missed = is_missed || spindle.watched.is_missed(600.0F, speed_rad_s, window_s);
    }
    CHECK_FALSE(is_missed);
    CHECK_FALSE(spindle.turns(600.0F, 600.0F, 5.0F));
}

TEST(CommandedSpeed, begins_anew_where_another_speed_is_told) {
    Spindle spindle;
    CHECK_FALSE(spindle.turns(300.0F, 300.0F, 5.0F));
    CHECK_FALSE(spindle.turns(600.0F, 300.0F, 1.0F));
    CHECK_TRUE(spindle.turns(600.0F, 300.0F, 0.1F));
}

TEST(CommandedSpeed, that_is_missed_holds_the_feed_of_a_feed_move_and_not_of_a_rapid) {
    CHECK(fault_of(0.25F * turns_at_rad_s, false) == Fault::encoder_mismatch);
    CHECK(fault_of(0.25F * turns_at_rad_s, true) == Fault::none);
    CHECK(fault_of(turns_at_rad_s, false) == Fault::none);
}

TEST(CommandedSpeed, that_is_not_told_or_no_speed_says_nothing) {
    for (const float commanded_rad_s : {0.0F, -turns_at_rad_s, std::numeric_limits<float>::quiet_NaN()}) {
        CHECK(fault_of(commanded_rad_s, false) == Fault::none);
    }
}

TEST(CommandedSpeed, must_be_missed_for_a_second_on_end_without_a_restart_or_a_time_without_a_command) {
    Supervisor supervisor(machine_and_tool());
    CHECK(after_revolutions_at_twice_the_command(supervisor, 60) == Fault::none);
    supervisor.restart();
    CHECK(after_revolutions_at_twice_the_command(supervisor, 60) == Fault::none);
    CHECK(judged(supervisor, revolution(), 1, CutState::air, program()) == Fault::none);
    CHECK(after_revolutions_at_twice_the_command(supervisor, 60) == Fault::none);
    CHECK(after_revolutions_at_twice_the_command(supervisor, 10) == Fault::encoder_mismatch);
}

TEST(CommandedSpeed, that_is_missed_while_the_axes_rest_is_a_fault_as_soon_as_they_move) {
    Supervisor supervisor(machine_and_tool());
    CHECK(after_revolutions_at_twice_the_command(supervisor, 200, 0.0F) == Fault::none);
    CHECK(after_revolutions_at_twice_the_command(supervisor, 1) == Fault::encoder_mismatch);
}
