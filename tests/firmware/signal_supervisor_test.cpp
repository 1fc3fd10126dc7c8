// SPDX-License-Identifier: Apache-2.0
#include "firmware/signal_supervisor.hpp"

#include <algorithm>
#include <cmath>

#include <CppUTest/TestHarness.h>

#include "firmware/tick_bench.hpp"

namespace hal = millforce::hal;
using namespace millforce::test;
using millforce::control::CutState;
using millforce::control::Fault;
using millforce::firmware::ForceControlTick;
using Estimate = millforce::estimation::CutEstimate<float>;
using Force = millforce::estimation::Measurement<float>;
using Supervisor = millforce::firmware::SignalSupervisor<float>;
using millforce::firmware::step_and_work;

namespace {

constexpr int in_the_cut = 800;  // samples; from 200 on there is contact
constexpr int in_air = 120;
constexpr float sample_mm = 0.001F * feed_mm_s;

/// The straight cut of the bench; from a sample on `corrupt(sample, program, samples since)` is called with each.
template <typename Corrupt>
class Bench {
  public:
    Bench(int wrong_from, Corrupt corrupt) : wrong_from_(wrong_from), corrupt_(corrupt) {}

    /// The fault that the tick has after so many milliseconds of wrong signals.
    Fault after_ms(int duration_ms) {
        for (; next_ < wrong_from_ + duration_ms; ++next_) {
            hal::DriveSample sample = sample_of(next_);
            hal::ProgramStatus status = program();
            if (next_ >= wrong_from_) {
                corrupt_(sample, status, next_ - wrong_from_);
            }
            output_ = step_and_work(tick_, sample, status);
        }
        return tick_.control().fault;
    }
    ForceControlTick<float>& tick() { return tick_; }
    [[nodiscard]] const hal::FeedOverride& output() const { return output_; }

  private:
    ForceControlTick<float> tick_ = fresh_tick();
    hal::FeedOverride output_{};
    int wrong_from_;
    Corrupt corrupt_;
    int next_ = 0;
};

float idle_A() {
    const Parameters p = machine_and_tool();
    return -p.machine.spindle.K_t2_Nm / p.machine.spindle.K_t1_Nm_per_A;
}

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
        supervisor.judge(e, status, state);
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

TEST_GROUP(SignalSupervisor){};

TEST(SignalSupervisor, finds_nothing_in_a_sound_cut) {
    Bench bench(in_the_cut, [](hal::DriveSample&, hal::ProgramStatus&, int) {});
    CHECK(bench.after_ms(2000) == Fault::none);
    CHECK(bench.tick().control().state == CutState::in_cut);
}

TEST(SignalSupervisor, finds_a_clock_that_stands_and_one_that_runs_backwards) {
    for (const int step_us : {0, -1000}) {
        Bench bench(in_the_cut, [step_us](hal::DriveSample& sample, hal::ProgramStatus&, int since) {
            sample.time_us = sample_of(in_the_cut).time_us + static_cast<std::uint32_t>(since * step_us);
        });
        CHECK(bench.after_ms(20) == Fault::none);
        CHECK(bench.after_ms(40) == Fault::stale_input);
        CHECK(bench.output().hold);
    }
}

TEST(SignalSupervisor, finds_a_torque_that_vanishes_at_once) {
    for (const float left : {0.0F, 0.3F}) {
        Bench bench(in_the_cut,
                    [left](hal::DriveSample& sample, hal::ProgramStatus&, int) { sample.spindle_current_A *= left; });
        const Fault fault = bench.after_ms(60);
        CHECK(fault == Fault::force_vanished || fault == Fault::negative_torque);
    }
}

TEST(SignalSupervisor, lets_a_cut_end_at_a_straight_edge) {
    Bench bench(in_the_cut, [](hal::DriveSample& sample, hal::ProgramStatus&, int since) {
        constexpr float radius_mm = 5.0F;
        const float s_mm = std::min(sample_mm * static_cast<float>(since), radius_mm);
        const float left = 1.0F - std::sqrt((2.0F * radius_mm - s_mm) * s_mm) / radius_mm;
        sample.spindle_current_A = idle_A() + left * (sample.spindle_current_A - idle_A());
        const float air_A = sample_of(0).axis_current_A[0];
        sample.axis_current_A[0] = air_A + left * (sample.axis_current_A[0] - air_A);
    });
    CHECK(bench.after_ms(1000) == Fault::none);
    CHECK(bench.tick().control().state == CutState::air);
}

TEST(SignalSupervisor, lets_a_cut_end_where_the_feed_stops) {
    Bench bench(in_the_cut, [](hal::DriveSample& sample, hal::ProgramStatus&, int since) {
        const float left = std::max(0.0F, 1.0F - 0.1F * static_cast<float>(since));  // 2 m/s²
        sample.axis_velocity_mm_s[0] *= left;
        sample.spindle_current_A = idle_A() + left * (sample.spindle_current_A - idle_A());
        sample.axis_current_A[0] = left > 0.0F ? sample.axis_current_A[0] - 4.0F : 0.0F;  // it brakes, then rests
    });
    CHECK(bench.after_ms(500) == Fault::none);
}

TEST(SignalSupervisor, finds_an_axis_current_that_is_tenfold_at_once) {
    Bench bench(in_the_cut,
                [](hal::DriveSample& sample, hal::ProgramStatus&, int) { sample.axis_current_A[0] *= 10.0F; });
    CHECK(bench.after_ms(60) == Fault::force_jumped);
}

TEST(SignalSupervisor, does_not_take_the_current_that_brakes_an_axis_for_a_jump) {
    Bench bench(in_the_cut, [](hal::DriveSample& sample, hal::ProgramStatus&, int since) {
        sample.axis_current_A[0] -= since < 40 ? 6.0F : 0.0F;  // from the first sample on; the velocity follows
        sample.axis_velocity_mm_s[0] *= std::max(0.5F, 1.0F - 0.0125F * static_cast<float>(since));
    });
    CHECK(bench.after_ms(200) == Fault::none);
}

TEST(SignalSupervisor, finds_a_torque_below_the_idle_torque) {
    Bench bench(in_air, [](hal::DriveSample& sample, hal::ProgramStatus&, int) { sample.spindle_current_A = -3.0F; });
    CHECK(bench.after_ms(79) == Fault::negative_torque);
}

TEST(SignalSupervisor, lets_a_spindle_brake_where_the_axes_rest_or_move_in_a_rapid) {
    for (const bool is_rapid : {false, true}) {
        Bench bench(in_air, [is_rapid](hal::DriveSample& sample, hal::ProgramStatus& status, int) {
            sample.spindle_current_A = -3.0F;
            sample.axis_velocity_mm_s[0] *= is_rapid ? 1.0F : 0.0F;
            status.rapid = is_rapid;
        });
        CHECK(bench.after_ms(79) == Fault::none);
    }
}

TEST(SignalSupervisor, finds_an_idle_torque_that_its_calibration_does_not_leave_open) {
    Bench bench(0, [](hal::DriveSample& sample, hal::ProgramStatus& status, int) {
        sample.spindle_current_A = 0.0F;
        status.rapid = true;
    });
    CHECK(bench.after_ms(60) == Fault::none);
    CHECK(bench.after_ms(600) == Fault::idle_torque);
}

TEST(SignalSupervisor, lets_the_current_of_a_spindle_that_stands_stand) {
    constexpr int turning = 600;
    Bench bench(0, [](hal::DriveSample& sample, hal::ProgramStatus&, int since) {
        const bool turns = since < turning;
        const float noise_A = 0.05F * std::sin(static_cast<float>(since * since));
        sample.spindle_count = sample_of(turns ? since : turning).spindle_count;
        sample.spindle_current_A = turns ? idle_A() + noise_A : 0.0F;
        sample.axis_current_A[0] = sample_of(0).axis_current_A[0];
    });
    CHECK(bench.after_ms(turning + 2000) == Fault::none);
}

TEST(SignalSupervisor, finds_a_current_of_0_while_the_spindle_turns) {
    constexpr int sound = 600;
    Bench bench(0, [](hal::DriveSample& sample, hal::ProgramStatus&, int since) {
        const float noise_A = 0.05F * std::sin(static_cast<float>(since * since));
        sample.spindle_current_A = since < sound ? idle_A() + noise_A : 0.0F;
        sample.axis_current_A[0] = sample_of(0).axis_current_A[0];
    });
    CHECK(bench.after_ms(sound + 100) != Fault::none);
}

TEST(SignalSupervisor, finds_a_cut_in_a_rapid) {
    Bench bench(in_the_cut, [](hal::DriveSample& sample, hal::ProgramStatus& status, int) {
        sample.spindle_current_A += idle_A();
        status.rapid = true;
    });
    CHECK(bench.after_ms(70) == Fault::contact_in_rapid);
}

TEST(SignalSupervisor, finds_axes_that_are_far_faster_than_the_program_says) {
    Bench bench(in_the_cut, [](hal::DriveSample&, hal::ProgramStatus& status, int) {
        status.programmed_feed_mm_s = 0.1F * feed_mm_s;
    });
    CHECK(bench.after_ms(100) == Fault::none);  // a CNC may take so long to slow down
    CHECK(bench.after_ms(400) == Fault::feed_mismatch);
}

TEST(SignalSupervisor, lets_the_program_slow_down) {
    Bench bench(in_air, [](hal::DriveSample& sample, hal::ProgramStatus& status, int since) {
        status.programmed_feed_mm_s = 0.1F * feed_mm_s;
        sample.axis_velocity_mm_s[0] *= std::max(0.1F, 1.0F - 0.01F * static_cast<float>(since));
    });
    CHECK(bench.after_ms(79) == Fault::none);
}

TEST(SignalSupervisor, finds_an_encoder_that_counts_double_in_the_cut) {
    const std::uint32_t before = sample_of(in_the_cut - 1).spindle_count;
    Bench bench(in_the_cut, [before](hal::DriveSample& sample, hal::ProgramStatus&, int) {
        sample.spindle_count += sample.spindle_count - before;
    });
    CHECK(bench.after_ms(60) == Fault::encoder_mismatch);
}

TEST(SignalSupervisor, finds_counts_that_disagree_with_the_index_pulse) {
    for (const std::uint32_t counts : {4096U, 2048U, 8192U}) {
        Bench bench(0, [counts](hal::DriveSample& sample, hal::ProgramStatus&, int) {
            const std::uint32_t turns = sample.spindle_count / counts;
            sample.spindle_index_number = static_cast<std::uint8_t>(1U + turns);
            sample.spindle_index_count = turns * counts;
        });
        CHECK(bench.after_ms(190) == (counts == 4096U ? Fault::none : Fault::encoder_mismatch));
    }
}

TEST(SignalSupervisor, finds_index_pulses_that_are_half_the_counters_range_apart) {
    Bench bench(0, [](hal::DriveSample& sample, hal::ProgramStatus&, int) {
        const std::uint32_t turns = sample.spindle_count / 4096U;
        sample.spindle_index_number = static_cast<std::uint8_t>(1U + turns);
        sample.spindle_index_count = turns * 0x8000'0000U;
    });
    CHECK(bench.after_ms(190) == Fault::encoder_mismatch);
}

TEST(SignalSupervisor, finds_a_cut_that_the_axes_carry_and_the_spindle_does_not_show) {
    Bench bench(150, [](hal::DriveSample& sample, hal::ProgramStatus&, int) {
        sample.spindle_current_A = idle_A();
        const float air_A = sample_of(0).axis_current_A[0];
        sample.axis_current_A[0] = air_A + 8.0F * (sample.axis_current_A[0] - air_A);
    });
    CHECK(bench.after_ms(500) == Fault::forces_contradict);
}

TEST(SignalSupervisor, does_not_use_a_velocity_that_no_machine_has) {
    Bench bench(in_the_cut,
                [](hal::DriveSample& sample, hal::ProgramStatus&, int) { sample.axis_velocity_mm_s[0] *= 1e6F; });
    const float before = bench.output().ratio;
    bench.after_ms(500);
    CHECK_FALSE(bench.tick().estimate().x_N.valid);
    CHECK(bench.output().ratio <= std::max(before, 0.1F));
}

TEST(SignalSupervisor, lets_the_tool_go_on_after_a_reset_once_it_is_out_of_the_cut) {
    Bench bench(in_the_cut, [](hal::DriveSample& sample, hal::ProgramStatus& status, int since) {
        sample.spindle_current_A = since < 100 ? sample.spindle_current_A + idle_A() : idle_A();
        sample.axis_current_A[0] = since < 100 ? sample.axis_current_A[0] : sample_of(0).axis_current_A[0];
        status.rapid = true;
    });
    CHECK(bench.after_ms(100) == Fault::contact_in_rapid);
    bench.tick().reset_fault();
    CHECK(bench.after_ms(300) == Fault::none);
}

// Without the tick

TEST(SignalSupervisor, finds_a_spindle_current_that_stands_in_air_and_in_the_cut) {
    for (const CutState state : {CutState::air, CutState::in_cut}) {
        Currents currents;
        CHECK(currents.noisy_spindle(600, state) == Fault::none);
        CHECK(currents.same(30, state) == Fault::none);
        CHECK(currents.same(10, state) == Fault::signal_stuck);
    }
}

TEST(SignalSupervisor, finds_a_spindle_current_that_stands_from_the_first_cut_on) {
    Currents currents;
    CHECK(currents.noisy_spindle(600, CutState::air) == Fault::none);
    CHECK(currents.same(30, CutState::in_cut) == Fault::none);
    CHECK(currents.same(10, CutState::in_cut) == Fault::signal_stuck);
}

TEST(SignalSupervisor, does_not_take_a_missing_spindle_current_for_one_that_stands) {
    for (const CutState taught_in : {CutState::air, CutState::in_cut}) {
        for (const CutState state : {CutState::air, CutState::in_cut}) {
            Currents currents;
            currents.noisy_spindle(600, taught_in);
            currents.sample().present ^= hal::mask(hal::Present::spindle_current);
            CHECK(currents.same(100, state) == Fault::none);
        }
    }
}

TEST(SignalSupervisor, does_not_judge_a_spindle_current_until_a_revolution_has_shown_a_speed) {
    Currents currents;
    currents.noisy_spindle(600, CutState::air);
    currents.supervisor().restart();
    CHECK(currents.same(100, CutState::air) == Fault::none);
    currents.turn();
    CHECK(currents.same(100, CutState::air) == Fault::signal_stuck);
}

TEST(SignalSupervisor, does_not_judge_a_current_in_air_by_what_a_cut_taught) {
    Currents currents;
    currents.noisy_spindle(1000, CutState::in_cut);
    CHECK(currents.same(100, CutState::air) == Fault::none);
}

TEST(SignalSupervisor, does_not_judge_a_current_in_the_cut_by_air_once_a_cut_has_taught) {
    Currents currents;
    currents.noisy_spindle(600, CutState::air);
    CHECK(currents.noisy_spindle(300 * 20, CutState::in_cut, 20) == Fault::none);
    CHECK(currents.same(100, CutState::in_cut) == Fault::none);
    CHECK(currents.same(100, CutState::in_cut) == Fault::signal_stuck);
}

TEST(SignalSupervisor, finds_the_current_of_either_axis_that_stands_in_a_cut) {
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
        Currents currents;
        currents.sample().axis_velocity_mm_s = {feed_mm_s, -feed_mm_s, 0.0F};
        CHECK(currents.noisy_axis(axis, 600, CutState::in_cut) == Fault::none);
        CHECK(currents.same(40, CutState::in_cut) == Fault::signal_stuck);
    }
}

TEST(SignalSupervisor, lets_the_current_of_an_axis_stand_that_rests_or_is_out_of_the_cut_or_not_measured) {
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

TEST(SignalSupervisor, after_a_reset_finds_a_current_that_stands_by_as_many_samples_as_before) {
    Currents currents;
    currents.noisy_axis(0, 600, CutState::in_cut);
    CHECK(currents.same(40, CutState::in_cut) == Fault::signal_stuck);
    currents.supervisor().reset();
    CHECK(currents.same(30, CutState::in_cut) == Fault::none);
    CHECK(currents.same(10, CutState::in_cut) == Fault::signal_stuck);
}

TEST(SignalSupervisor, does_not_judge_the_first_index_pulse) {
    Supervisor supervisor(machine_and_tool());
    CHECK(of_index_pulses(supervisor, 3, 1U, 8192U) == Fault::none);  // two intervals
    Supervisor another(machine_and_tool());
    CHECK(of_index_pulses(another, 4, 1U, 8192U) == Fault::encoder_mismatch);
}

TEST(SignalSupervisor, does_not_judge_two_index_pulses_of_which_one_between_was_missed) {
    Supervisor supervisor(machine_and_tool());
    CHECK(of_index_pulses(supervisor, 20, 2U, 8192U) == Fault::none);
}

TEST(SignalSupervisor, does_not_judge_index_pulses_without_a_count) {
    Supervisor supervisor(machine_and_tool());
    constexpr auto without_count = static_cast<std::uint8_t>(hal::all_present ^ hal::mask(hal::Present::spindle_count));
    CHECK(of_index_pulses(supervisor, 20, 1U, 8192U, without_count) == Fault::none);
}

TEST(SignalSupervisor, lets_the_speed_of_the_spindle_change_at_once_out_of_the_cut_alone) {
    for (const float ratio : {0.6F, 1.5F}) {
        Estimate e = one_tooth();
        e.tooth_change.speed_ratio = ratio;
        CHECK(of_change(e, 8, CutState::air) == Fault::none);
        CHECK(of_change(e, 8, CutState::in_cut) == Fault::encoder_mismatch);
    }
}

TEST(SignalSupervisor, finds_a_force_that_vanishes_in_the_cut_alone) {
    CHECK(of_change(fallen_force(), 8, CutState::in_cut) == Fault::force_vanished);
    CHECK(of_change(fallen_force(), 8, CutState::air) == Fault::none);
}

TEST(SignalSupervisor, does_not_judge_a_force_until_the_feed_was_steady_for_a_revolution_and_three_teeth) {
    CHECK(of_change(fallen_force(), 6) == Fault::none);
    CHECK(of_change(fallen_force(), 7) == Fault::force_vanished);
    Estimate slower = fallen_force();
    slower.tooth_change.feed_is_steady = false;
    CHECK(of_change(slower) == Fault::none);
    Estimate ramp = fallen_force();
    ramp.axial_speed_mm_s = 0.1F * feed_mm_s;
    CHECK(of_change(ramp) == Fault::none);
}

TEST(SignalSupervisor, forgets_a_force_that_vanished_where_the_feed_changes_within_a_revolution) {
    Supervisor supervisor(machine_and_tool());
    judged(supervisor, one_tooth(), 8, CutState::in_cut);
    judged(supervisor, fallen_force(), 1, CutState::in_cut);
    Estimate slower = one_tooth();
    slower.tooth_change.feed_is_steady = false;
    judged(supervisor, slower, 1, CutState::in_cut);
    CHECK(judged(supervisor, one_tooth(), 100, CutState::in_cut) == Fault::none);
}

TEST(SignalSupervisor, does_not_take_a_force_for_vanished_that_is_not_known_or_was_none) {
    Estimate e = fallen_force();
    e.tooth_change.tangential_N.valid = false;
    CHECK(of_change(e) == Fault::none);
    e = fallen_force();
    e.tooth_tangential_N.value = -300.0F;  // and was −100 N before
    CHECK(of_change(e) == Fault::none);
}

TEST(SignalSupervisor, does_not_take_noise_for_a_force_that_vanishes) {
    Estimate e = fallen_force();
    e.tooth_change.tangential_N.variance = 20.0F * 20.0F;  // it fell by 88 N more than a cut's end explains
    CHECK(of_change(e) == Fault::none);
    e.tooth_change.tangential_N.variance = 10.0F * 10.0F;
    CHECK(of_change(e) == Fault::force_vanished);
}

TEST(SignalSupervisor, finds_a_jump_of_either_axis_in_either_direction_where_it_is_known) {
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

TEST(SignalSupervisor, compares_a_jump_with_the_larger_of_the_torques_before_and_after) {
    struct Torque {
        float now_N;
        float change_N;
    };
    for (const Torque torque : {Torque{250.0F, 200.0F}, Torque{150.0F, -100.0F}}) {
        Estimate e = one_tooth();
        e.tooth_tangential_N = known_N(torque.now_N);
        e.tooth_change.tangential_N = known_N(torque.change_N);
        e.tooth_change.axis_N[0] = known_N(200.0F);  // 0.45 · 2 · 250 N = 225 N may be
        CHECK(of_change(e) == Fault::none);
    }
}

TEST(SignalSupervisor, does_not_judge_a_jump_where_a_tooth_goes_far_enough_to_leave_the_cut) {
    Estimate e = one_tooth();
    e.feed_per_tooth_mm = 1.0F;
    e.tooth_tangential_N = known_N(250.0F);
    e.tooth_change.tangential_N = known_N(0.0F);
    e.tooth_change.axis_N[0] = known_N(2000.0F);
    CHECK(of_change(e) == Fault::none);
}

TEST(SignalSupervisor, counts_revolutions_and_not_teeth) {
    Supervisor supervisor(machine_and_tool());
    Estimate e = one_tooth();
    e.tangential_N.value = -500.0F;
    CHECK(judged(supervisor, e, 15) == Fault::none);  // of the first revolution only the speed is taken
    CHECK(judged(supervisor, e, 1) == Fault::negative_torque);
}

TEST(SignalSupervisor, counts_revolutions_anew_after_a_reset) {
    Supervisor supervisor(machine_and_tool());
    Estimate e = revolution();
    e.tangential_N.value = -500.0F;
    judged(supervisor, e, 3);
    supervisor.reset();
    CHECK(judged(supervisor, e, 3) == Fault::none);
    CHECK(judged(supervisor, e, 1) == Fault::negative_torque);
}

TEST(SignalSupervisor, does_not_judge_a_torque_that_is_not_known_or_of_a_spindle_that_changes_its_speed) {
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

TEST(SignalSupervisor, takes_the_least_force_of_a_move_in_air_for_its_friction) {
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

TEST(SignalSupervisor, allows_the_axes_no_friction_beyond_the_known_one_where_a_cut_has_just_ended) {
    for (const float force_N : {-100.0F, 100.0F}) {
        Supervisor supervisor(machine_and_tool());
        Estimate e = revolution();
        e.feed_N = known_N(force_N);
        CHECK(judged(supervisor, e, 20) == Fault::none);
        CHECK(judged(supervisor, e, 3, CutState::exit) == Fault::forces_contradict);
    }
}

TEST(SignalSupervisor, does_not_compare_the_axes_with_the_torque_in_a_cut_a_rapid_or_an_unsteady_move) {
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

TEST(SignalSupervisor, lets_the_axes_carry_twice_the_torque_and_never_less_than_none) {
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

TEST(SignalSupervisor, finds_a_feed_force_that_is_lost_in_the_move_in_which_it_was_known) {
    const Estimate lost = revolution();
    Supervisor never_known(machine_and_tool());
    CHECK(judged(never_known, lost, 20) == Fault::none);
    Supervisor known(machine_and_tool());
    Estimate e = revolution();
    e.feed_N = known_N(10.0F);
    CHECK(judged(known, e, 1 + 256) == Fault::none);
    CHECK(judged(known, lost, 2) == Fault::none);
    CHECK(judged(known, lost, 1) == Fault::forces_contradict);
}

TEST(SignalSupervisor, gives_the_cnc_the_time_to_slow_down_that_its_acceleration_takes) {
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

TEST(SignalSupervisor, errs_towards_a_fault_without_a_diameter_or_an_acceleration) {
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

TEST(SignalSupervisor, does_not_judge_the_feed_in_a_rapid_or_where_the_program_s_is_not_known) {
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
