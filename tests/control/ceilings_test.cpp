// SPDX-License-Identifier: Apache-2.0
#include "ceilings_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::control;
using namespace millforce::control::bench;

namespace {

Input light_cut(bool has_map) {
    Input light = in_contact();
    light.cut.tooth_force_N = 300.0F;
    light.way.known = has_map;
    light.way.feed_mm_s = 100.0F;
    return light;
}

/// In this cut the spindle loses its speed and regains it: from then on no force may be as large.
Output lose_and_regain_speed(Controller& controller, const Input& cut) {
    Input slow = cut;
    slow.cut.spindle_speed_rad_s *= 0.9F;
    repeat(controller, slow, 50);
    return repeat(controller, cut, 400);
}

using Cut = millforce::control::CutEstimateForControl<float>;

/// Half of the feed that the law gives holds as long as it is the bound.
void check_bound_of_feed(bool has_map, float Cut::*bound_mm_s, Limit limit, const char* limit_name) {
    Controller controller(immediate());
    bring_into_cut(controller);
    Input light = light_cut(has_map);
    const Output free = repeat(controller, light, 200);
    light.cut.*bound_mm_s = 0.5F * free.ratio * light.programmed_feed_mm_s;
    const Output bound = repeat(controller, light, 200);
    check_ratio(0.5F * free.ratio, bound);
    CHECK(bound.limit == limit);
    STRCMP_EQUAL(limit_name, name(bound.limit));
    light.cut.*bound_mm_s = 0.0F;
    check_ratio(free.ratio, repeat(controller, light, 400));
}

}  // namespace

TEST_GROUP(Ceilings){};

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
        check_bound_of_feed(has_map, &Cut::answered_feed_mm_s, Limit::load_unanswered, "load_unanswered");
    }
}

TEST(Ceilings, a_current_in_doubt_bounds_the_feed_of_the_cut) {
    check_bound_of_feed(false, &Cut::doubted_feed_mm_s, Limit::current_in_doubt, "current_in_doubt");
}

TEST(Ceilings, a_spindle_that_loses_its_speed_gets_the_lowest_feed_and_then_no_force_as_large_with_or_without_a_map) {
    for (const bool has_map : {false, true}) {
        Controller controller(immediate());
        bring_into_cut(controller);
        Input light = light_cut(has_map);
        CHECK_COMPARE(repeat(controller, light, 200).ratio, >, 1.2F);
        Input slow = light;
        slow.cut.spindle_speed_rad_s *= 0.9F;
        check_ratio(immediate().override_min, repeat(controller, slow, 50));
        const Output regained = lose_and_regain_speed(controller, light);
        CHECK(regained.limit == Limit::spindle_torque);
        STRCMP_EQUAL("spindle_torque", name(regained.limit));
        check_ratio(std::pow(0.9F, 1.0F / light.cut.feed_exponent), regained, 1e-3);
    }
}

TEST(Ceilings, after_a_loss_of_speed_an_estimate_that_is_old_or_of_no_use_to_the_law_leaves_the_ceiling_where_it_was) {
    Input old = light_cut(false);
    old.cut.fresh = false;
    old.cut.tangential_N *= 2.0F;
    Input without_exponent = light_cut(false);
    without_exponent.cut.feed_exponent = not_a_number;
    for (const Input& next : {old, without_exponent}) {
        Controller controller(immediate());
        bring_into_cut(controller);
        const float before = lose_and_regain_speed(controller, light_cut(false)).ratio;
        check_ratio(before, controller.step(next));
    }
}

TEST(Ceilings, after_a_loss_of_speed_a_torque_below_zero_in_a_feed_hold_does_not_lower_the_override) {
    Controller controller(immediate());
    bring_into_cut(controller);
    const float before = lose_and_regain_speed(controller, light_cut(false)).ratio;
    Input held = light_cut(false);
    held.feed_hold = true;
    held.cut.tangential_N = -1.0F;
    const Output output = repeat(controller, held, 10);
    CHECK(output.state == CutState::hold);
    check_ratio(before, output);
}

TEST(Ceilings, a_spindle_that_stalls_is_a_fault_where_the_tool_is_fed_and_none_where_it_rests) {
    for (const float feed_mm_s : {0.0F, 20.0F}) {
        Controller controller(immediate());
        bring_into_cut(controller);
        Input stalled = in_contact();
        stalled.path_speed_mm_s = feed_mm_s;
        for (const float share : {0.9F, 0.6F, 0.3F}) {
            stalled.cut.spindle_speed_rad_s = share * in_contact().cut.spindle_speed_rad_s;
            controller.step(stalled);
        }
        CHECK_EQUAL(feed_mm_s > 0.0F, controller.step(stalled).fault == Fault::spindle_stopped);
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

TEST(Ceilings, an_override_at_its_lowest_says_so_and_whether_a_tooth_may_carry_more_than_its_limit_there) {
    const auto limit_at = [](float tooth_force_N, float way_mm_s) {
        Controller controller;
        Input input = in_contact();
        input.cut.tooth_force_N = tooth_force_N;
        input.cut.cutting_share = 0.1F;
        input.way.known = true;
        input.way.feed_mm_s = way_mm_s;
        bring_into_cut(controller, input);
        const Output output = repeat(controller, input, 500);
        check_ratio(Parameters{}.override_min, output);
        return output.limit;
    };
    constexpr float limit_N = 1000.0F;
    constexpr float fast_mm_s = 1000.0F;
    DOUBLES_EQUAL(limit_N, Parameters{}.tooth_force_limit_N, 0.0);
    CHECK(limit_at(0.9F * limit_N, 0.0F) == Limit::override_min);
    CHECK(limit_at(1.3F * limit_N, fast_mm_s) == Limit::force_at_minimum);
}
