// SPDX-License-Identifier: Apache-2.0
#include "supervisor_bench.hpp"

#include <CppUTest/TestHarness.h>

namespace hal = millforce::hal;
using namespace millforce::test;

namespace {

constexpr float leapt_N = 150.0F;

Estimate light_cut(float feed_N = -50.0F) {
    Estimate e = revolution();
    e.tangential_N = known_N(100.0F);
    e.feed_N = known_N(feed_N);
    return e;
}

}  // namespace

/// The axes against the spindle, the feed against the program, over revolutions.
TEST_GROUP(SignalSupervisorAxes){};

TEST(SignalSupervisorAxes, counts_revolutions_and_not_teeth) {
    Supervisor supervisor(machine_and_tool());
    Estimate e = one_tooth();
    e.tangential_N.value = -500.0F;
    CHECK(judged(supervisor, e, 15) == Fault::none);  // of the first revolution only the speed is taken
    CHECK(judged(supervisor, e, 1) == Fault::negative_torque);
}

TEST(SignalSupervisorAxes, counts_revolutions_anew_after_a_reset) {
    Supervisor supervisor(machine_and_tool());
    Estimate e = revolution();
    e.tangential_N.value = -500.0F;
    judged(supervisor, e, 3);
    supervisor.reset();
    CHECK(judged(supervisor, e, 3) == Fault::none);
    CHECK(judged(supervisor, e, 1) == Fault::negative_torque);
}

TEST(SignalSupervisorAxes, finds_a_small_negative_torque_in_the_mean_of_sixteen_revolutions_of_a_feed_move) {
    Estimate e = revolution();
    e.tangential_N = {.valid = true, .value = -30.0F, .variance = 100.0F, .noise = 99.0F};
    Supervisor supervisor(machine_and_tool());
    CHECK(judged(supervisor, e, 16) == Fault::none);  // of the first revolution only the speed is taken
    CHECK(judged(supervisor, e, 1) == Fault::negative_torque);
    Supervisor interrupted(machine_and_tool());
    hal::ProgramStatus rapid = program();
    rapid.rapid = true;
    for (int k = 0; k < 10; ++k) {
        CHECK(judged(interrupted, e, 15) == Fault::none);
        CHECK(judged(interrupted, e, 2, CutState::air, rapid) == Fault::none);
    }
}

TEST(SignalSupervisorAxes, does_not_take_what_drift_explains_or_is_below_the_contact_level_for_a_negative_torque) {
    Estimate drifting = revolution();
    drifting.tangential_N = {.valid = true, .value = -30.0F, .variance = 100.0F, .noise = 20.0F};
    Supervisor supervisor(machine_and_tool());
    CHECK(judged(supervisor, drifting, 100) == Fault::none);
    Estimate small = revolution();
    small.tangential_N.value = -19.0F;
    Supervisor another(machine_and_tool());
    CHECK(judged(another, small, 100) == Fault::none);
}

TEST(SignalSupervisorAxes, allows_a_torque_below_zero_what_may_have_been_learnt_in_a_light_cut) {
    for (const float value_N : {-30.0F, -200.0F}) {
        Estimate e = revolution();
        e.tangential_N.value = value_N;
        e.uncertain_idle_N = -value_N - 10.0F;
        Supervisor after_a_light_cut(machine_and_tool());
        CHECK(judged(after_a_light_cut, e, 100) == Fault::none);
        e.uncertain_idle_N = 0.0F;
        Supervisor after_air(machine_and_tool());
        CHECK(judged(after_air, e, 100) == Fault::negative_torque);
    }
}

TEST(SignalSupervisorAxes, does_not_judge_a_torque_that_is_not_known_or_of_a_spindle_that_changes_its_speed) {
    Supervisor supervisor(machine_and_tool());
    Estimate unknown = revolution();
    unknown.tangential_N.value = -500.0F;
    unknown.tangential_N.valid = false;
    CHECK(judged(supervisor, unknown, 20) == Fault::none);
    for (const float growth : {0.99F, 1.01F}) {
        Supervisor another(machine_and_tool());
        Estimate e = revolution();
        e.tangential_N.value = -500.0F;
        for (int k = 0; k < 20; ++k) {
            e.spindle_speed_rad_s *= growth;
            CHECK(judged(another, e, 1) == Fault::none);
        }
    }
}

TEST(SignalSupervisorAxes, takes_the_least_force_of_a_move_in_air_for_its_friction) {
    Supervisor supervisor(machine_and_tool());
    Estimate e = revolution();
    e.feed_N = known_N(100.0F);
    CHECK(judged(supervisor, e, 20) == Fault::none);
    e.feed_N = known_N(50.0F);
    CHECK(judged(supervisor, e, 20) == Fault::none);
    e.feed_N = known_N(100.0F);
    CHECK(judged(supervisor, e, 2) == Fault::none);
    CHECK(judged(supervisor, e, 1) == Fault::forces_contradict);
}

TEST(SignalSupervisorAxes, allows_the_axes_no_friction_beyond_the_known_one_where_a_cut_has_just_ended) {
    for (const float force_N : {-100.0F, 100.0F}) {
        Supervisor supervisor(machine_and_tool());
        Estimate e = revolution();
        e.feed_N = known_N(force_N);
        CHECK(judged(supervisor, e, 20) == Fault::none);
        CHECK(judged(supervisor, e, 3, CutState::exit) == Fault::forces_contradict);
    }
}

TEST(SignalSupervisorAxes, does_not_compare_the_axes_with_the_torque_in_a_cut_a_rapid_or_an_unsteady_move) {
    Estimate e = revolution();
    e.feed_N = known_N(100.0F);
    hal::ProgramStatus rapid = program();
    rapid.rapid = true;
    Supervisor in_a_rapid(machine_and_tool());
    CHECK(judged(in_a_rapid, e, 20, CutState::exit, rapid) == Fault::none);
    Supervisor in_a_cut(machine_and_tool());
    e.feed_N = known_N(1000.0F);
    CHECK(judged(in_a_cut, e, 20, CutState::in_cut) == Fault::none);
    Supervisor unsteady(machine_and_tool());
    e.tooth_change.feed_is_steady = false;
    CHECK(judged(unsteady, e, 20, CutState::exit) == Fault::none);
    Supervisor without_torque(machine_and_tool());
    e = revolution();
    e.feed_N = known_N(100.0F);
    e.tangential_N.valid = false;
    CHECK(judged(without_torque, e, 20, CutState::exit) == Fault::none);
}

TEST(SignalSupervisorAxes, lets_the_force_along_the_feed_grow_alone_within_a_cut_and_not_in_air) {
    const auto fault_in = [](CutState state) {
        Supervisor supervisor(machine_and_tool());
        Estimate e = revolution();
        for (int k = 0; k < 20; ++k) {
            e.feed_N = {.valid = true, .value = 50.0F * static_cast<float>(k), .variance = 400.0F, .noise = 400.0F};
            judged(supervisor, e, 1, state);
        }
        return supervisor.fault();
    };
    CHECK(fault_in(CutState::in_cut) == Fault::none);
    CHECK(fault_in(CutState::air) == Fault::forces_contradict);
}

TEST(SignalSupervisorAxes, lets_the_axes_carry_twice_the_torque_and_never_less_than_none) {
    Estimate e = revolution();
    e.tangential_N.value = 100.0F;
    e.feed_N = known_N(200.0F);
    Supervisor supervisor(machine_and_tool());
    CHECK(judged(supervisor, e, 20, CutState::exit) == Fault::none);
    e.feed_N = known_N(230.0F);
    CHECK(judged(supervisor, e, 3, CutState::exit) == Fault::forces_contradict);
    Supervisor below_idle(machine_and_tool());
    e.tangential_N.value = -15.0F;
    e.feed_N = known_N(0.0F);
    CHECK(judged(below_idle, e, 20, CutState::exit) == Fault::none);
}

TEST(SignalSupervisorAxes, finds_a_feed_force_that_is_lost_in_the_move_in_which_it_was_known) {
    Estimate lost = revolution();
    lost.axis_is_implausible = true;
    Supervisor never_known(machine_and_tool());
    CHECK(judged(never_known, lost, 20) == Fault::none);
    Supervisor known(machine_and_tool());
    Estimate e = revolution();
    e.feed_N = known_N(10.0F);
    CHECK(judged(known, e, 1 + 256) == Fault::none);
    CHECK(judged(known, lost, 2) == Fault::none);
    CHECK(judged(known, lost, 1) == Fault::forces_contradict);
}

TEST(SignalSupervisorAxes, lets_the_feed_force_be_unknown_where_an_arc_slows_one_axis_down) {
    const Estimate unknown = revolution();
    Supervisor supervisor(machine_and_tool());
    Estimate e = revolution();
    e.feed_N = known_N(10.0F);
    CHECK(judged(supervisor, e, 1 + 256) == Fault::none);
    CHECK(judged(supervisor, unknown, 256) == Fault::none);
}

TEST(SignalSupervisorAxes, gives_the_cnc_the_time_to_slow_down_that_its_acceleration_takes) {
    Parameters p = machine_and_tool();
    Estimate e = revolution();
    e.feed_mm_s = 100.0F;
    hal::ProgramStatus slow = program();
    slow.programmed_feed_mm_s = 10.0F;
    p.machine.cnc.acceleration_mm_s2 = 200.0F;
    Supervisor supervisor(p);
    CHECK(judged(supervisor, e, 43, CutState::air, slow) == Fault::none);  // 0.01 s + 0.15 s + 0.5 s
    CHECK(judged(supervisor, e, 2, CutState::air, slow) == Fault::feed_mismatch);
}

TEST(SignalSupervisorAxes, errs_towards_a_fault_without_a_diameter_or_an_acceleration) {
    Parameters p = machine_and_tool();  // such parameters are refused elsewhere
    p.tool.diameter_mm = 0.0F;
    p.machine.cnc.acceleration_mm_s2 = 0.0F;
    Supervisor of_feed(p);
    Estimate e = revolution();
    e.feed_mm_s = 100.0F;
    hal::ProgramStatus slow = program();
    slow.programmed_feed_mm_s = 10.0F;
    CHECK(judged(of_feed, e, 10, CutState::air, slow) == Fault::none);
    CHECK(judged(of_feed, e, 2, CutState::air, slow) == Fault::feed_mismatch);
    Supervisor of_force(p);
    judged(of_force, one_tooth(), 8, CutState::in_cut);
    judged(of_force, fallen_force(), 1, CutState::in_cut);
    CHECK(judged(of_force, one_tooth(), 6, CutState::in_cut) == Fault::force_vanished);
}

TEST(SignalSupervisorAxes, does_not_judge_the_feed_in_a_rapid_or_where_the_program_s_is_not_known) {
    Estimate e = revolution();
    e.feed_mm_s = 100.0F;
    hal::ProgramStatus unknown = program();
    unknown.programmed_feed_mm_s = 0.0F;
    Supervisor supervisor(machine_and_tool());
    CHECK(judged(supervisor, e, 100, CutState::air, unknown) == Fault::none);
    hal::ProgramStatus rapid = program();
    rapid.rapid = true;
    CHECK(judged(supervisor, e, 100, CutState::air, rapid) == Fault::none);
    CHECK(judged(supervisor, e, 100) == Fault::feed_mismatch);
}

TEST(SignalSupervisorAxes, finds_a_force_along_the_feed_that_leaps_in_a_light_cut_as_it_begins) {
    const auto fault_of = [](CutState state,
                             const millforce::firmware::Parameters<float>& parameters = machine_and_tool()) {
        Supervisor supervisor(parameters);
        judged(supervisor, light_cut(), 6, state);
        CHECK(judged(supervisor, light_cut(leapt_N), 2, state) == Fault::none);
        return judged(supervisor, light_cut(leapt_N), 4, state);
    };
    CHECK(fault_of(CutState::entry) == Fault::force_jumped);
    CHECK(fault_of(CutState::in_cut) == Fault::force_jumped);
    CHECK(fault_of(CutState::air) != Fault::force_jumped);
    auto with_late_load = machine_and_tool();
    with_late_load.machine.spindle_load_period_s = 0.1F;
    CHECK(fault_of(CutState::in_cut, with_late_load) == Fault::none);
}

TEST(SignalSupervisorAxes, does_not_take_a_change_of_feed_for_a_leap) {
    Estimate slower = light_cut();
    slower.tooth_change.feed_is_steady = slower.tooth_change.feed_is_alike = false;
    Supervisor brakes_first(machine_and_tool());
    judged(brakes_first, light_cut(), 6, CutState::in_cut);
    judged(brakes_first, light_cut(-250.0F), 2, CutState::in_cut);
    judged(brakes_first, slower, 1, CutState::in_cut);
    CHECK(judged(brakes_first, light_cut(), 20, CutState::in_cut) == Fault::none);
}

TEST(SignalSupervisorAxes, leaves_room_in_a_leap_for_the_inertia_of_either_axis) {
    const auto fault_with_masses = [](float x_kg, float y_kg) {
        auto parameters = machine_and_tool();
        parameters.machine.axes[0].mass_kg = x_kg;
        parameters.machine.axes[1].mass_kg = y_kg;
        Supervisor supervisor(parameters);
        judged(supervisor, light_cut(), 6, CutState::in_cut);
        return judged(supervisor, light_cut(leapt_N), 6, CutState::in_cut);
    };
    CHECK(fault_with_masses(0.0F, 0.0F) == Fault::force_jumped);
    CHECK(fault_with_masses(1000.0F, 0.0F) == Fault::none);  // at 0.2 × 20 mm/s × 66.7/s: 267 N
    CHECK(fault_with_masses(0.0F, 1000.0F) == Fault::none);
}

TEST(SignalSupervisorAxes, takes_no_change_of_force_across_a_restart_for_a_leap) {
    Estimate late = light_cut(leapt_N);
    late.tooth_periods = 8;
    for (const bool restarts : {false, true}) {
        Supervisor supervisor(machine_and_tool());
        judged(supervisor, light_cut(), 6, CutState::in_cut);
        if (restarts) {
            supervisor.restart();
        }
        CHECK(judged(supervisor, late, 6, CutState::in_cut) == (restarts ? Fault::none : Fault::force_jumped));
    }
}
