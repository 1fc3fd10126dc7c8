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

/// The tool is bent by the cut, and machine and tool spring back by a tenth of a millimetre: so long it cuts on.
TEST(SignalSupervisor, lets_a_bent_tool_cut_on_where_the_path_turns_back) {
    constexpr int turns_back = 400;
    constexpr float slow = 0.1F;
    Bench bench(in_the_cut, [](hal::DriveSample& sample, hal::ProgramStatus&, int since) {
        sample.axis_velocity_mm_s[0] *= since < turns_back ? slow : -slow;
        const float back_mm = slow * sample_mm * static_cast<float>(since - turns_back);
        if (back_mm > 0.1F) {
            sample.spindle_current_A = idle_A();
        }
    });
    CHECK(bench.after_ms(turns_back + 1000) == Fault::none);
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
