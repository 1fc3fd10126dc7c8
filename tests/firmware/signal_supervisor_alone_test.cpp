// SPDX-License-Identifier: Apache-2.0
#include "firmware/signal_supervisor.hpp"

#include <cmath>

#include <CppUTest/TestHarness.h>

#include "firmware/tick_bench.hpp"

// The supervisor without the tick: each estimate and each sample is made up.

namespace hal = millforce::hal;
using namespace millforce::test;
using millforce::control::CutState;
using millforce::control::Fault;
using Estimate = millforce::estimation::CutEstimate<float>;
using Force = millforce::estimation::Measurement<float>;
using Supervisor = millforce::firmware::SignalSupervisor<float>;

namespace {

Force known_N(float value) {
    return {.valid = true, .value = value, .variance = 1.0F};
}

/// One revolution of four teeth at 4000 rpm in 15 ms, in a steady level move without a force.
Estimate revolution() {
    Estimate e;
    e.tooth_periods = 4;
    e.tangential_N = known_N(0.0F);
    e.feed_mm_s = feed_mm_s;
    e.feed_per_tooth_mm = 0.075F;
    e.spindle_speed_rad_s = 418.88F;
    e.tooth_change.feed_is_steady = true;
    return e;
}

Estimate one_tooth() {
    Estimate e = revolution();
    e.tooth_periods = 1;
    return e;
}

/// One tooth after which a force of 250 N is 50 N.
Estimate fallen_force() {
    Estimate e = one_tooth();
    e.tooth_tangential_N = known_N(50.0F);
    e.tooth_change.tangential_N = known_N(-200.0F);
    return e;
}

Fault judged(Supervisor& supervisor, const Estimate& e, int times, CutState state = CutState::air,
             const hal::ProgramStatus& status = program()) {
    for (int k = 0; k < times; ++k) {
        supervisor.judge(e, status, state, true);
    }
    return supervisor.fault();
}

/// Of one tooth's change after `steady_teeth` without one, and a revolution later.
Fault of_change(const Estimate& change, int steady_teeth = 8, CutState state = CutState::in_cut) {
    Supervisor supervisor(machine_and_tool());
    judged(supervisor, one_tooth(), steady_teeth, state);
    judged(supervisor, change, 1, state);
    return judged(supervisor, one_tooth(), 6, state);
}

/// Index pulses from `number` on, `step` numbers and `counts` counts apart, each in one sample.
Fault of_index_pulses(Supervisor& supervisor, int pulses, unsigned step, std::uint32_t counts,
                      std::uint8_t present = hal::all_present) {
    hal::DriveSample sample;
    sample.present = present;
    for (int k = 0; k < pulses; ++k) {
        sample.spindle_index_number = static_cast<std::uint8_t>(1U + static_cast<unsigned>(k) * step);
        sample.spindle_index_count = 1'000'000U + static_cast<std::uint32_t>(k) * counts;
        supervisor.take(sample, 0.001F, CutState::air);
    }
    return supervisor.fault();
}

/// A spindle that turns and an x axis that moves, and what the supervisor says of their currents.
class Currents {
  public:
    Currents() {
        sample_.present = hal::all_present;
        sample_.axis_velocity_mm_s[0] = feed_mm_s;
        turn();
    }
    void turn() { judged(supervisor_, revolution(), 1); }
    Fault noisy_spindle(int samples, CutState state, int equal_values = 1) {
        return take(samples, state, equal_values, sample_.spindle_current_A);
    }
    Fault noisy_axis(std::size_t axis, int samples, CutState state) {
        return take(samples, state, 1, sample_.axis_current_A[axis]);
    }
    Fault same(int samples, CutState state) { return take(samples, state, samples, unused_); }
    hal::DriveSample& sample() { return sample_; }
    Supervisor& supervisor() { return supervisor_; }

  private:
    Fault take(int samples, CutState state, int equal_values, float& noisy_A) {
        for (int k = 0; k < samples; ++k) {
            ++count_;
            sample_.spindle_count += 273U;
            if (k % equal_values == 0) {
                noisy_A = 1.0F + 0.05F * std::sin(static_cast<float>(count_ * count_));
            }
            supervisor_.take(sample_, 0.001F, state);
        }
        return supervisor_.fault();
    }

    Supervisor supervisor_{machine_and_tool()};
    hal::DriveSample sample_{};
    float unused_ = 0.0F;
    int count_ = 0;
};

}  // namespace

TEST_GROUP(SignalSupervisorAlone){};

TEST(SignalSupervisorAlone, finds_a_spindle_current_that_stands_in_air_and_in_the_cut) {
    for (const CutState state : {CutState::air, CutState::in_cut}) {
        Currents currents;
        CHECK(currents.noisy_spindle(600, state) == Fault::none);
        CHECK(currents.same(30, state) == Fault::none);
        CHECK(currents.same(10, state) == Fault::signal_stuck);
    }
}

TEST(SignalSupervisorAlone, finds_a_spindle_current_that_stands_from_the_first_cut_on) {
    Currents currents;
    CHECK(currents.noisy_spindle(600, CutState::air) == Fault::none);
    CHECK(currents.same(30, CutState::in_cut) == Fault::none);
    CHECK(currents.same(10, CutState::in_cut) == Fault::signal_stuck);
}

TEST(SignalSupervisorAlone, does_not_take_a_missing_spindle_current_for_one_that_stands) {
    for (const CutState taught_in : {CutState::air, CutState::in_cut}) {
        for (const CutState state : {CutState::air, CutState::in_cut}) {
            Currents currents;
            currents.noisy_spindle(600, taught_in);
            currents.sample().present ^= hal::mask(hal::Present::spindle_current);
            CHECK(currents.same(100, state) == Fault::none);
        }
    }
}

TEST(SignalSupervisorAlone, does_not_judge_a_spindle_current_until_a_revolution_has_shown_a_speed) {
    Currents currents;
    currents.noisy_spindle(600, CutState::air);
    currents.supervisor().restart();
    CHECK(currents.same(100, CutState::air) == Fault::none);
    currents.turn();
    CHECK(currents.same(100, CutState::air) == Fault::signal_stuck);
}

TEST(SignalSupervisorAlone, does_not_judge_a_current_in_air_by_what_a_cut_taught) {
    Currents currents;
    currents.noisy_spindle(1000, CutState::in_cut);
    CHECK(currents.same(100, CutState::air) == Fault::none);
}

TEST(SignalSupervisorAlone, does_not_judge_a_current_in_the_cut_by_air_once_a_cut_has_taught) {
    Currents currents;
    currents.noisy_spindle(600, CutState::air);
    CHECK(currents.noisy_spindle(300 * 20, CutState::in_cut, 20) == Fault::none);
    CHECK(currents.same(100, CutState::in_cut) == Fault::none);
    CHECK(currents.same(100, CutState::in_cut) == Fault::signal_stuck);
}

TEST(SignalSupervisorAlone, finds_the_current_of_either_axis_that_stands_in_a_cut) {
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
        Currents currents;
        currents.sample().axis_velocity_mm_s = {feed_mm_s, -feed_mm_s, 0.0F};
        CHECK(currents.noisy_axis(axis, 600, CutState::in_cut) == Fault::none);
        CHECK(currents.same(40, CutState::in_cut) == Fault::signal_stuck);
    }
}

TEST(SignalSupervisorAlone, lets_the_current_of_an_axis_stand_that_rests_or_is_out_of_the_cut_or_not_measured) {
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

TEST(SignalSupervisorAlone, after_a_reset_finds_a_current_that_stands_by_as_many_samples_as_before) {
    Currents currents;
    currents.noisy_axis(0, 600, CutState::in_cut);
    CHECK(currents.same(40, CutState::in_cut) == Fault::signal_stuck);
    currents.supervisor().reset();
    CHECK(currents.same(30, CutState::in_cut) == Fault::none);
    CHECK(currents.same(10, CutState::in_cut) == Fault::signal_stuck);
}

TEST(SignalSupervisorAlone, does_not_judge_the_first_index_pulse) {
    Supervisor supervisor(machine_and_tool());
    CHECK(of_index_pulses(supervisor, 3, 1U, 8192U) == Fault::none);  // two intervals
    Supervisor another(machine_and_tool());
    CHECK(of_index_pulses(another, 4, 1U, 8192U) == Fault::encoder_mismatch);
}

TEST(SignalSupervisorAlone, does_not_judge_two_index_pulses_of_which_one_between_was_missed) {
    Supervisor supervisor(machine_and_tool());
    CHECK(of_index_pulses(supervisor, 20, 2U, 8192U) == Fault::none);
}

TEST(SignalSupervisorAlone, does_not_judge_index_pulses_without_a_count) {
    Supervisor supervisor(machine_and_tool());
    constexpr auto without_count = static_cast<std::uint8_t>(hal::all_present ^ hal::mask(hal::Present::spindle_count));
    CHECK(of_index_pulses(supervisor, 20, 1U, 8192U, without_count) == Fault::none);
}

TEST(SignalSupervisorAlone, lets_the_speed_of_the_spindle_change_at_once_out_of_the_cut_alone) {
    for (const float ratio : {0.6F, 1.5F}) {
        Estimate e = one_tooth();
        e.tooth_change.speed_ratio = ratio;
        CHECK(of_change(e, 8, CutState::air) == Fault::none);
        CHECK(of_change(e, 8, CutState::in_cut) == Fault::encoder_mismatch);
    }
}

TEST(SignalSupervisorAlone, finds_a_force_that_vanishes_in_the_cut_alone) {
    CHECK(of_change(fallen_force(), 8, CutState::in_cut) == Fault::force_vanished);
    CHECK(of_change(fallen_force(), 8, CutState::air) == Fault::none);
}

TEST(SignalSupervisorAlone, takes_no_force_for_sudden_while_a_cut_begins) {
    Estimate jump = one_tooth();
    jump.tooth_tangential_N = known_N(250.0F);
    jump.tooth_change.tangential_N = known_N(0.0F);
    jump.tooth_change.axis_N[0] = known_N(2000.0F);
    for (const Estimate& change : {jump, fallen_force()}) {
        CHECK(of_change(change, 8, CutState::in_cut) != Fault::none);
        CHECK(of_change(change, 8, CutState::entry) == Fault::none);
    }
}

TEST(SignalSupervisorAlone, does_not_judge_a_force_until_the_feed_was_steady_for_a_revolution_and_three_teeth) {
    CHECK(of_change(fallen_force(), 6) == Fault::none);
    CHECK(of_change(fallen_force(), 7) == Fault::force_vanished);
    Estimate slower = fallen_force();
    slower.tooth_change.feed_is_steady = false;
    CHECK(of_change(slower) == Fault::none);
    Estimate ramp = fallen_force();
    ramp.axial_speed_mm_s = 0.1F * feed_mm_s;
    CHECK(of_change(ramp) == Fault::none);
}

TEST(SignalSupervisorAlone, forgets_a_force_that_vanished_where_the_feed_changes_within_a_revolution) {
    Supervisor supervisor(machine_and_tool());
    judged(supervisor, one_tooth(), 8, CutState::in_cut);
    judged(supervisor, fallen_force(), 1, CutState::in_cut);
    Estimate slower = one_tooth();
    slower.tooth_change.feed_is_steady = false;
    judged(supervisor, slower, 1, CutState::in_cut);
    CHECK(judged(supervisor, one_tooth(), 100, CutState::in_cut) == Fault::none);
}

TEST(SignalSupervisorAlone, does_not_take_a_force_for_vanished_that_is_not_known_or_was_none) {
    Estimate e = fallen_force();
    e.tooth_change.tangential_N.valid = false;
    CHECK(of_change(e) == Fault::none);
    e = fallen_force();
    e.tooth_tangential_N.value = -300.0F;  // and was −100 N before
    CHECK(of_change(e) == Fault::none);
}

TEST(SignalSupervisorAlone, does_not_take_the_next_value_of_a_load_that_comes_seldom_for_a_force_that_vanishes) {
    auto parameters = machine_and_tool();
    parameters.machine.spindle_load_period_s = 0.1F;
    Supervisor supervisor(parameters);
    judged(supervisor, one_tooth(), 8, CutState::in_cut);
    judged(supervisor, fallen_force(), 1, CutState::in_cut);
    CHECK(judged(supervisor, one_tooth(), 6, CutState::in_cut) == Fault::none);
}

TEST(SignalSupervisorAlone, takes_a_load_that_does_not_answer_the_feed_for_a_signal_that_is_stuck) {
    Supervisor supervisor(machine_and_tool());
    supervisor.judge_load(false);
    CHECK(supervisor.fault() == Fault::none);
    supervisor.judge_load(true);
    CHECK(supervisor.fault() == Fault::signal_stuck);
}

TEST(SignalSupervisorAlone, does_not_judge_a_force_of_an_earlier_feed) {
    Supervisor supervisor(machine_and_tool());
    judged(supervisor, one_tooth(), 8, CutState::in_cut);
    constexpr bool feed_is_settled = false;
    supervisor.judge(fallen_force(), program(), CutState::in_cut, feed_is_settled);
    CHECK(judged(supervisor, one_tooth(), 6, CutState::in_cut) == Fault::none);
}

TEST(SignalSupervisorAlone, does_not_take_the_late_load_of_a_cut_for_contact_in_the_rapid_behind_it) {
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

TEST(SignalSupervisorAlone, does_not_take_noise_for_a_force_that_vanishes) {
    Estimate e = fallen_force();
    e.tooth_change.tangential_N.variance = 20.0F * 20.0F;  // it fell by 88 N more than a cut's end explains
    CHECK(of_change(e) == Fault::none);
    e.tooth_change.tangential_N.variance = 10.0F * 10.0F;
    CHECK(of_change(e) == Fault::force_vanished);
}

TEST(SignalSupervisorAlone, finds_a_jump_of_either_axis_in_either_direction_where_it_is_known) {
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

TEST(SignalSupervisorAlone, does_not_take_the_inertia_of_an_axis_for_a_jump) {
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

TEST(SignalSupervisorAlone, compares_a_jump_with_the_larger_of_the_torques_before_and_after) {
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

TEST(SignalSupervisorAlone, does_not_judge_a_jump_where_a_tooth_goes_far_enough_to_leave_the_cut) {
    Estimate e = one_tooth();
    e.feed_per_tooth_mm = 1.0F;
    e.tooth_tangential_N = known_N(250.0F);
    e.tooth_change.tangential_N = known_N(0.0F);
    e.tooth_change.axis_N[0] = known_N(2000.0F);
    CHECK(of_change(e) == Fault::none);
}

TEST(SignalSupervisorAlone, counts_revolutions_and_not_teeth) {
    Supervisor supervisor(machine_and_tool());
    Estimate e = one_tooth();
    e.tangential_N.value = -500.0F;
    CHECK(judged(supervisor, e, 15) == Fault::none);  // of the first revolution only the speed is taken
    CHECK(judged(supervisor, e, 1) == Fault::negative_torque);
}

TEST(SignalSupervisorAlone, counts_revolutions_anew_after_a_reset) {
    Supervisor supervisor(machine_and_tool());
    Estimate e = revolution();
    e.tangential_N.value = -500.0F;
    judged(supervisor, e, 3);
    supervisor.reset();
    CHECK(judged(supervisor, e, 3) == Fault::none);
    CHECK(judged(supervisor, e, 1) == Fault::negative_torque);
}

TEST(SignalSupervisorAlone, does_not_judge_a_torque_that_is_not_known_or_of_a_spindle_that_changes_its_speed) {
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

TEST(SignalSupervisorAlone, takes_the_least_force_of_a_move_in_air_for_its_friction) {
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

TEST(SignalSupervisorAlone, allows_the_axes_no_friction_beyond_the_known_one_where_a_cut_has_just_ended) {
    for (const float force_N : {-100.0F, 100.0F}) {
        Supervisor supervisor(machine_and_tool());
        Estimate e = revolution();
        e.feed_N = known_N(force_N);
        CHECK(judged(supervisor, e, 20) == Fault::none);
        CHECK(judged(supervisor, e, 3, CutState::exit) == Fault::forces_contradict);
    }
}

TEST(SignalSupervisorAlone, does_not_compare_the_axes_with_the_torque_in_a_cut_a_rapid_or_an_unsteady_move) {
    Estimate e = revolution();
    e.feed_N = known_N(100.0F);
    hal::ProgramStatus rapid = program();
    rapid.rapid = true;
    Supervisor in_a_rapid(machine_and_tool());
    CHECK(judged(in_a_rapid, e, 20, CutState::exit, rapid) == Fault::none);
    Supervisor in_a_cut(machine_and_tool());
    judged(in_a_cut, e, 20, CutState::air);
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

TEST(SignalSupervisorAlone, lets_the_axes_carry_twice_the_torque_and_never_less_than_none) {
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

TEST(SignalSupervisorAlone, finds_a_feed_force_that_is_lost_in_the_move_in_which_it_was_known) {
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

TEST(SignalSupervisorAlone, lets_the_feed_force_be_unknown_where_an_arc_slows_one_axis_down) {
    const Estimate unknown = revolution();
    Supervisor supervisor(machine_and_tool());
    Estimate e = revolution();
    e.feed_N = known_N(10.0F);
    CHECK(judged(supervisor, e, 1 + 256) == Fault::none);
    CHECK(judged(supervisor, unknown, 256) == Fault::none);
}

TEST(SignalSupervisorAlone, gives_the_cnc_the_time_to_slow_down_that_its_acceleration_takes) {
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

TEST(SignalSupervisorAlone, errs_towards_a_fault_without_a_diameter_or_an_acceleration) {
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

TEST(SignalSupervisorAlone, does_not_judge_the_feed_in_a_rapid_or_where_the_program_s_is_not_known) {
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
