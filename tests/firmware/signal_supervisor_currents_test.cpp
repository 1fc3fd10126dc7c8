// SPDX-License-Identifier: Apache-2.0
#include "supervisor_bench.hpp"

#include <cmath>
#include <initializer_list>

#include <CppUTest/TestHarness.h>

namespace hal = millforce::hal;
using namespace millforce::test;

/// Currents that stand, and index pulses.
TEST_GROUP(SignalSupervisorCurrents){};

TEST(SignalSupervisorCurrents, finds_a_spindle_current_that_stands_in_air_and_in_the_cut) {
    for (const CutState state : {CutState::air, CutState::in_cut}) {
        Currents currents;
        CHECK(currents.noisy_spindle(600, state) == Fault::none);
        CHECK(currents.same(30, state) == Fault::none);
        CHECK(currents.same(10, state) == Fault::signal_stuck);
    }
}

TEST(SignalSupervisorCurrents, finds_a_spindle_current_that_stands_from_the_first_cut_on) {
    Currents currents;
    CHECK(currents.noisy_spindle(600, CutState::air) == Fault::none);
    CHECK(currents.same(30, CutState::in_cut) == Fault::none);
    CHECK(currents.same(10, CutState::in_cut) == Fault::signal_stuck);
}

TEST(SignalSupervisorCurrents, does_not_take_a_missing_spindle_current_for_one_that_stands) {
    for (const CutState taught_in : {CutState::air, CutState::in_cut}) {
        for (const CutState state : {CutState::air, CutState::in_cut}) {
            Currents currents;
            currents.noisy_spindle(600, taught_in);
            currents.sample().present ^= hal::mask(hal::Present::spindle_current);
            CHECK(currents.same(100, state) == Fault::none);
        }
    }
}

TEST(SignalSupervisorCurrents, does_not_judge_a_spindle_current_until_a_revolution_has_shown_a_speed) {
    Currents currents;
    currents.noisy_spindle(600, CutState::air);
    currents.supervisor().restart();
    CHECK(currents.same(100, CutState::air) == Fault::none);
    currents.turn();
    CHECK(currents.same(100, CutState::air) == Fault::signal_stuck);
}

TEST(SignalSupervisorCurrents, does_not_judge_a_current_in_air_by_what_a_cut_taught) {
    Currents currents;
    currents.noisy_spindle(1000, CutState::in_cut);
    CHECK(currents.same(100, CutState::air) == Fault::none);
}

TEST(SignalSupervisorCurrents, does_not_judge_a_current_in_the_cut_by_air_once_a_cut_has_taught) {
    Currents currents;
    currents.noisy_spindle(600, CutState::air);
    CHECK(currents.noisy_spindle(300 * 20, CutState::in_cut, 20) == Fault::none);
    CHECK(currents.same(100, CutState::in_cut) == Fault::none);
    CHECK(currents.same(100, CutState::in_cut) == Fault::signal_stuck);
}

TEST(SignalSupervisorCurrents, finds_the_current_of_either_axis_that_stands_in_a_cut) {
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
        Currents currents;
        currents.sample().axis_velocity_mm_s = {feed_mm_s, -feed_mm_s, 0.0F};
        CHECK(currents.noisy_axis(axis, 600, CutState::in_cut) == Fault::none);
        CHECK(currents.same(40, CutState::in_cut) == Fault::signal_stuck);
    }
}

TEST(SignalSupervisorCurrents, lets_the_current_of_an_axis_stand_that_rests_or_is_out_of_the_cut_or_not_measured) {
    const auto stands = [](CutState state, float velocity_mm_s, std::uint8_t present) {
        Currents currents;
        currents.noisy_axis(0, 600, CutState::in_cut);
        currents.sample().axis_velocity_mm_s[0] = velocity_mm_s;
        currents.sample().present = present;
        return currents.same(100, state);
    };
    constexpr auto without_x = static_cast<std::uint8_t>(hal::all_present ^ hal::mask(hal::Present::x_axis));
    CHECK(stands(CutState::in_cut, feed_mm_s, hal::all_present) == Fault::signal_stuck);
    CHECK(stands(CutState::in_cut, 0.5F, hal::all_present) == Fault::none);
    CHECK(stands(CutState::air, feed_mm_s, hal::all_present) == Fault::none);
    CHECK(stands(CutState::in_cut, feed_mm_s, without_x) == Fault::none);
}

TEST(SignalSupervisorCurrents, after_a_reset_finds_a_current_that_stands_by_as_many_samples_as_before) {
    Currents currents;
    currents.noisy_axis(0, 600, CutState::in_cut);
    CHECK(currents.same(40, CutState::in_cut) == Fault::signal_stuck);
    currents.supervisor().reset();
    CHECK(currents.same(30, CutState::in_cut) == Fault::none);
    CHECK(currents.same(10, CutState::in_cut) == Fault::signal_stuck);
}

TEST(SignalSupervisorCurrents, does_not_judge_the_first_index_pulse) {
    Supervisor supervisor(machine_and_tool());
    CHECK(of_index_pulses(supervisor, 3, 1U, 8192U) == Fault::none);  // two intervals
    Supervisor another(machine_and_tool());
    CHECK(of_index_pulses(another, 4, 1U, 8192U) == Fault::encoder_mismatch);
}

TEST(SignalSupervisorCurrents, does_not_judge_two_index_pulses_of_which_one_between_was_missed) {
    Supervisor supervisor(machine_and_tool());
    CHECK(of_index_pulses(supervisor, 20, 2U, 8192U) == Fault::none);
}

TEST(SignalSupervisorCurrents, does_not_judge_index_pulses_without_a_count) {
    Supervisor supervisor(machine_and_tool());
    constexpr auto without_count = static_cast<std::uint8_t>(hal::all_present ^ hal::mask(hal::Present::spindle_count));
    CHECK(of_index_pulses(supervisor, 20, 1U, 8192U, without_count) == Fault::none);
}

TEST(SignalSupervisorCurrents, lets_the_speed_of_the_spindle_double_out_of_the_cut_where_a_spindle_can) {
    for (const float speed_rad_s : {150.0F, 800.0F}) {
        Estimate e = one_tooth();
        e.spindle_speed_rad_s = speed_rad_s;
        Supervisor supervisor(machine_and_tool());
        for (const float ratio : {1.0F, 1.5F, 2.0F, 2.0F, 1.0F}) {
            e.tooth_change.speed_ratio = ratio;
            supervisor.judge(e, {}, CutState::air, true);
        }
        CHECK(supervisor.fault() == (speed_rad_s < 200.0F ? Fault::none : Fault::encoder_mismatch));
    }
}

/// Each tooth's speed over that a revolution before.
static Fault of_speeds_in_air(float speed_rad_s, std::initializer_list<float> ratios) {
    Estimate e = one_tooth();
    e.spindle_speed_rad_s = speed_rad_s;
    Supervisor supervisor(machine_and_tool());
    for (const float ratio : ratios) {
        e.tooth_change.speed_ratio = ratio;
        judged(supervisor, e, 1);
    }
    return supervisor.fault();
}

TEST(SignalSupervisorCurrents, lets_a_spindle_gain_three_tenths_in_each_revolution_but_not_within_two_teeth) {
    CHECK(of_speeds_in_air(600.0F, {1.0F, 1.1F, 1.2F, 1.3F, 1.3F, 1.3F, 1.3F}) == Fault::none);
    CHECK(of_speeds_in_air(600.0F, {1.0F, 1.3F, 1.3F}) == Fault::encoder_mismatch);
}

TEST(SignalSupervisorCurrents, lets_the_teeth_of_a_fast_spindle_seem_unequal_by_a_tenth) {
    CHECK(of_speeds_in_air(2000.0F, {1.0F, 1.1F, 1.1F, 1.0F}) == Fault::none);
    CHECK(of_speeds_in_air(2000.0F, {1.0F, 1.3F, 1.3F, 1.0F}) == Fault::encoder_mismatch);
}

TEST(SignalSupervisorCurrents, lets_the_speed_of_the_spindle_change_at_once_out_of_the_cut_alone) {
    Estimate even = one_tooth();
    even.spindle_speed_rad_s = 150.0F;  // a fast spindle cannot
    for (const float ratio : {0.6F, 1.5F}) {
        Estimate e = even;
        e.tooth_change.speed_ratio = ratio;
        for (const CutState state : {CutState::air, CutState::in_cut}) {
            Supervisor supervisor(machine_and_tool());
            judged(supervisor, even, 8, state);
            judged(supervisor, e, 2, state);
            CHECK(judged(supervisor, even, 6, state) ==
                  (state == CutState::air ? Fault::none : Fault::encoder_mismatch));
        }
    }
}

TEST(SignalSupervisorCurrents, does_not_take_a_sample_with_a_wrong_time_for_a_speed) {
    for (const CutState state : {CutState::air, CutState::in_cut}) {
        Supervisor supervisor(machine_and_tool());
        Estimate e = one_tooth();
        for (const float ratio : {1.0F, 0.5F, 3.0F, 1.0F, 1.0F, 2.0F, 0.3F, 1.0F}) {
            e.tooth_change.speed_ratio = ratio;
            supervisor.judge(e, {}, state, true);
        }
        CHECK(supervisor.fault() == Fault::none);
    }
}
