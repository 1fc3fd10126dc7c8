// SPDX-License-Identifier: Apache-2.0
#include "feed_bench.hpp"

#include <cmath>

#include <CppUTest/TestHarness.h>

using namespace millforce::control;
using namespace millforce::control::bench;

TEST_GROUP(Ceilings){};

namespace {

void check_ratio(float expected, const Output& output, double tolerance = 1e-5) {
    DOUBLES_EQUAL(static_cast<double>(expected), static_cast<double>(output.ratio), tolerance);
}

}  // namespace

TEST(Ceilings, in_air_the_feed_is_the_one_at_which_the_tool_may_meet_the_workpiece) {
    Controller controller;
    const Output output = repeat(controller, in_air(), 2000);
    check_ratio(ratio_of(0.05F, in_air()), output);
    CHECK(output.limit == Limit::air_feed);
}

TEST(Ceilings, in_air_the_ceiling_holds_for_the_highest_feed_that_the_program_may_bring) {
    Parameters p;
    p.highest_programmed_feed_mm_s = 40.0F;
    Controller controller(p);
    const float ratio_at_40 = 0.5F * ratio_of(0.05F, in_air());
    check_ratio(ratio_at_40, repeat(controller, in_air(), 2000));
    Input faster = in_air();
    faster.programmed_feed_mm_s = 40.0F;
    check_ratio(ratio_at_40, controller.step(faster));  // F doubles, the override need not move
}

TEST(Ceilings, the_highest_feed_is_learnt_from_the_blocks_but_not_from_rapids) {
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

TEST(Ceilings, from_contact_until_in_cut_the_entry_feed_is_not_exceeded) {
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

TEST(Ceilings, a_plunge_goes_no_faster_than_the_air_feed_nor_the_program) {
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

namespace {

Input with_way(Input input, float feed_mm_s) {
    input.way.known = true;
    input.way.feed_mm_s = feed_mm_s;
    return input;
}

}  // namespace

TEST(Ceilings, where_the_way_ahead_is_known_air_is_passed_at_its_feed) {
    Controller controller;
    const Output output = repeat(controller, with_way(in_air(), 18.0F), 2000);
    check_ratio(0.9F, output);
    CHECK(output.limit == Limit::way_ahead);
    CHECK_COMPARE(ratio_of(0.05F, in_air()), <, 0.9F);
}

TEST(Ceilings, where_the_way_ahead_is_known_no_surge_is_feared) {
    Parameters p = immediate();
    p.surge_radial_immersion = 2.0F;
    Input input = in_contact();
    input.cut.surge_ratio = 5.0F;
    Controller blind(p);
    CHECK(repeat(blind, input, 2000).limit == Limit::surge);
    Controller controller(p);
    const Output output = repeat(controller, with_way(input, 100.0F), 2000);
    CHECK(output.limit == Limit::force);
}

TEST(Ceilings, where_the_way_ahead_is_known_the_override_rises_as_fast_as_the_machine_can_in_air) {
    Controller controller;
    repeat(controller, in_air(), 2000);
    check_ratio(0.9F, repeat(controller, with_way(in_air(), 18.0F), 1));
}

TEST(Ceilings, a_step_of_the_depth_that_nobody_announces_stays_within_its_share_of_the_limit) {
    Parameters p = immediate();
    p.depth_step_ratio = 2.0F;
    p.depth_step_share = 1.4F;
    Controller controller(p);
    Input input = in_contact();
    const Output output = repeat(controller, input, 2000);
    CHECK(output.limit == Limit::depth_step);
    const float force_N = force_at(output.ratio, input);
    DOUBLES_EQUAL(1.4, static_cast<double>(2.0F * force_N / p.tooth_force_limit_N), 1e-4);
    CHECK(repeat(controller, with_way(input, 1000.0F), 2000).limit == Limit::force);
}

TEST(Ceilings, where_the_way_ahead_is_known_the_force_may_reach_its_set_point_though_the_depth_may_step) {
    Parameters p = immediate();
    p.depth_step_ratio = 2.0F;
    p.depth_step_share = 1.4F;
    Controller controller(p);
    const Output output = repeat(controller, with_way(in_contact(), 1000.0F), 2000);
    DOUBLES_EQUAL(static_cast<double>(p.setpoint_share * p.tooth_force_limit_N),
                  static_cast<double>(force_at(output.ratio, in_contact())), 0.1);
}

TEST(Ceilings, a_step_of_the_depth_that_was_met_once_is_expected_from_then_on) {
    Parameters p = immediate();
    p.depth_step_ratio = 2.0F;
    p.depth_step_share = 1.5F;
    Input deep = in_contact();
    deep.cut.tooth_force_N = 900.0F;
    Input shallow = in_contact();
    shallow.cut.tooth_force_N = 300.0F;
    const auto force_of_deep_N = [&](const Output& in_shallow) { return force_at(in_shallow.ratio, deep); };
    Controller controller(p);
    CHECK_COMPARE(force_of_deep_N(repeat(controller, shallow, 2000)), >, 1.6F * p.tooth_force_limit_N);
    repeat(controller, deep, 2000);
    const Output again = repeat(controller, shallow, 2000);
    CHECK(again.limit == Limit::depth_step);
    CHECK_COMPARE(force_of_deep_N(again), <=, 1.501F * p.tooth_force_limit_N);
    CHECK_COMPARE(force_of_deep_N(again), >, 1.2F * p.tooth_force_limit_N);
}

TEST(Ceilings, a_step_of_the_depth_that_the_set_point_survives_costs_nothing) {
    Parameters p = immediate();
    p.depth_step_ratio = 1.4F;
    p.depth_step_share = 1.4F;
    Controller controller(p);
    Controller of_one_depth(immediate());
    const Output output = repeat(controller, in_contact(), 2000);
    check_ratio(repeat(of_one_depth, in_contact(), 2000).ratio, output);
    CHECK(output.limit == Limit::force);
}

TEST(Ceilings, what_may_come_without_warning_holds_a_proven_program_no_lower_than_it_has_run) {
    Parameters p = immediate();
    p.entry_travel_mm = 5.0F;
    p.surge_radial_immersion = 2.0F;
    p.depth_step_ratio = 10.0F;
    p.proven_override = 0.8F;
    Controller controller(p);
    check_ratio(0.8F, repeat(controller, in_air(), 2000));
    Input input = in_contact();
    input.cut.surge_ratio = 50.0F;
    const Output at_entry = repeat(controller, input, 100);
    CHECK(at_entry.state == CutState::entry);
    check_ratio(0.8F, at_entry);
    const Output in_cut = repeat(controller, input, 2000);
    CHECK(in_cut.state == CutState::in_cut);
    check_ratio(0.8F, in_cut);
    check_ratio(0.8F, repeat(controller, in_air(), 100));
}

TEST(Ceilings, the_next_contact_may_come_at_the_feed_that_the_cuts_before_have_shown_to_be_safe) {
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

TEST(Ceilings, a_cut_that_fades_from_its_begin_shows_no_feed_to_be_safe) {
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

TEST(Ceilings, an_estimate_that_stands_for_many_steps_shows_no_more_than_one) {
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

TEST(Ceilings, below_the_cuts_before_the_next_contact_comes_at_the_feed_that_is_told) {
    Controller controller(immediate());
    repeat(controller, in_contact(), 2000);
    const float told = ratio_of(Parameters{}.air_feed_per_tooth_mm, in_air());
    CHECK_COMPARE(repeat(controller, in_air(), 2000).ratio, >, 1.5F * told);
    Input lower = in_air();
    lower.velocity_z_mm_s = -10.0F;
    repeat(controller, lower, 100);  // 1 mm
    check_ratio(told, repeat(controller, in_air(), 100));
}

TEST(Ceilings, behind_a_light_cut_the_tool_waits_for_the_next_wall_at_that_feed) {
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

TEST(Ceilings, what_may_come_without_warning_holds_the_feed_no_lower_than_that_of_an_entry) {
    Parameters p = immediate();
    p.surge_radial_immersion = 2.0F;
    p.depth_step_ratio = 10.0F;
    Controller controller(p);
    Input input = in_contact();
    input.cut.surge_ratio = 50.0F;
    input.cut.turn_ratio = 50.0F;
    check_ratio(ratio_of(p.entry_feed_per_tooth_mm, input), repeat(controller, input, 2000));
}

TEST(Ceilings, a_force_that_is_there_holds_a_proven_program_at_its_limit) {
    Parameters p = immediate();
    p.proven_override = 5.0F;
    Controller controller(p);
    const Input input = in_contact();
    const Output output = repeat(controller, input, 2000);
    CHECK(output.limit == Limit::force);
    CHECK_COMPARE(output.ratio, <, 5.0F);
    DOUBLES_EQUAL(static_cast<double>(p.setpoint_share * p.tooth_force_limit_N),
                  static_cast<double>(force_at(output.ratio, input)), 0.1);
}

TEST(Ceilings, an_unknown_immersion_slows_a_proven_program_by_the_least_force_alone) {
    Parameters p = immediate();
    p.proven_override = 0.8F;
    Controller controller(p);
    Input input = in_contact();
    input.cut.tooth_force_is_bound = true;
    input.cut.tooth_force_N = 9000.0F;
    input.cut.least_tooth_force_N = 500.0F;
    check_ratio(0.8F, repeat(controller, input, 2000));
    input.cut.least_tooth_force_N = 5000.0F;
    CHECK_COMPARE(repeat(controller, input, 2000).ratio, <, 0.8F);
}

TEST(Ceilings, the_way_ahead_raises_nothing_above_the_force_nor_without_an_estimate) {
    Parameters p = immediate();
    Controller controller(p);
    const float by_force = repeat(controller, with_way(in_contact(), 1000.0F), 2000).ratio;
    Controller blind(p);
    check_ratio(repeat(blind, in_contact(), 2000).ratio, controller.step(with_way(in_contact(), 1000.0F)));
    CHECK_COMPARE(repeat(controller, with_way(without_force(in_contact()), 1000.0F), 200).ratio, <=, by_force);
}

TEST(Ceilings, a_feed_of_the_way_ahead_that_is_not_a_number_is_no_feed) {
    Controller controller;
    check_ratio(Parameters{}.override_min, repeat(controller, with_way(in_contact(), not_a_number), 2000));
}

TEST(Ceilings, a_rapid_gives_1) {
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

TEST(Ceilings, in_air_without_a_force_the_override_falls_to_its_minimum_unless_the_spindle_does_not_mill) {
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

TEST(Ceilings, without_a_force_the_override_does_not_rise_though_the_spindle_does_not_mill) {
    Controller controller;
    Input blind = without_force(in_air());
    blind.cut.spindle_does_not_mill = true;
    check_ratio(Parameters{}.override_min, repeat(controller, blind, 2000));
}

TEST(Ceilings, contact_that_begins_in_a_rapid_ends_its_freedom) {
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

TEST(Ceilings, a_rapid_at_the_feed_of_a_block_is_none_where_the_CNC_tells_the_feed_of_rapids) {
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

TEST(Ceilings, a_rapid_without_a_feed_gives_1_though_the_CNC_has_told_the_feed_of_others) {
    Controller controller;
    Input rapid = in_air();
    rapid.rapid = true;
    rapid.programmed_feed_mm_s = 400.0F;
    controller.step(rapid);
    check_ratio(ratio_of(0.05F, in_air()), repeat(controller, in_air(), 2000));
    rapid.programmed_feed_mm_s = 0.0F;
    check_ratio(1.0F, repeat(controller, rapid, 2000));
}

TEST(Ceilings, axes_that_are_faster_than_the_programmed_feed_allows_raise_nothing) {
    Controller controller;
    bring_into_cut(controller);
    Input input = in_contact();
    const float before = controller.step(input).ratio;
    input.programmed_feed_mm_s = 2.0F;  // told in another unit
    const Output output = repeat(controller, input, 1000);
    CHECK(output.ratio <= before);
    CHECK(output.limit == Limit::feed_mismatch);
}

TEST(Ceilings, an_unknown_programmed_feed_raises_nothing) {
    for (const float feed_mm_s : {0.0F, -20.0F, not_a_number, beyond_all}) {
        Controller controller;
        const float before = repeat(controller, in_air(), 50).ratio;
        Input input = in_air();
        input.programmed_feed_mm_s = feed_mm_s;
        const Output output = repeat(controller, input, 1000);
        check_ratio(before, output, 1e-7);
        CHECK(output.limit == Limit::no_estimate);
    }
}

TEST(Ceilings, monitor_only_leaves_the_override_to_the_operator_at_once) {
    Parameters p;
    p.monitor_only = true;
    Controller controller(p);
    Input input = in_contact();
    input.cut.tooth_force_N = 5000.0F;
    for (const float wanted : {0.3F, 1.0F, 1.2F, 0.7F}) {
        input.operator_override = wanted;
        const Output output = repeat(controller, input, 50);
        check_ratio(wanted, output, 1e-7);
        CHECK_FALSE(output.hold);
        CHECK(output.fault == Fault::none);
    }
    input.operator_override = 2.0F;
    check_ratio(1.5F, controller.step(input), 1e-7);
}

TEST(Ceilings, monitor_only_watches_the_cut_all_the_same) {
    Parameters p;
    p.monitor_only = true;
    Controller controller(p);
    CHECK(bring_into_cut(controller).state == CutState::in_cut);
    const Output blind = repeat(controller, without_force(in_contact()), 1000);
    CHECK(blind.state == CutState::hold);
    CHECK_FALSE(blind.hold);  // it is not asked
    Input stale = in_contact();
    stale.time_since_sample_s = 1.0F;
    CHECK(controller.step(stale).hold);
}

TEST(Ceilings, a_load_that_has_not_answered_bounds_the_feed_of_a_cut_with_or_without_a_map) {
    for (const bool has_map : {false, true}) {
        Controller controller(immediate());
        bring_into_cut(controller);
        Input light = in_contact();
        light.cut.tooth_force_N = 300.0F;
        light.way.known = has_map;
        light.way.feed_mm_s = 100.0F;
        const Output free = repeat(controller, light, 200);
        light.cut.answered_feed_mm_s = 0.5F * free.ratio * light.programmed_feed_mm_s;
        const Output bound = repeat(controller, light, 200);
        check_ratio(0.5F * free.ratio, bound);
        CHECK(bound.limit == Limit::load_unanswered);
        STRCMP_EQUAL("load_unanswered", name(bound.limit));
        light.cut.answered_feed_mm_s = 0.0F;
        check_ratio(free.ratio, repeat(controller, light, 400));
    }
}

TEST(Ceilings, forces_that_contradict_the_law_raise_nothing_and_still_lower) {
    Controller controller(immediate());
    bring_into_cut(controller);
    const float before = repeat(controller, in_contact(), 20).ratio;
    Input light = in_contact();
    light.cut.law_is_refuted = true;
    light.cut.tooth_force_N = 100.0F;
    const Output held = repeat(controller, light, 200);
    check_ratio(before, held);
    CHECK(held.limit == Limit::law_misfit);
    STRCMP_EQUAL("law_misfit", name(held.limit));
    Input heavy = light;
    heavy.cut.tooth_force_N = 1300.0F;
    CHECK(repeat(controller, heavy, 20).ratio < 0.5F * before);
    light.cut.law_is_refuted = false;
    CHECK(repeat(controller, light, 20).ratio > before);
}

TEST(Ceilings, where_a_surge_may_come_and_the_immersion_is_not_known_the_feed_is_that_of_an_entry) {
    Parameters p = immediate();
    p.surge_radial_immersion = 1.0F;
    Controller controller(p);
    bring_into_cut(controller);
    Input bound = in_contact();
    bound.cut.tooth_force_is_bound = true;
    bound.cut.tooth_force_N = 100.0F;
    const Output output = repeat(controller, bound, 20);
    check_ratio(ratio_of(p.entry_feed_per_tooth_mm, bound), output);
    CHECK(output.limit == Limit::surge);
}

TEST(Ceilings, an_old_estimate_moves_no_ceiling_of_a_surge) {
    Parameters p = immediate();
    p.surge_radial_immersion = 1.0F;
    Controller controller(p);
    bring_into_cut(controller);
    const float before = repeat(controller, in_contact(), 20).ratio;
    Input old = in_contact();
    old.cut.surge_ratio = 5.0F;
    old.cut.fresh = false;
    check_ratio(before, controller.step(old));
}

TEST(Ceilings, an_estimate_that_the_law_says_nothing_of_moves_no_ceiling_of_a_surge) {
    Parameters p = immediate();
    p.surge_radial_immersion = 1.0F;
    Controller controller(p);
    bring_into_cut(controller);
    const float before = repeat(controller, in_contact(), 20).ratio;
    Input without_feed = in_contact();
    without_feed.cut.surge_ratio = 5.0F;
    without_feed.cut.feed_mm_s = 0.0F;
    check_ratio(before, controller.step(without_feed));
}

TEST(Ceilings, over_a_gap_the_override_returns_to_that_of_the_cut_before) {
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

TEST(Ceilings, a_cut_is_not_compared_with_the_one_before) {
    Parameters p = immediate();
    p.exit_travel_mm = 0.0F;
    Controller controller(p);
    Input input = in_contact();
    input.cut.section_mm2 = 10.0F;
    repeat(controller, input, 500);
    CHECK(repeat(controller, in_air(), 100).state == CutState::air);
    input.cut.section_mm2 = 5.0F;
    CHECK_FALSE(repeat(controller, input, 5).fading);
}

TEST(Ceilings, the_lowest_lies_within_the_range_of_the_override) {
    Input input = in_air();
    input.operator_override = -1.0F;
    const Ceilings<float> ceilings;
    const auto lowest = ceilings.lowest(Parameters{}, input, {CutState::air, false, 0.5F, 1.0F});
    DOUBLES_EQUAL(static_cast<double>(Parameters{}.override_min), static_cast<double>(lowest.override_ratio), 0.0);
}

TEST(Ceilings, a_cut_goes_on_behind_a_feed_hold_as_fast_as_it_was_though_it_may_not_begin_so_fast) {
    Controller controller;
    Input input = in_contact();
    input.cut.turn_ratio = 5.0F;  // a slot of that depth is too heavy
    const float before = repeat(controller, input, 2000).ratio;
    CHECK_COMPARE(before, >, 1.5F * ratio_of(Parameters{}.entry_feed_per_tooth_mm, input));
    Input held = input;
    held.feed_hold = true;
    CHECK(repeat(controller, held, 100).state == CutState::hold);
    const Output released = controller.step(input);
    CHECK(released.state == CutState::entry);
    check_ratio(before, released);
}

TEST(Ceilings, behind_a_gap_the_feed_may_rise_to_that_of_an_entry) {
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

TEST(Ceilings, the_growth_of_an_entry_holds_nothing_in_the_cut_behind_it) {
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

TEST(Ceilings, a_programmed_feed_without_end_is_not_learnt_as_the_highest) {
    Controller controller;
    const float before = repeat(controller, in_air(), 2000).ratio;
    Input endless = in_air();
    endless.programmed_feed_mm_s = beyond_all;
    controller.step(endless);
    check_ratio(before, repeat(controller, in_air(), 2000));
}

TEST(Ceilings, an_override_at_its_lowest_says_so_whatever_has_lowered_it) {
    Controller controller;
    Input input = in_contact();
    input.cut.tooth_force_N = 1300.0F;
    input.cut.cutting_share = 0.1F;
    bring_into_cut(controller, input);
    const Output output = repeat(controller, input, 500);
    check_ratio(Parameters{}.override_min, output);
    CHECK(output.limit == Limit::override_min);
}

TEST(Ceilings, a_feed_that_was_not_known_for_a_step_lifts_no_ceiling_of_a_surge) {
    Parameters p = immediate();
    p.surge_radial_immersion = 1.0F;
    Controller controller(p);
    Input input = in_contact();
    input.cut.surge_ratio = 3.0F;
    bring_into_cut(controller, input);
    const Output before = repeat(controller, input, 20);
    CHECK(before.limit == Limit::surge);
    input.programmed_feed_mm_s = 0.0F;
    controller.step(input);
    input.programmed_feed_mm_s = in_contact().programmed_feed_mm_s;
    input.cut.fresh = false;
    check_ratio(before.ratio, controller.step(input));
}

TEST(Ceilings, a_cut_after_air_begins_with_the_feed_of_an_entry_though_the_tool_has_cut_before) {
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
