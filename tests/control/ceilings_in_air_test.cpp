// SPDX-License-Identifier: Apache-2.0
#include "ceilings_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::control;
using namespace millforce::control::bench;

/// Of air, rapids, entries, and the cut behind a gap.
TEST_GROUP(CeilingsInAir){};

TEST(CeilingsInAir, in_air_the_feed_is_the_one_at_which_the_tool_may_meet_the_workpiece) {
    Controller controller;
    const Output output = repeat(controller, in_air(), 2000);
    check_ratio(ratio_of(0.05F, in_air()), output);
    CHECK(output.limit == Limit::air_feed);
}

TEST(CeilingsInAir, in_air_the_ceiling_holds_for_the_highest_feed_that_the_program_may_bring) {
    Parameters p;
    p.highest_programmed_feed_mm_s = 40.0F;
    Controller controller(p);
    const float ratio_at_40 = 0.5F * ratio_of(0.05F, in_air());
    check_ratio(ratio_at_40, repeat(controller, in_air(), 2000));
    Input faster = in_air();
    faster.programmed_feed_mm_s = 40.0F;
    check_ratio(ratio_at_40, controller.step(faster));  // F doubles, the override need not move
}

TEST(CeilingsInAir, the_highest_feed_is_learnt_from_the_blocks_but_not_from_rapids) {
    Controller controller;
    Input input = in_air();
    input.programmed_feed_mm_s = 400.0F;
    input.rapid = true;
    controller.step(input);
    check_ratio(ratio_of(0.05F, in_air()), repeat(controller, in_air(), 2000));
    input.programmed_feed_mm_s = 40.0F;
    input.rapid = false;
    controller.step(input);
    check_ratio(0.5F * ratio_of(0.05F, in_air()), repeat(controller, in_air(), 2000));
}

TEST(CeilingsInAir, from_contact_until_in_cut_the_entry_feed_is_not_exceeded) {
    Parameters p;
    p.air_feed_per_tooth_mm = 0.1F;
    p.entry_feed_per_tooth_mm = 0.03F;
    p.entry_travel_mm = 20.0F;
    Controller controller(p);
    repeat(controller, in_air(), 2000);
    Input light = in_contact();
    light.cut.tooth_force_N = 50.0F;
    const Output output = repeat(controller, light, 100);
    CHECK(output.state == CutState::entry);
    CHECK(output.limit == Limit::entry_feed);
    check_ratio(ratio_of(0.03F, light), output);
}

TEST(CeilingsInAir, a_plunge_goes_no_faster_than_the_air_feed_nor_the_program) {
    Controller controller;
    bring_into_cut(controller);
    Input input = in_contact();
    repeat(controller, input, 2000);
    input.plunging = true;
    check_ratio(ratio_of(0.05F, input), repeat(controller, input, 100));
    Parameters p;
    p.air_feed_per_tooth_mm = 0.2F;
    Controller roomy(p);
    Input above = in_air();
    above.plunging = true;
    check_ratio(1.0F, repeat(roomy, above, 2000));
}

// ---- The way ahead
// ---------------------------------------------------------------------------------------------------

TEST(CeilingsInAir, the_next_contact_may_come_at_the_feed_that_the_cuts_before_have_shown_to_be_safe) {
    Parameters p = immediate();
    p.depth_step_ratio = 2.0F;
    p.depth_step_share = 1.5F;
    Controller controller(p);
    check_ratio(ratio_of(p.air_feed_per_tooth_mm, in_air()), repeat(controller, in_air(), 2000));
    const Output cut = repeat(controller, in_contact(), 2000);
    CHECK(cut.limit == Limit::depth_step);
    const Output air = repeat(controller, in_air(), 2000);
    CHECK(air.state == CutState::air);
    check_ratio(cut.ratio, air);  // a slot of the same depth: the tooth force is in its front
    CHECK(air.limit == Limit::air_feed);
}

TEST(CeilingsInAir, a_cut_that_fades_from_its_begin_shows_no_feed_to_be_safe) {
    Controller controller(immediate());
    Input input = in_contact();
    input.cut.section_mm2 = 10.0F;
    Output output;
    for (int k = 0; k < 100; ++k) {
        output = controller.step(input);
        input.cut.section_mm2 *= 0.95F;
    }
    CHECK(output.state == CutState::in_cut);
    CHECK_TRUE(output.fading);
    check_ratio(ratio_of(Parameters{}.air_feed_per_tooth_mm, in_air()), repeat(controller, in_air(), 2000));
}

TEST(CeilingsInAir, an_estimate_that_stands_for_many_steps_shows_no_more_than_one) {
    Controller controller(immediate());
    Input old = in_contact();
    old.cut.fresh = false;
    for (int k = 0; k < 10; ++k) {
        controller.step(in_contact());
        repeat(controller, old, 100);
    }
    CHECK(controller.state() == CutState::in_cut);
    check_ratio(ratio_of(Parameters{}.air_feed_per_tooth_mm, in_air()), repeat(controller, in_air(), 2000));
}

TEST(CeilingsInAir, an_estimate_without_a_speed_or_before_any_feed_was_told_does_not_spoil_the_feed_that_is_safe) {
    const auto after = [](const Input& unknown) {
        Controller controller(immediate());
        repeat(controller, unknown, 10);
        repeat(controller, in_contact(), 2000);
        return repeat(controller, in_air(), 2000);
    };
    const float told = ratio_of(Parameters{}.air_feed_per_tooth_mm, in_air());
    const float safe = after(in_contact()).ratio;
    CHECK_COMPARE(safe, >, 1.5F * told);
    Input without_speed = in_contact();
    without_speed.cut.spindle_speed_rad_s = 0.0F;
    Input before_any_feed = in_contact();
    before_any_feed.programmed_feed_mm_s = 0.0F;
    check_ratio(safe, after(without_speed));
    check_ratio(safe, after(before_any_feed));
}

TEST(CeilingsInAir, below_the_cuts_before_the_next_contact_comes_at_the_feed_that_is_told) {
    Controller controller(immediate());
    repeat(controller, in_contact(), 2000);
    const float told = ratio_of(Parameters{}.air_feed_per_tooth_mm, in_air());
    CHECK_COMPARE(repeat(controller, in_air(), 2000).ratio, >, 1.5F * told);
    Input lower = in_air();
    lower.velocity_z_mm_s = -10.0F;
    repeat(controller, lower, 100);  // 1 mm
    check_ratio(told, repeat(controller, in_air(), 100));
}

TEST(CeilingsInAir, behind_a_light_cut_the_tool_waits_for_the_next_wall_at_that_feed) {
    Parameters p = immediate();
    p.exit_travel_mm = 1000.0F;
    Controller controller(p);
    repeat(controller, in_contact(), 2000);
    Input light = in_contact();
    light.cut.tooth_force_N = 200.0F;
    light.cut.turn_ratio = 5.0F;
    const float in_light_cut = repeat(controller, light, 2000).ratio;
    const Output behind = repeat(controller, in_air(), 2000);
    CHECK(behind.state == CutState::exit);
    CHECK_COMPARE(behind.ratio, <, in_light_cut);
}

TEST(CeilingsInAir, a_rapid_gives_1) {
    for (const bool from_cut : {false, true}) {
        Controller controller;
        if (from_cut) {
            bring_into_cut(controller);
            CHECK(repeat(controller, in_contact(), 2000).ratio > 1.0F);
        }
        Input input = in_air();
        input.rapid = true;
        input.programmed_feed_mm_s = 0.0F;
        check_ratio(1.0F, repeat(controller, input, 2000));
    }
}

TEST(CeilingsInAir, in_air_without_a_force_the_override_falls_to_its_minimum_unless_the_spindle_does_not_mill) {
    for (const bool mills : {true, false}) {
        Controller controller;
        const float in_sight = repeat(controller, in_air(), 2000).ratio;
        Input blind = without_force(in_air());
        blind.cut.spindle_does_not_mill = !mills;
        const Output output = repeat(controller, blind, 50);  // 1 of the 2 mm that are fed before the hold
        check_ratio(mills ? Parameters{}.override_min : in_sight, output);
        CHECK(output.state == CutState::air);
    }
}

TEST(CeilingsInAir, without_a_force_the_override_does_not_rise_though_the_spindle_does_not_mill) {
    Controller controller;
    Input blind = without_force(in_air());
    blind.cut.spindle_does_not_mill = true;
    check_ratio(Parameters{}.override_min, repeat(controller, blind, 2000));
}

TEST(CeilingsInAir, a_feed_that_is_told_no_more_is_taken_for_the_highest_so_far) {
    for (const float untold : {0.0F, not_a_number}) {
        Controller controller;
        Input input = in_air();
        input.programmed_feed_mm_s = 40.0F;
        controller.step(input);
        input.rapid = true;
        check_ratio(1.0F, repeat(controller, input, 2000));
        input.rapid = false;
        input.programmed_feed_mm_s = untold;
        check_ratio(0.5F * ratio_of(0.05F, in_air()), repeat(controller, input, 2000));
    }
}

TEST(CeilingsInAir, before_a_feed_was_told_the_override_in_air_is_its_minimum) {
    Controller controller;
    Input input = in_air();
    input.rapid = true;
    input.programmed_feed_mm_s = 0.0F;
    repeat(controller, input, 2000);
    input.rapid = false;
    check_ratio(Parameters{}.override_min, repeat(controller, input, 2000));
}

TEST(CeilingsInAir, contact_that_begins_in_a_rapid_ends_its_freedom) {
    Controller controller;
    Input input = in_air();
    input.rapid = true;
    input.programmed_feed_mm_s = 400.0F;
    check_ratio(1.0F, repeat(controller, input, 2000));
    input = in_contact();
    input.rapid = true;
    const Output output = repeat(controller, input, 100);
    CHECK(output.state == CutState::entry);
    check_ratio(ratio_of(0.05F, in_contact()), output);
}

TEST(CeilingsInAir, a_rapid_at_the_feed_of_a_block_is_none_where_the_CNC_tells_the_feed_of_rapids) {
    Input stuck = in_air();
    stuck.rapid = true;
    for (const float told_mm_s : {0.0F, beyond_all, 400.0F}) {
        Controller controller;
        Input rapid = stuck;
        rapid.programmed_feed_mm_s = told_mm_s;
        controller.step(in_air());
        repeat(controller, rapid, 2000);
        const bool tells = told_mm_s == 400.0F;
        check_ratio(tells ? ratio_of(0.05F, in_air()) : 1.0F, repeat(controller, stuck, 2000));
    }
}

TEST(CeilingsInAir, a_rapid_without_a_feed_gives_1_though_the_CNC_has_told_the_feed_of_others) {
    Controller controller;
    Input rapid = in_air();
    rapid.rapid = true;
    rapid.programmed_feed_mm_s = 400.0F;
    controller.step(rapid);
    check_ratio(ratio_of(0.05F, in_air()), repeat(controller, in_air(), 2000));
    rapid.programmed_feed_mm_s = 0.0F;
    check_ratio(1.0F, repeat(controller, rapid, 2000));
}

TEST(CeilingsInAir, over_a_gap_the_override_returns_to_that_of_the_cut_before) {
    Parameters p = immediate();
    p.exit_travel_mm = 100.0F;
    p.override_max = 1.0F;  // above it the axes, at 20 mm/s, would seem to brake for a corner
    Controller controller(p);
    bring_into_cut(controller);
    const float before = repeat(controller, in_contact(), 20).ratio;
    Input gap = in_air();
    check_ratio(before, repeat(controller, gap, 5));
    gap.plunging = true;
    CHECK(repeat(controller, gap, 5).ratio < 0.9F * before);
    gap.plunging = false;
    const Output output = repeat(controller, gap, 20);
    CHECK(output.state == CutState::exit);
    check_ratio(before, output);
}

TEST(CeilingsInAir, behind_a_gap_too_short_to_slow_down_in_a_cut_goes_on_as_fast_as_the_tool_comes) {
    Controller controller;
    Input input = in_contact();
    input.cut.turn_ratio = 5.0F;  // a slot of that depth is too heavy
    const float may_begin = ratio_of(Parameters{}.entry_feed_per_tooth_mm, input);
    CHECK_COMPARE(repeat(controller, input, 2000).ratio, >, 1.5F * may_begin);
    const float comes = repeat(controller, in_air(), 5).ratio;
    CHECK_COMPARE(comes, >, 1.2F * may_begin);
    const Output again = repeat(controller, input, 5);
    CHECK(again.state == CutState::entry);
    CHECK(again.limit == Limit::entry_feed);
    check_ratio(comes, again);
}

TEST(CeilingsInAir, a_cut_goes_on_behind_a_feed_hold_as_fast_as_it_was_though_it_may_not_begin_so_fast) {
    Controller controller;
    Input input = in_contact();
    input.cut.turn_ratio = 5.0F;  // a slot of that depth is too heavy
    const float before = repeat(controller, input, 2000).ratio;
    CHECK_COMPARE(before, >, 1.5F * ratio_of(Parameters{}.entry_feed_per_tooth_mm, input));
    Input held = input;
    held.feed_hold = true;
    CHECK(repeat(controller, held, 100).state == CutState::hold);
    const Output released = controller.step(input);
    CHECK(released.state == CutState::in_cut);
    check_ratio(before, released);
}

TEST(CeilingsInAir, behind_a_gap_the_feed_may_rise_to_that_of_an_entry) {
    Parameters p = immediate();
    p.entry_travel_mm = 5.0F;
    Controller controller(p);
    Input input = in_contact();
    input.cut.tooth_force_N = 1300.0F;
    input.cut.cutting_share = 0.5F;
    input.cut.turn_cutting_share = 0.5F;
    CHECK(repeat(controller, input, 500).ratio < 0.5F);
    CHECK(repeat(controller, in_air(), 5).state == CutState::exit);
    input.cut.tooth_force_N = 300.0F;
    const Output output = repeat(controller, input, 5);
    CHECK(output.state == CutState::entry);
    check_ratio(ratio_of(p.entry_feed_per_tooth_mm, input), output);
}

TEST(CeilingsInAir, the_growth_of_an_entry_holds_nothing_in_the_cut_behind_it) {
    Parameters p = immediate();
    p.entry_travel_mm = 1.0F;
    p.surge_radial_immersion = 1.0F;
    Controller controller(p);
    Input input = in_contact();
    input.cut.section_mm2 = 1.0F;
    Output output;
    for (int k = 0; k < 100 && output.state != CutState::in_cut; ++k) {
        input.cut.section_mm2 *= k < 20 ? 1.0F : 1.04F;
        output = controller.step(input);
    }
    CHECK(output.state == CutState::in_cut);
    CHECK(output.limit == Limit::force);
}

TEST(CeilingsInAir, a_programmed_feed_without_end_is_not_learnt_as_the_highest) {
    Controller controller;
    const float before = repeat(controller, in_air(), 2000).ratio;
    Input endless = in_air();
    endless.programmed_feed_mm_s = beyond_all;
    controller.step(endless);
    check_ratio(before, repeat(controller, in_air(), 2000));
}

TEST(CeilingsInAir, a_cut_after_air_begins_with_the_feed_of_an_entry_though_the_tool_has_cut_before) {
    Parameters p = immediate();
    p.air_feed_per_tooth_mm = 0.08F;
    p.entry_travel_mm = 5.0F;
    Controller controller(p);
    Input input = in_contact();
    input.cut.turn_ratio = 50.0F;  // a slot of that depth is too heavy
    repeat(controller, input, 500);
    const Output air = repeat(controller, in_air(), 500);
    CHECK(air.state == CutState::air);
    check_ratio(ratio_of(0.08F, in_air()), air);
    const Output entry = repeat(controller, input, 5);
    CHECK(entry.state == CutState::entry);
    check_ratio(ratio_of(p.entry_feed_per_tooth_mm, in_contact()), entry);
}
