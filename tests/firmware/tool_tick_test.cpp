// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "firmware/ready_tools.hpp"
#include "firmware/tick_record.hpp"
#include "firmware/tool_tick.hpp"
#include "tick_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;

namespace {

constexpr std::uint32_t strong = 7;  // numbers of the two tools that there are
constexpr std::uint32_t weak = 12;
constexpr float operators_override = 0.8F;
constexpr double exactly = 0.0;

Parameters with_limit(float tooth_force_limit_N) {
    Parameters p = machine_and_tool();
    p.tool.tooth_force_limit_N = tooth_force_limit_N;
    p.tool.control.overload_share = 100.0F;
    return p;
}

/// Built once: it takes longer than all cases.
const firmware::ReadyTools& tools() {
    static std::array<firmware::ReadyTool, 2> memory;
    static const firmware::ReadyTools ready = [] {
        firmware::ReadyTools both(memory);
        both.add(strong, with_limit(2000.0F));
        both.add(weak, with_limit(150.0F));
        return both;
    }();
    return ready;
}

/// Air with a friction and an idle torque that are not those of the calibration, or the cut of tick_bench.hpp.
class Mill {
  public:
    enum class Motion { rest, air, cut };

    hal::FeedOverride run(Motion motion, int samples) {
        hal::FeedOverride output;
        for (const int end = index_ + samples; index_ < end; ++index_) {
            const hal::DriveSample sample = sample_in(motion);
            tick.follow_tool(number, hal::axes_rest(sample.axis_velocity_mm_s));
            output = firmware::step_and_work(tick, sample, status);
        }
        return output;
    }
    hal::FeedOverride change_at_rest(std::uint32_t to) {
        run(Motion::air, 500);
        number = to;
        return run(Motion::rest, 10);
    }

    firmware::ToolTick tick{machine_and_tool(), &tools()};
    hal::ProgramStatus status = [] {
        hal::ProgramStatus programmed = program();
        programmed.operator_override = operators_override;
        return programmed;
    }();
    std::uint32_t number = strong;

  private:
    hal::DriveSample sample_in(Motion motion) {
        const float step = motion == Motion::cut ? 0.02F : -0.02F;  // a cut begins and ends within some teeth
        load_ = std::clamp(load_ + step, 0.0F, 1.0F);
        const hal::DriveSample in_air = sample_of(0);
        hal::DriveSample sample = sample_of(index_);
        sample.spindle_current_A = std::lerp(in_air.spindle_current_A + 0.1F, sample.spindle_current_A, load_);
        sample.axis_current_A[0] = std::lerp(1.05F * in_air.axis_current_A[0], sample.axis_current_A[0], load_);
        if (motion == Motion::rest) {
            sample.axis_velocity_mm_s = {};
        }
        return sample;
    }

    int index_ = 300;
    float load_ = 0.0F;
};

using Motion = Mill::Motion;

/// Of a force, by what is known of the machine's spindle.
float variance_of_force(const firmware::ToolTick& tick) {
    estimation::SpindleDrive<float>::Average average;
    average.current_A = 2.0F;
    average.speed_rad_s = 400.0F;
    average.present = true;
    return tick.of_tool().machine_knowledge().drives.spindle.tangential_force_N(average, 5.0F).variance;
}

}  // namespace

TEST_GROUP(ToolTick) {
    Mill mill;

    void check_operators(const hal::FeedOverride& output) {
        CHECK_FALSE(mill.tick.is_tool_known());
        UNSIGNED_LONGS_EQUAL(0, mill.tick.tool());
        DOUBLES_EQUAL(operators_override, output.ratio, exactly);
        CHECK_FALSE(output.hold);
        UNSIGNED_LONGS_EQUAL(0, output.fault);
    }
};

TEST(ToolTick, takes_the_first_number_of_a_run_in_motion) {
    mill.run(Motion::air, 1);
    CHECK(mill.tick.is_tool_known());
    UNSIGNED_LONGS_EQUAL(strong, mill.tick.tool());
}

TEST(ToolTick, holds_the_limits_of_the_tool_that_was_changed_to_at_rest) {
    mill.run(Motion::air, 500);
    const float of_strong = mill.run(Motion::cut, 2000).ratio;
    mill.change_at_rest(weak);
    UNSIGNED_LONGS_EQUAL(weak, mill.tick.tool());
    const float of_weak = mill.run(Motion::cut, 2000).ratio;
    CHECK(of_strong > 2.0F * of_weak);
    mill.change_at_rest(strong);
    DOUBLES_EQUAL(of_strong, mill.run(Motion::cut, 2000).ratio, 0.05F * of_strong);
}

TEST(ToolTick, holds_the_last_tools_limits_through_a_cut_in_which_the_number_is_lost_or_changes) {
    for (const std::uint32_t number : {0U, 99U, strong}) {
        Mill told;
        Mill undisturbed;
        for (Mill* each : {&told, &undisturbed}) {
            each->number = weak;
            each->run(Motion::air, 500);
            each->run(Motion::cut, 1000);
        }
        told.number = number;
        CHECK_FALSE(told.tick.is_change_due());
        for (int k = 0; k < 1000; ++k) {
            const hal::FeedOverride expected = undisturbed.run(Motion::cut, 1);
            const hal::FeedOverride output = told.run(Motion::cut, 1);
            CHECK(output.ratio == expected.ratio && output.hold == expected.hold && output.state == expected.state);
            CHECK(output.ratio < 0.5F * operators_override);
        }
        CHECK(told.tick.is_change_due());
        UNSIGNED_LONGS_EQUAL(weak, told.tick.tool());
    }
}

TEST(ToolTick, holds_the_last_tools_limits_through_a_dwell_in_the_workpiece_after_the_number_was_lost) {
    mill.number = weak;
    mill.run(Motion::air, 500);
    mill.run(Motion::cut, 1000);
    mill.number = 0;
    mill.run(Motion::rest, 3000);
    UNSIGNED_LONGS_EQUAL(weak, mill.tick.tool());
    CHECK(mill.run(Motion::cut, 1000).ratio < 0.5F * operators_override);
    mill.run(Motion::air, 1000);
    mill.run(Motion::rest, 10);
    UNSIGNED_LONGS_EQUAL(0, mill.tick.tool());
}

TEST(ToolTick, still_faults_by_the_last_tools_limits_after_the_number_was_lost_in_a_cut) {
    mill.run(Motion::air, 500);
    mill.run(Motion::cut, 1000);
    mill.number = 0;
    mill.run(Motion::cut, 10);
    CHECK(mill.tick.step_without_sample(1.0F, 1.0F, mill.status).hold);
}

TEST(ToolTick, takes_a_number_that_changed_in_motion_at_the_next_rest) {
    for (const std::uint32_t number : {weak, 99U}) {
        mill.change_at_rest(strong);
        mill.run(Motion::cut, 1000);
        mill.number = number;
        mill.run(Motion::air, 500);
        UNSIGNED_LONGS_EQUAL(strong, mill.tick.tool());
        CHECK(mill.run(Motion::air, 1).ratio <= operators_override);
        const hal::FeedOverride at_rest = mill.run(Motion::rest, 1);
        UNSIGNED_LONGS_EQUAL(number == weak ? weak : 0, mill.tick.tool());
        CHECK_FALSE(mill.tick.is_change_due());
        if (number != weak) {
            check_operators(at_rest);
        }
    }
}

TEST(ToolTick, goes_on_where_a_number_that_changed_in_motion_changes_back) {
    mill.run(Motion::air, 500);
    const float before = mill.run(Motion::cut, 1000).ratio;
    mill.number = 0;
    mill.run(Motion::cut, 1);
    mill.number = strong;
    DOUBLES_EQUAL(before, mill.run(Motion::cut, 1).ratio, 0.01F * before);
    UNSIGNED_LONGS_EQUAL(strong, mill.tick.tool());
    CHECK_FALSE(mill.tick.is_change_due());
}

TEST(ToolTick, changes_no_tool_while_the_forces_show_a_cut) {
    mill.run(Motion::air, 500);
    mill.run(Motion::cut, 1000);
    mill.number = weak;
    mill.tick.follow_tool(weak, true);
    UNSIGNED_LONGS_EQUAL(strong, mill.tick.tool());
    CHECK(mill.tick.is_change_due());
    CHECK(mill.tick.of_tool().estimate().tangential_N.valid);
}

TEST(ToolTick, knows_no_tool_that_is_not_there_and_estimates_nothing_with_it) {
    for (const std::uint32_t unknown : {99U, 0U}) {
        mill.change_at_rest(strong);
        check_operators(mill.change_at_rest(unknown));
        check_operators(mill.run(Motion::cut, 2000));
        const firmware::TickRecord record = firmware::tick_record(mill.tick.of_tool(), {}, 0);
        CHECK(record.tangential_force_N != record.tangential_force_N);
        CHECK_FALSE(record.has_tooth_force());
    }
    mill.status.feed_hold = true;
    CHECK(mill.run(Motion::cut, 1).hold);
    mill.status.feed_hold = false;
    check_operators(mill.run(Motion::cut, 1));
}

TEST(ToolTick, bounds_the_operators_override_as_the_machine_does) {
    mill.change_at_rest(99);
    mill.status.operator_override = 9.0F;
    DOUBLES_EQUAL(machine_and_tool().machine.cnc.override_max, mill.run(Motion::air, 1).ratio, exactly);
    mill.status.operator_override = std::numeric_limits<float>::quiet_NaN();
    DOUBLES_EQUAL(machine_and_tool().machine.cnc.override_min, mill.run(Motion::air, 1).ratio, exactly);
}

TEST(ToolTick, counts_its_heartbeat_on_whatever_the_tool) {
    std::uint32_t expected = 0;
    for (const std::uint32_t number : {strong, weak, 99U, 0U, strong}) {
        mill.number = number;
        expected += 10;
        UNSIGNED_LONGS_EQUAL(expected, mill.run(Motion::rest, 10).heartbeat);
    }
}

TEST(ToolTick, keeps_what_it_has_learnt_of_the_machine_and_nothing_else) {
    mill.run(Motion::rest, 1000);
    mill.run(Motion::air, 2000);
    const auto& learnt = mill.tick.of_tool().estimator();
    const float idle_Nm = learnt.spindle_drift_Nm();
    const float friction = learnt.friction_scale(0, true);
    DOUBLES_EQUAL(0.07, idle_Nm, 0.01);  // 0.1 A of 0.7 N·m/A
    CHECK(friction > 1.03F && friction < 1.07F);
    for (const std::uint32_t number : {weak, 99U, strong}) {
        mill.number = number;
        mill.run(Motion::rest, 1);
        DOUBLES_EQUAL(idle_Nm, mill.tick.of_tool().estimator().spindle_drift_Nm(), 1e-3);
        DOUBLES_EQUAL(friction, mill.tick.of_tool().estimator().friction_scale(0, true), 1e-3);
        CHECK_FALSE(mill.tick.of_tool().estimate().tangential_N.valid);
    }
}

TEST(ToolTick, knows_the_machine_less_surely_the_longer_no_tool_is_known) {
    mill.run(Motion::rest, 1000);
    mill.number = 99;
    mill.run(Motion::rest, 1);
    const float learnt = variance_of_force(mill.tick);
    mill.run(Motion::rest, 30'000);
    CHECK(variance_of_force(mill.tick) > 1.01F * learnt);
}

TEST(ToolTick, knows_no_time_that_has_passed_before_its_first_sample_or_where_the_clock_runs_back) {
    Parameters that_warms_up = machine_and_tool();
    that_warms_up.machine.spindle.warm_up_torque_sd_Nm = 0.5F;
    that_warms_up.machine.spindle.warm_up_time_s = 600.0F;
    firmware::ToolTick tick(that_warms_up, &tools());
    tick.follow_tool(99, true);
    const float at_first = variance_of_force(tick);
    for (const std::uint32_t time_us : {2'000'000'000U, 1'000'000'000U}) {
        tick.take(sample_of(0, time_us));
        DOUBLES_EQUAL(at_first, variance_of_force(tick), exactly);
    }
}

TEST(ToolTick, changes_to_a_tool_that_there_is_as_soon_as_the_axes_rest_behind_a_cut) {
    mill.run(Motion::air, 500);
    mill.run(Motion::cut, 1000);
    mill.run(Motion::rest, 200);
    CHECK(mill.tick.of_tool().control().state == control::CutState::exit);
    mill.number = weak;
    mill.run(Motion::rest, 1);
    UNSIGNED_LONGS_EQUAL(weak, mill.tick.tool());
}

TEST(ToolTick, is_no_other_one_where_one_unknown_number_follows_another) {
    CHECK(mill.tick.follow_tool(strong, true));
    CHECK(mill.tick.follow_tool(99, true));
    CHECK_FALSE(mill.tick.follow_tool(98, true));
    CHECK_FALSE(mill.tick.follow_tool(0, true));
}

TEST(ToolTick, takes_its_sample_in_a_step) {
    for (int k = 300; k < 800; ++k) {
        mill.tick.follow_tool(strong, false);
        mill.tick.step(sample_of(k), mill.status);
        firmware::finish_work(mill.tick);
    }
    CHECK(mill.tick.of_tool().estimate().tangential_N.valid);
}

TEST(ToolTick, changes_the_tool_after_the_reset_of_a_fault_and_not_before) {
    mill.run(Motion::air, 100);
    mill.tick.step_without_sample(1.0F, 1.0F, mill.status);
    mill.number = weak;
    const hal::FeedOverride in_fault = mill.run(Motion::rest, 100);
    CHECK(in_fault.hold);
    UNSIGNED_LONGS_EQUAL(static_cast<unsigned>(control::Fault::stale_input), in_fault.fault);
    UNSIGNED_LONGS_EQUAL(strong, mill.tick.tool());
    mill.tick.reset_fault();
    const hal::FeedOverride after = mill.run(Motion::rest, 2);
    UNSIGNED_LONGS_EQUAL(0, after.fault);
    CHECK_FALSE(after.hold);
    UNSIGNED_LONGS_EQUAL(weak, mill.tick.tool());
}

TEST(ToolTick, lets_a_fault_be_reset_where_the_axes_only_shake) {
    mill.run(Motion::rest, 1);
    int k = 301;
    const auto may_reset_at = [&](float mean_mm_s, float shake_mm_s) {
        std::array<float, hal::axis_count> velocity_mm_s{};
        for (const int end = k + 300; k < end; ++k) {
            velocity_mm_s[0] = mean_mm_s + (k % 2 == 0 ? shake_mm_s : -shake_mm_s);
            hal::DriveSample sample = sample_of(k);
            sample.axis_velocity_mm_s = velocity_mm_s;
            firmware::step_and_work(mill.tick, sample, mill.status);
        }
        return mill.tick.may_reset(velocity_mm_s);
    };
    CHECK(may_reset_at(0.0F, 0.0F));
    CHECK(may_reset_at(0.0F, 5.0F));
    const float smallest = machine_and_tool().machine.cnc.override_min;
    const float slowest_mm_s = smallest * mill.status.programmed_feed_mm_s;
    CHECK(may_reset_at(0.4F * slowest_mm_s, 5.0F));
    CHECK_FALSE(may_reset_at(0.6F * slowest_mm_s, 5.0F));
    CHECK_FALSE(may_reset_at(slowest_mm_s, 0.0F));
}

TEST(ToolTick, forgets_with_the_reset_what_a_rapid_taught_that_was_no_air) {
    const auto is_learnt = [&] { return mill.tick.of_tool().machine_knowledge().was_rezeroed; };
    mill.status.rapid = true;
    mill.run(Motion::air, 500);
    CHECK(is_learnt());
    const hal::FeedOverride in_contact = mill.run(Motion::cut, 300);
    UNSIGNED_LONGS_EQUAL(static_cast<unsigned>(control::Fault::idle_torque), in_contact.fault);
    mill.tick.reset_fault();
    CHECK_FALSE(is_learnt());
}

TEST(ToolTick, keeps_with_the_reset_what_air_taught_where_another_fault_was_found) {
    mill.run(Motion::rest, 500);
    const float before = variance_of_force(mill.tick);
    mill.tick.step_without_sample(1.0F, 1.0F, mill.status);
    mill.tick.reset_fault();
    CHECK(mill.tick.of_tool().machine_knowledge().was_rezeroed);
    CHECK_COMPARE(variance_of_force(mill.tick), <, 1.1F * before);
}

TEST(ToolTick, does_not_take_the_mean_of_a_revolution_that_is_long_over_for_rest) {
    mill.run(Motion::rest, 300);
    const std::array<float, hal::axis_count> moving_mm_s{5.0F, 0.0F, 0.0F};
    CHECK(mill.tick.may_reset(moving_mm_s));
    hal::DriveSample sample = sample_of(600);
    for (int k = 600; k < 800; ++k) {  // the spindle stands, an axis moves
        sample.time_us = sample_of(k).time_us;
        sample.axis_velocity_mm_s = moving_mm_s;
        firmware::step_and_work(mill.tick, sample, mill.status);
    }
    CHECK_FALSE(mill.tick.may_reset(moving_mm_s));
}

TEST(ToolTick, faults_where_samples_stay_away_with_an_unknown_tool_too) {
    mill.change_at_rest(99);
    CHECK(mill.tick.step_without_sample(1.0F, 1.0F, mill.status).hold);
    CHECK(mill.run(Motion::air, 100).hold);
    mill.tick.reset_fault();
    check_operators(mill.run(Motion::air, 100));
}

TEST(ToolTick, is_the_tick_of_its_one_tool_without_a_source) {
    firmware::ToolTick one(machine_and_tool());
    auto plain = fresh_tick();
    for (int k = 0; k < 1000; ++k) {
        one.follow_tool(static_cast<std::uint32_t>(k % 3), k % 2 == 0);
        const hal::FeedOverride a = firmware::step_and_work(one, sample_of(k), program());
        const hal::FeedOverride b = firmware::step_and_work(plain, sample_of(k), program());
        CHECK(a.ratio == b.ratio && a.hold == b.hold && a.state == b.state && a.heartbeat == b.heartbeat);
    }
    CHECK(one.is_tool_known());
    UNSIGNED_LONGS_EQUAL(0, one.tool());
}
