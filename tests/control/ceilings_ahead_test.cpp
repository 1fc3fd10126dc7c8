// SPDX-License-Identifier: Apache-2.0
#include "ceilings_bench.hpp"

#include <CppUTest/TestHarness.h>

#include <initializer_list>

using namespace millforce::control;
using namespace millforce::control::bench;

namespace {

Parameters fearing_everything() {
    Parameters p = immediate();
    p.entry_travel_mm = 5.0F;
    p.surge_radial_immersion = 2.0F;
    p.depth_step_ratio = 10.0F;
    return p;
}

Input of_unknown_immersion() {
    Input input = in_contact();
    input.cut.tooth_force_is_bound = true;
    input.cut.tooth_force_N = 9000.0F;
    input.cut.least_tooth_force_N = 500.0F;
    return input;
}

}  // namespace

/// Of what may come: without warning, or along a way that is known.
TEST_GROUP(CeilingsAhead){};

TEST(CeilingsAhead, where_the_way_ahead_is_known_air_is_passed_at_its_feed) {
    Controller controller;
    const Output output = repeat(controller, with_way(in_air(), 18.0F), 2000);
    check_ratio(0.9F, output);
    CHECK(output.limit == Limit::way_ahead);
    CHECK_COMPARE(ratio_of(0.05F, in_air()), <, 0.9F);
}

TEST(CeilingsAhead, where_the_way_ahead_is_known_no_surge_is_feared) {
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

TEST(CeilingsAhead, where_the_way_ahead_is_known_the_override_rises_as_fast_as_the_machine_can_in_air) {
    Controller controller;
    repeat(controller, in_air(), 2000);
    check_ratio(0.9F, repeat(controller, with_way(in_air(), 18.0F), 1));
}

TEST(CeilingsAhead, a_step_of_the_depth_that_nobody_announces_stays_within_its_share_of_the_limit) {
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

TEST(CeilingsAhead, where_the_way_ahead_is_known_the_force_may_reach_its_set_point_though_the_depth_may_step) {
    Parameters p = immediate();
    p.depth_step_ratio = 2.0F;
    p.depth_step_share = 1.4F;
    Controller controller(p);
    const Output output = repeat(controller, with_way(in_contact(), 1000.0F), 2000);
    DOUBLES_EQUAL(static_cast<double>(p.setpoint_share * p.tooth_force_limit_N),
                  static_cast<double>(force_at(output.ratio, in_contact())), 0.1);
}

TEST(CeilingsAhead, a_step_of_the_depth_that_was_met_once_is_expected_from_then_on) {
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

TEST(CeilingsAhead, a_step_of_the_depth_that_the_set_point_survives_costs_nothing) {
    Parameters p = immediate();
    p.depth_step_ratio = 1.4F;
    p.depth_step_share = 1.4F;
    Controller controller(p);
    Controller of_one_depth(immediate());
    const Output output = repeat(controller, in_contact(), 2000);
    check_ratio(repeat(of_one_depth, in_contact(), 2000).ratio, output);
    CHECK(output.limit == Limit::force);
}

TEST(CeilingsAhead, what_may_come_without_warning_holds_a_proven_program_no_lower_than_it_has_run) {
    Parameters p = fearing_everything();
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

TEST(CeilingsAhead, what_may_come_without_warning_holds_the_feed_no_lower_than_that_of_an_entry) {
    Parameters p = immediate();
    p.surge_radial_immersion = 2.0F;
    p.depth_step_ratio = 10.0F;
    Controller controller(p);
    Input input = in_contact();
    input.cut.surge_ratio = 50.0F;
    input.cut.turn_ratio = 50.0F;
    check_ratio(ratio_of(p.entry_feed_per_tooth_mm, input), repeat(controller, input, 2000));
}

TEST(CeilingsAhead, a_force_that_is_there_holds_a_proven_program_at_its_limit) {
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

TEST(CeilingsAhead, what_may_come_without_warning_is_survived_at_depth_step_share_times_a_safe_feed) {
    Parameters p = fearing_everything();
    p.depth_step_share = 1.4F;
    p.safe_override = 0.5F;
    Controller controller(p);
    check_ratio(0.7F, repeat(controller, in_air(), 2000));
    Input input = in_contact();
    input.cut.surge_ratio = 50.0F;
    check_ratio(0.7F, repeat(controller, input, 100));
    check_ratio(0.7F, repeat(controller, input, 2000));
    input.cut.tooth_force_N = 5000.0F;
    CHECK_COMPARE(repeat(controller, input, 2000).ratio, <, 0.5F);
}

TEST(CeilingsAhead, a_cut_of_unknown_immersion_is_milled_at_the_safe_feed_itself) {
    Parameters p = immediate();
    p.safe_override = 0.5F;
    Controller controller(p);
    check_ratio(0.5F, repeat(controller, of_unknown_immersion(), 2000));
}

TEST(CeilingsAhead, an_unknown_immersion_slows_a_proven_program_by_the_least_force_alone) {
    Parameters p = immediate();
    p.proven_override = 0.8F;
    Controller controller(p);
    Input input = of_unknown_immersion();
    check_ratio(0.8F, repeat(controller, input, 2000));
    input.cut.least_tooth_force_N = 5000.0F;
    CHECK_COMPARE(repeat(controller, input, 2000).ratio, <, 0.8F);
}

TEST(CeilingsAhead, the_way_ahead_raises_nothing_above_the_force_nor_without_an_estimate) {
    Parameters p = immediate();
    Controller controller(p);
    const float by_force = repeat(controller, with_way(in_contact(), 1000.0F), 2000).ratio;
    Controller blind(p);
    check_ratio(repeat(blind, in_contact(), 2000).ratio, controller.step(with_way(in_contact(), 1000.0F)));
    CHECK_COMPARE(repeat(controller, with_way(without_force(in_contact()), 1000.0F), 200).ratio, <=, by_force);
}

TEST(CeilingsAhead, the_way_ahead_lowers_the_feed_though_the_spindle_s_speed_is_missing) {
    Controller controller;
    const Input in_cut = with_way(in_contact(), 18.0F);
    const float before = repeat(controller, in_cut, 2000).ratio;
    Input near_a_wall = with_way(in_contact(), 6.0F);
    near_a_wall.cut.fresh = false;
    near_a_wall.cut.spindle_speed_rad_s = not_a_number;
    const Output output = controller.step(near_a_wall);
    CHECK_COMPARE(output.ratio, <, before);
    CHECK(output.limit == Limit::way_ahead);
    near_a_wall.way.feed_mm_s = 1000.0F;
    CHECK(controller.step(near_a_wall).limit == Limit::no_estimate);
}

TEST(CeilingsAhead, the_way_ahead_counts_by_the_highest_feed_where_the_programmed_one_is_missing) {
    Controller controller;
    Input fast = with_way(in_contact(), 18.0F);
    fast.programmed_feed_mm_s = 40.0F;
    controller.step(fast);
    repeat(controller, with_way(in_contact(), 18.0F), 2000);
    Input input = with_way(in_contact(), 6.0F);
    input.programmed_feed_mm_s = not_a_number;
    const Output output = repeat(controller, input, 2000);
    check_ratio(6.0F / 40.0F, output);
    CHECK(output.limit == Limit::way_ahead);
}

TEST(CeilingsAhead, a_feed_of_the_way_ahead_that_is_not_a_number_is_no_feed) {
    Controller controller;
    check_ratio(Parameters{}.override_min, repeat(controller, with_way(in_contact(), not_a_number), 2000));
}

TEST(CeilingsAhead, where_a_surge_may_come_and_the_immersion_is_not_known_the_feed_is_that_of_an_entry) {
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

TEST(CeilingsAhead, an_old_estimate_moves_no_ceiling_of_a_surge) {
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

TEST(CeilingsAhead, an_estimate_that_the_law_says_nothing_of_moves_no_ceiling_of_a_surge) {
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

TEST(CeilingsAhead, a_feed_that_was_not_known_for_a_step_lifts_no_ceiling_of_a_surge) {
    Parameters p = immediate();
    p.surge_radial_immersion = 1.0F;
    Input input = in_contact();
    input.cut.surge_ratio = 3.0F;
    for (const bool in_rapid : {false, true}) {
        Controller controller(p);
        bring_into_cut(controller, input);
        const Output before = repeat(controller, input, 20);
        CHECK(before.limit == Limit::surge);
        Input unknown = input;
        unknown.programmed_feed_mm_s = 0.0F;
        unknown.rapid = in_rapid;
        controller.step(unknown);
        Input old = input;
        old.cut.fresh = false;
        check_ratio(before.ratio, controller.step(old));
    }
}
