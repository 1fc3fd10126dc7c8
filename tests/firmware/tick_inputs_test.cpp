// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "firmware/tick.hpp"
#include "firmware/tick_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;
using control::CutState;
using control::Fault;
using control::Limit;
using firmware::step_and_work;
using Tick = firmware::ForceControlTick<float>;

namespace {

const float lowest = machine_and_tool().machine.cnc.override_min;

hal::DriveSample without(hal::DriveSample sample, hal::Present quantity) {
    sample.present = static_cast<std::uint8_t>(sample.present & ~hal::mask(quantity));
    return sample;
}

hal::DriveSample in_air(int index) {
    hal::DriveSample sample = sample_of(0);
    sample.time_us = sample_of(index).time_us;
    sample.spindle_count = sample_of(index).spindle_count;
    return sample;
}

/// Spindle current beyond the idle one.
hal::DriveSample with_force(int index, float tangential_N) {
    hal::DriveSample sample = in_air(index);
    sample.spindle_current_A += tangential_N * 0.005F / 0.7F;
    return sample;
}

/// Which tooth has passed last, of 4 at 4000 rpm.
int tooth_of(int index) {
    return static_cast<int>(static_cast<float>(index) * 0.001F * 4000.0F / 60.0F * 4.0F);
}

void mill(Tick& tick, int first, int end) {
    for (int k = first; k < end; ++k) {
        step_and_work(tick, sample_of(k), program());
    }
}

void fly(Tick& tick, int first, int end) {
    for (int k = first; k < end; ++k) {
        step_and_work(tick, in_air(k), program());
    }
}

/// Axes at rest teach the idle torque; then they move.
void learn_idle_torque(Tick& tick, int end) {
    for (int k = 0; k < end - 100; ++k) {
        hal::DriveSample sample = in_air(k);
        sample.axis_velocity_mm_s = {};
        step_and_work(tick, sample, program());
    }
    fly(tick, end - 100, end);
}

}  // namespace

TEST_GROUP(TickInputs) {
    Tick tick = fresh_tick();
};

TEST(TickInputs, need_no_spindle_current_where_the_machine_has_none) {
    Parameters p = machine_and_tool();
    p.machine.spindle.K_t1_Nm_per_A = 0.0F;
    tick = Tick(p);
    for (int k = 0; k < 400; ++k) {
        step_and_work(tick, without(sample_of(k), hal::Present::spindle_current), program());
        CHECK(tick.control().fault == Fault::none);
    }
    hal::DriveSample late = without(sample_of(400), hal::Present::spindle_current);
    late.time_us += 100'000;
    step_and_work(tick, late, program());
    CHECK(tick.control().fault == Fault::stale_input);
}

TEST(TickInputs, show_no_load_of_a_spindle_at_rest_where_its_current_means_nothing) {
    Parameters p = machine_and_tool();
    p.machine.spindle.K_t1_Nm_per_A = 0.0F;
    p.machine.spindle.K_t2_Nm = 0.0F;
    tick = Tick(p);
    for (int k = 0; k < 400; ++k) {
        hal::DriveSample sample = in_air(k);
        sample.spindle_count = 0;
        step_and_work(tick, sample, program());
        CHECK(tick.control().fault == Fault::none);
    }
}

TEST(TickInputs, are_stale_where_two_whole_samples_are_too_far_apart) {
    mill(tick, 0, 600);
    hal::DriveSample late = sample_of(600);
    late.time_us += 100'000;
    CHECK(step_and_work(tick, late, program()).hold);
    CHECK(tick.control().fault == Fault::stale_input);
}

TEST(TickInputs, without_a_count_hide_no_spindle_that_stands) {
    fly(tick, 0, 150);
    for (int k = 150; k < 400; ++k) {
        hal::DriveSample sample = with_force(k, 400.0F);
        sample.spindle_count = k % 2 == 0 ? in_air(149).spindle_count : static_cast<std::uint32_t>(1000 * k);
        step_and_work(tick, k % 2 == 0 ? sample : without(sample, hal::Present::spindle_count), program());
    }
    CHECK(tick.control().fault == Fault::spindle_stopped);
}

TEST(TickInputs, leave_the_feed_to_a_spindle_that_was_stopped_or_reversed_in_air) {
    for (const int counts_per_ms : {0, -3}) {
        Tick fresh = fresh_tick();
        fly(fresh, 0, 150);
        hal::FeedOverride output;
        std::uint32_t count = in_air(149).spindle_count;
        for (int k = 150; k < 350; ++k) {
            hal::DriveSample sample = in_air(k);
            count += static_cast<std::uint32_t>(counts_per_ms);
            sample.spindle_count = count;
            output = step_and_work(fresh, sample, program());
        }
        CHECK(output.ratio > 2.0F * lowest);
    }
}

TEST(TickInputs, of_a_spindle_that_turns_without_a_current_hold_the_feed_down) {
    fly(tick, 0, 150);
    hal::FeedOverride output;
    for (int k = 150; k < 195; ++k) {
        output = step_and_work(tick, without(in_air(k), hal::Present::spindle_current), program());
    }
    CHECK(output.ratio == lowest);
}

TEST(TickInputs, of_a_spindle_that_runs_up_are_no_load_at_rest) {
    for (int k = 0; k < 150; ++k) {
        hal::DriveSample sample = in_air(k);
        sample.spindle_count = static_cast<std::uint32_t>(k);
        sample.spindle_current_A = 12.0F;
        step_and_work(tick, sample, program());
        CHECK(tick.control().fault == Fault::none);
    }
}

TEST(TickInputs, whose_time_jumps_back_go_on_as_after_one_without_time) {
    Tick stood = fresh_tick();
    for (int k = 0; k < 600; ++k) {
        hal::DriveSample back = sample_of(k);
        hal::DriveSample again = back;
        back.time_us -= k < 300 ? 0U : 5'000'000U;
        again.time_us -= k < 300 ? 0U : 1000U;
        const hal::FeedOverride a = step_and_work(tick, back, program());
        const hal::FeedOverride b = step_and_work(stood, again, program());
        CHECK(a.ratio == b.ratio && a.hold == b.hold && a.state == b.state && a.fault == b.fault);
    }
    CHECK(tick.control().state == CutState::in_cut);
}

TEST(TickInputs, of_an_axis_that_creeps_downwards_are_no_plunge) {
    for (const float down_mm_s : {0.4F, 0.6F}) {
        Tick fresh = fresh_tick();
        fly(fresh, 0, 100);
        for (int k = 100; k < 150; ++k) {
            hal::DriveSample sample = in_air(k);
            sample.axis_velocity_mm_s = {0.0F, 0.0F, -down_mm_s};
            step_and_work(fresh, sample, program());
        }
        CHECK(fresh.control().limit == (down_mm_s > 0.5F ? Limit::entry_feed : Limit::air_feed));
    }
}

TEST(TickInputs, of_one_tooth_are_no_cut_however_many_samples_follow_its_estimate) {
    learn_idle_torque(tick, 403);
    step_and_work(tick, with_force(403, 600.0F), program());
    step_and_work(tick, with_force(404, 600.0F), program());
    float highest_N = 0.0F;
    for (int k = 405; k < 420; ++k) {
        step_and_work(tick, in_air(k), program());
        highest_N = std::max(highest_N, tick.estimate().tooth_tangential_N.value);
    }
    CHECK(highest_N > 200.0F);
    CHECK(tick.control().state == CutState::air);
}

TEST(TickInputs, of_the_newest_tooth_show_a_contact_before_a_revolution_does) {
    constexpr int first = 400;
    learn_idle_torque(tick, first);
    int k = first;
    while (tick.control().state == CutState::air && k < first + 100) {
        step_and_work(tick, with_force(k, 130.0F), program());
        ++k;
    }
    CHECK(k < first + 13);  // of 15 of a revolution
}

TEST(TickInputs, of_some_revolutions_show_a_contact_that_none_of_a_tooth_shows) {
    learn_idle_torque(tick, 400);
    for (int k = 400; k < 900; ++k) {
        step_and_work(tick, with_force(k, 60.0F), program());
        CHECK(tick.estimate().tooth_tangential_N.value < 4.0F * std::sqrt(tick.estimate().tooth_tangential_N.variance));
    }
    CHECK(control::is_cutting(tick.control().state));
}

TEST(TickInputs, of_a_dwell_in_which_every_other_tooth_cuts_are_one_cut) {
    mill(tick, 0, 600);
    for (int k = 600; k < 900; ++k) {
        const bool cuts = tooth_of(k) % 2 == 0;
        hal::DriveSample sample = with_force(k, cuts ? 250.0F : 0.0F);
        sample.axis_velocity_mm_s = {};
        sample.axis_current_A = {};
        step_and_work(tick, sample, program());
        CHECK(tick.control().state == CutState::in_cut);
    }
}

TEST(TickInputs, of_a_spindle_that_stops_in_the_cut_while_the_axes_rest_hold_the_feed) {
    mill(tick, 0, 600);
    for (int k = 600; k < 1200; ++k) {
        hal::DriveSample sample = in_air(600);
        sample.time_us = sample_of(k).time_us;
        sample.axis_velocity_mm_s = {};
        step_and_work(tick, sample, program());
    }
    CHECK(tick.control().fault == Fault::none);
    CHECK(tick.control().state == CutState::hold);
}

TEST(TickInputs, of_some_revolutions_show_no_contact_while_the_axes_rest) {
    learn_idle_torque(tick, 400);
    for (int k = 400; k < 900; ++k) {
        hal::DriveSample sample = with_force(k, 60.0F);
        sample.axis_velocity_mm_s = {};
        sample.axis_current_A = {};
        step_and_work(tick, sample, program());
        CHECK(tick.control().state == CutState::air);
    }
}

TEST_GROUP(TickOnSpindleAlone){};

TEST(TickOnSpindleAlone, does_not_believe_a_fall_that_a_drift_explains) {
    Parameters p = machine_and_tool();
    p.machine.spindle_rated_current_A = 20.0F;
    for (auto& axis : p.machine.axes) {
        axis.K_x4_N_per_A = 0.0F;
    }
    Tick tick(p);
    float before = 0.0F;
    for (int k = 0; k < 5000; ++k) {
        const float fallen = std::clamp(0.0002F * static_cast<float>(k - 2000), 0.0F, 0.5F);
        hal::DriveSample sample = sample_of(k);
        const float idle_A = in_air(k).spindle_current_A;
        sample.spindle_current_A = idle_A + (1.0F - fallen) * (sample.spindle_current_A - idle_A);
        step_and_work(tick, sample, program());
        before = k == 1999 ? tick.control().ratio : before;
    }
    CHECK(tick.estimate().tangential_N.value < 0.6F * 250.0F);
    CHECK(tick.control().ratio < 1.02F * before);
}
