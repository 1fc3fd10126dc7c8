// SPDX-License-Identifier: Apache-2.0
#include "supervisor_bench.hpp"

#include <cmath>

#include <CppUTest/TestHarness.h>

namespace hal = millforce::hal;
using namespace millforce::test;

/// Forces that vanish or jump from one tooth to the next.
TEST_GROUP(SignalSupervisorForces){};

TEST(SignalSupervisorForces, finds_a_force_that_vanishes_in_the_cut_alone) {
    CHECK(of_change(fallen_force(), 8, CutState::in_cut) == Fault::force_vanished);
    CHECK(of_change(fallen_force(), 8, CutState::air) == Fault::none);
}

TEST(SignalSupervisorForces, takes_no_force_for_sudden_while_a_cut_begins) {
    Estimate jump = one_tooth();
    jump.tooth_tangential_N = known_N(250.0F);
    jump.tooth_change.tangential_N = known_N(0.0F);
    jump.tooth_change.axis_N[0] = known_N(2000.0F);
    for (const Estimate& change : {jump, fallen_force()}) {
        CHECK(of_change(change, 8, CutState::in_cut) != Fault::none);
        CHECK(of_change(change, 8, CutState::entry) == Fault::none);
    }
}

TEST(SignalSupervisorForces, does_not_judge_a_force_until_the_feed_was_steady_for_a_revolution_and_three_teeth) {
    CHECK(of_change(fallen_force(), 6) == Fault::none);
    CHECK(of_change(fallen_force(), 7) == Fault::force_vanished);
    Estimate slower = fallen_force();
    slower.tooth_change.feed_is_steady = false;
    CHECK(of_change(slower) == Fault::none);
    Estimate ramp = fallen_force();
    ramp.axial_speed_mm_s = 0.1F * feed_mm_s;
    CHECK(of_change(ramp) == Fault::none);
}

TEST(SignalSupervisorForces, forgets_a_force_that_vanished_where_the_feed_changes_within_a_revolution) {
    Supervisor supervisor(machine_and_tool());
    judged(supervisor, one_tooth(), 8, CutState::in_cut);
    judged(supervisor, fallen_force(), 1, CutState::in_cut);
    Estimate slower = one_tooth();
    slower.tooth_change.feed_is_steady = false;
    judged(supervisor, slower, 1, CutState::in_cut);
    CHECK(judged(supervisor, one_tooth(), 100, CutState::in_cut) == Fault::none);
}

TEST(SignalSupervisorForces, finds_a_force_that_vanishes_at_a_feed_that_varies_where_the_feed_cannot_explain_it) {
    const auto of_fall = [](float fall_N, bool is_alike) {
        Estimate varies = one_tooth();
        varies.tooth_change.feed_is_steady = false;
        varies.tooth_change.feed_is_alike = is_alike;
        Estimate fall = varies;
        fall.tooth_tangential_N = known_N(250.0F - fall_N);
        fall.tooth_change.tangential_N = known_N(-fall_N);
        Supervisor supervisor(machine_and_tool());
        return of_change_among(supervisor, varies, fall);
    };
    CHECK(of_fall(245.0F, true) == Fault::force_vanished);
    CHECK(of_fall(245.0F, false) == Fault::none);
    const float by_a_lower_feed_N = 0.3F * 250.0F;
    CHECK(of_fall(245.0F - by_a_lower_feed_N, true) == Fault::none);
}

TEST(SignalSupervisorForces, does_not_judge_a_force_at_a_feed_that_varies_on_a_ramp_or_before_the_feed_has_settled) {
    Estimate varies = one_tooth();
    varies.tooth_change.feed_is_alike = true;
    varies.tooth_change.feed_is_steady = false;
    Estimate fall = fallen_force();
    fall.tooth_change.tangential_N = known_N(-245.0F);
    fall.tooth_tangential_N = known_N(5.0F);
    fall.tooth_change.feed_is_alike = true;
    fall.tooth_change.feed_is_steady = false;
    const auto of_fall = [&](float axial_speed_mm_s, bool feed_is_settled) {
        fall.axial_speed_mm_s = axial_speed_mm_s;
        Supervisor supervisor(machine_and_tool());
        judged(supervisor, varies, 8, CutState::in_cut);
        supervisor.judge(fall, program(), CutState::in_cut, feed_is_settled);
        return judged(supervisor, varies, 6, CutState::in_cut);
    };
    CHECK(of_fall(0.0F, true) == Fault::force_vanished);
    CHECK(of_fall(0.1F * feed_mm_s, true) == Fault::none);
    CHECK(of_fall(0.0F, false) == Fault::none);
}

TEST(SignalSupervisorForces, lets_a_bent_tool_spring_back_for_two_tenths_of_a_millimetre_behind_a_sharp_turn) {
    Estimate slow = one_tooth();
    slow.feed_per_tooth_mm = 0.01F;
    Estimate turn = slow;
    turn.tooth_change.feed_is_new = true;
    turn.tooth_change.feed_is_steady = false;
    Estimate fall = fallen_force();
    fall.feed_per_tooth_mm = slow.feed_per_tooth_mm;
    const auto of_fall_behind = [&](int teeth) {
        Supervisor supervisor(machine_and_tool());
        judged(supervisor, turn, 1, CutState::in_cut);
        return of_change_among(supervisor, slow, fall, teeth);
    };
    CHECK(of_fall_behind(18) == Fault::none);
    CHECK(of_fall_behind(21) == Fault::force_vanished);
}

TEST(SignalSupervisorForces, needs_four_deviations_of_a_load_that_is_held) {
    const auto of_fall = [](float period_s, float sd_N) {
        auto parameters = machine_and_tool();
        parameters.machine.spindle_load_period_s = period_s;
        Supervisor supervisor(parameters);
        Estimate slow = one_tooth();  // 0.2 mm in a reading
        slow.feed_mm_s = 2.0F;
        slow.feed_per_tooth_mm = 0.0075F;
        Estimate fall = slow;
        fall.tooth_tangential_N = known_N(0.0F);
        fall.tooth_change.tangential_N = {.valid = true, .value = -250.0F, .variance = sd_N * sd_N};
        return of_change_among(supervisor, slow, fall);
    };
    CHECK(of_fall(0.1F, 25.0F) == Fault::force_vanished);
    CHECK(of_fall(0.1F, 60.0F) == Fault::none);
    CHECK(of_fall(0.0F, 25.0F) == Fault::force_vanished);
    CHECK(of_fall(0.0F, 28.0F) == Fault::none);
}

TEST(SignalSupervisorForces, does_not_take_a_force_for_vanished_that_is_not_known_or_was_none) {
    Estimate e = fallen_force();
    e.tooth_change.tangential_N.valid = false;
    CHECK(of_change(e) == Fault::none);
    e = fallen_force();
    e.tooth_tangential_N.value = -300.0F;  // and was −100 N before
    CHECK(of_change(e) == Fault::none);
}

TEST(SignalSupervisorForces, does_not_take_the_next_value_of_a_load_that_comes_seldom_for_a_force_that_vanishes) {
    auto parameters = machine_and_tool();
    parameters.machine.spindle_load_period_s = 0.1F;
    Supervisor supervisor(parameters);
    judged(supervisor, one_tooth(), 8, CutState::in_cut);
    judged(supervisor, fallen_force(), 1, CutState::in_cut);
    CHECK(judged(supervisor, one_tooth(), 6, CutState::in_cut) == Fault::none);
}

TEST(SignalSupervisorForces, takes_a_load_that_does_not_answer_the_feed_for_a_signal_that_is_stuck) {
    Supervisor supervisor(machine_and_tool());
    supervisor.judge_load(false);
    CHECK(supervisor.fault() == Fault::none);
    supervisor.judge_load(true);
    CHECK(supervisor.fault() == Fault::signal_stuck);
}

TEST(SignalSupervisorForces, does_not_judge_a_force_of_an_earlier_feed) {
    Supervisor supervisor(machine_and_tool());
    judged(supervisor, one_tooth(), 8, CutState::in_cut);
    constexpr bool feed_is_settled = false;
    supervisor.judge(fallen_force(), program(), CutState::in_cut, feed_is_settled);
    CHECK(judged(supervisor, one_tooth(), 6, CutState::in_cut) == Fault::none);
}

TEST(SignalSupervisorForces, does_not_take_the_late_load_of_a_cut_for_contact_in_the_rapid_behind_it) {
    Estimate loaded = revolution();
    loaded.tangential_N = known_N(300.0F);
    hal::ProgramStatus rapid = program();
    rapid.rapid = true;
    for (const bool feed_is_settled : {false, true}) {
        Supervisor supervisor(machine_and_tool());
        for (int k = 0; k < 6; ++k) {
            supervisor.judge(loaded, rapid, CutState::in_cut, feed_is_settled);
        }
        CHECK((supervisor.fault() == Fault::contact_in_rapid) == feed_is_settled);
    }
}

TEST(SignalSupervisorForces, does_not_take_noise_for_a_force_that_vanishes) {
    Estimate e = fallen_force();
    e.tooth_change.tangential_N.variance = 20.0F * 20.0F;  // it fell by 88 N more than a cut's end explains
    CHECK(of_change(e) == Fault::none);
    e.tooth_change.tangential_N.variance = 10.0F * 10.0F;
    CHECK(of_change(e) == Fault::force_vanished);
}

TEST(SignalSupervisorForces, finds_a_jump_of_either_axis_in_either_direction_where_it_is_known) {
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
        for (const float jump_N : {-2000.0F, 2000.0F}) {
            Estimate e = one_tooth();
            e.tooth_tangential_N = known_N(250.0F);
            e.tooth_change.tangential_N = known_N(0.0F);
            e.tooth_change.axis_N[axis] = known_N(jump_N);
            CHECK(of_change(e) == Fault::force_jumped);
            e.tooth_change.axis_N[axis].valid = false;
            CHECK(of_change(e) == Fault::none);
        }
    }
}

TEST(SignalSupervisorForces, does_not_take_the_inertia_of_an_axis_for_a_jump) {
    auto parameters = machine_and_tool();
    for (auto& axis : parameters.machine.axes) {
        axis.mass_kg = 0.0F;
    }
    Estimate e = one_tooth();
    e.tooth_tangential_N = known_N(250.0F);
    e.tooth_change.tangential_N = known_N(0.0F);
    e.tooth_change.axis_N[0] = known_N(700.0F);
    const auto judge = [&] {
        Supervisor supervisor(parameters);
        judged(supervisor, one_tooth(), 8, CutState::in_cut);
        judged(supervisor, e, 1, CutState::in_cut);
        return judged(supervisor, one_tooth(), 6, CutState::in_cut);
    };
    CHECK(judge() == Fault::force_jumped);
    parameters.machine.axes[0].mass_kg = 320.0F;  // at 0.2 × 20 mm/s × 66.7/s: 85 N
    e.tooth_change.axis_N[0] = known_N(500.0F);
    const bool is_found_at_500_N = judge() == Fault::force_jumped;
    parameters.machine.axes[0].mass_kg = 2000.0F;
    CHECK(is_found_at_500_N);
    CHECK(judge() == Fault::none);
}

TEST(SignalSupervisorForces, compares_a_jump_with_the_larger_of_the_torques_before_and_after) {
    struct Torque {
        float now_N;
        float change_N;
    };
    for (const Torque torque : {Torque{250.0F, 200.0F}, Torque{150.0F, -100.0F}}) {
        Estimate e = one_tooth();
        e.tooth_tangential_N = known_N(torque.now_N);
        e.tooth_change.tangential_N = known_N(torque.change_N);
        e.tooth_change.axis_N[0] = known_N(250.0F);  // 0.45 · 2 · 250 N may be, and 67 N of inertia
        CHECK(of_change(e) == Fault::none);
    }
}

TEST(SignalSupervisorForces, does_not_judge_a_jump_where_a_tooth_goes_far_enough_to_leave_the_cut) {
    Estimate e = one_tooth();
    e.feed_per_tooth_mm = 1.0F;
    e.tooth_tangential_N = known_N(250.0F);
    e.tooth_change.tangential_N = known_N(0.0F);
    e.tooth_change.axis_N[0] = known_N(2000.0F);
    CHECK(of_change(e) == Fault::none);
}

TEST(SignalSupervisorForces, doubts_what_air_taught_where_the_fault_may_come_from_it) {
    Supervisor vanished(machine_and_tool());
    CHECK(of_change_among(vanished, one_tooth(), fallen_force()) == Fault::force_vanished);
    CHECK_FALSE(vanished.doubts_idle());
    Supervisor idle(machine_and_tool());
    CHECK_FALSE(idle.doubts_idle());
    idle.judge_idle(true, 1000);
    CHECK(idle.fault() == Fault::idle_torque);
    CHECK(idle.doubts_idle());
    Estimate loaded = revolution();
    loaded.tangential_N = known_N(300.0F);
    hal::ProgramStatus rapid = program();
    rapid.rapid = true;
    Supervisor in_rapid(machine_and_tool());
    CHECK(judged(in_rapid, loaded, 6, CutState::air, rapid) == Fault::contact_in_rapid);
    CHECK(in_rapid.doubts_idle());
    loaded.tangential_N = known_N(-300.0F);
    Supervisor negative(machine_and_tool());
    CHECK(judged(negative, loaded, 20) == Fault::negative_torque);
    CHECK(negative.doubts_idle());
}
