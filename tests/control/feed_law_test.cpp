// SPDX-License-Identifier: Apache-2.0
#include "feed_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::control;
using namespace millforce::control::bench;

TEST_GROUP(FeedLaw){};

namespace {

/// F = F₀ [(1 − c) + c (f/f₀)^(1+p_s)]
float force_at(float feed_ratio, float force_0_N, float c, float exponent) {
    return force_0_N * ((1.0F - c) + c * std::pow(feed_ratio, exponent));
}

float settled_ratio(const Parameters& parameters, const Input& input) {
    Controller controller(parameters);
    bring_into_cut(controller, input);
    return controller.step(input).ratio;
}

}  // namespace

TEST(FeedLaw, reaches_the_set_point_in_one_step_whatever_the_gain_and_the_edge_force) {
    const Parameters p = immediate();
    const float setpoint_N = p.setpoint_share * p.tooth_force_limit_N;
    int reached = 0;
    for (float force_N = 150.0F; force_N < 4000.0F; force_N *= 1.1F) {
        for (float c = 0.1F; c <= 1.0F; c += 0.1F) {
            for (const float exponent : {0.6F, 0.75F, 1.0F}) {
                Controller controller(p);
                bring_into_cut(controller);
                Input input = in_contact();
                input.cut.tooth_force_N = force_N;
                input.cut.cutting_share = c;
                input.cut.feed_exponent = exponent;
                const Output output = controller.step(input);
                if (output.ratio > p.override_min && output.ratio < p.override_max) {
                    const float force_then_N = force_at(output.ratio, force_N, c, exponent);
                    DOUBLES_EQUAL(1.0, static_cast<double>(force_then_N / setpoint_N), 1e-4);
                    CHECK(output.limit == Limit::force);
                    ++reached;
                } else {  // out of what an override can do: the nearest end is taken
                    const bool too_low = output.ratio >= p.override_max;
                    CHECK(too_low == (force_at(output.ratio, force_N, c, exponent) < setpoint_N));
                }
            }
        }
    }
    CHECK(reached > 200);
}

TEST(FeedLaw, does_not_care_at_which_feed_the_force_was_measured) {
    for (const float feed_mm_s : {5.0F, 20.0F, 35.0F}) {
        Input input = in_contact();
        input.cut.cutting_share = 0.7F;
        input.cut.feed_mm_s = feed_mm_s;
        input.cut.tooth_force_N = force_at(feed_mm_s / 20.0F, 800.0F, 0.7F, 0.75F);
        // The share of what is not edge force is that of the measured point.
        input.cut.cutting_share = 1.0F - 0.3F * 800.0F / input.cut.tooth_force_N;
        const float ratio = settled_ratio(immediate(), input);
        DOUBLES_EQUAL(970.0, static_cast<double>(force_at(ratio, 800.0F, 0.7F, 0.75F)), 0.2);
    }
}

TEST(FeedLaw, goes_to_the_minimum_where_the_edge_force_alone_exceeds_the_set_point) {
    Input input = in_contact();
    input.cut.tooth_force_N = 2000.0F;
    input.cut.cutting_share = 0.4F;  // 1200 N of edge force against 970 N
    DOUBLES_EQUAL(0.001, static_cast<double>(settled_ratio(immediate(), input)), 1e-9);
}

TEST(FeedLaw, backs_off_at_least_ten_times_faster_than_it_recovers) {
    Parameters p;
    p.entry_travel_mm = 0.0F;
    const auto steps_until = [&p](float from_N, float to_N) {
        Controller controller(p);
        Input input = in_contact();
        input.cut.tooth_force_N = from_N;
        const float start = repeat(controller, input, 3000).ratio;
        Controller goal(p);
        input.cut.tooth_force_N = to_N;
        const float end = repeat(goal, input, 3000).ratio;
        CHECK(std::fabs(end - start) > 0.5F);
        int steps = 0;
        float ratio = start;
        while (std::fabs(ratio - end) > 0.1F * std::fabs(end - start) && steps < 3000) {
            ratio = controller.step(input).ratio;
            ++steps;
        }
        return steps;
    };
    const int down = steps_until(700.0F, 1250.0F);
    const int up = steps_until(1250.0F, 700.0F);
    CHECK(down < 30);
    CHECK(up > 10 * down);
    CHECK(up < 3000);
}

TEST(FeedLaw, lowers_the_feed_so_that_a_surge_stays_below_its_share_of_the_limit) {
    Parameters p = immediate();
    p.surge_radial_immersion = 1.0F;
    p.entry_feed_per_tooth_mm = 0.01F;
    Input input = in_contact();
    input.cut.tooth_force_N = 600.0F;
    input.cut.surge_ratio = 2.5F;
    input.cut.surge_cutting_share = 0.8F;
    Controller controller(p);
    bring_into_cut(controller, input);
    const Output output = controller.step(input);
    CHECK(output.limit == Limit::surge);
    const float allowed_N = p.surge_share * p.tooth_force_limit_N;
    DOUBLES_EQUAL(1.0, static_cast<double>(force_at(output.ratio, 1500.0F, 0.8F, 0.75F) / allowed_N), 2e-4);
}

namespace {

/// The override before, within and behind 3 mm over which the section goes from 10 mm² to another; the estimate takes
/// the surge for over from the start of it.
struct Overrides {
    float before, highest_within, behind;
};
Overrides over_3_mm_to(float section_mm2) {
    Parameters p = immediate();
    p.recovery_per_rev = Parameters{}.recovery_per_rev;
    p.surge_radial_immersion = 1.0F;
    Input input = in_contact();
    input.cut.tooth_force_N = 400.0F;
    input.cut.surge_ratio = 3.0F;
    input.cut.section_mm2 = 10.0F;
    Controller controller(p);
    bring_into_cut(controller, input);
    Overrides seen{repeat(controller, input, 1000).ratio, 0.0F, 0.0F};
    input.cut.surge_ratio = 1.0F;
    constexpr int steps = 150;
    for (int k = 0; k < steps; ++k) {
        input.cut.section_mm2 += (section_mm2 - 10.0F) / steps;
        seen.highest_within = std::fmax(seen.highest_within, controller.step(input).ratio);
    }
    seen.behind = repeat(controller, input, 1000).ratio;
    return seen;
}

}  // namespace

TEST(FeedLaw, keeps_the_feed_that_meets_a_surge_until_the_cut_has_stopped_growing) {
    const Overrides wall = over_3_mm_to(30.0F);
    CHECK(wall.behind > 2.0F * wall.before);
    CHECK(wall.highest_within < wall.before + 0.25F * (wall.behind - wall.before));
    const Overrides steady = over_3_mm_to(10.0F);
    CHECK(steady.highest_within > wall.before + 0.75F * (wall.behind - wall.before));
}

TEST(FeedLaw, ignores_surges_where_none_can_come) {
    Input input = in_contact();
    const float calm = settled_ratio(immediate(), input);
    input.cut.surge_ratio = 2.5F;
    DOUBLES_EQUAL(static_cast<double>(calm), static_cast<double>(settled_ratio(immediate(), input)), 1e-7);
}

TEST(FeedLaw, never_exceeds_what_edge_and_chip_space_allow) {
    Parameters p = immediate();
    p.max_feed_per_tooth_mm = 0.1F;
    Input input = in_contact();
    input.cut.tooth_force_N = 100.0F;
    Controller controller(p);
    bring_into_cut(controller, input);
    const Output output = controller.step(input);
    CHECK(output.limit == Limit::feed_per_tooth);
    DOUBLES_EQUAL(static_cast<double>(ratio_of(0.1F, input)), static_cast<double>(output.ratio), 1e-5);
}

namespace {

/// A machine that goes as commanded, along x or y.
Output follow(Controller& controller, Input& input, const Output& last, bool along_y) {
    input.path_speed_mm_s = last.ratio * input.programmed_feed_mm_s;
    input.velocity_x_mm_s = along_y ? 0.0F : input.path_speed_mm_s;
    input.velocity_y_mm_s = along_y ? input.path_speed_mm_s : 0.0F;
    return controller.step(input);
}

Output settle(Controller& controller, Input& input) {
    Output output = bring_into_cut(controller, input);
    for (int k = 0; k < 2000; ++k) {
        output = follow(controller, input, output, false);
    }
    return output;
}

/// `spindle_speed_rad_s`: out of the cut.
void check_that_a_turn_ends_the_exit(float spindle_speed_rad_s) {
    Parameters p = immediate();
    p.exit_travel_mm = 100.0F;
    Input input = in_contact();
    Controller controller(p);
    Output output = settle(controller, input);
    input.cut.tangential_N = 0.0F;
    input.cut.spindle_speed_rad_s = spindle_speed_rad_s;
    for (int k = 0; k < 20; ++k) {
        output = follow(controller, input, output, false);
        CHECK(output.state == CutState::exit);
    }
    CHECK(follow(controller, input, output, true).state == CutState::air);
}

}  // namespace

TEST(FeedLaw, takes_the_feed_that_a_slot_would_allow_after_a_sharp_turn) {
    const Parameters p = immediate();
    Input input = in_contact();
    input.cut.tooth_force_N = 600.0F;
    input.cut.turn_ratio = 2.0F;
    input.cut.turn_cutting_share = 0.8F;
    Controller controller(p);
    const Output straight = settle(controller, input);
    const Output turned = follow(controller, input, straight, true);
    CHECK(straight.limit == Limit::force);
    CHECK(turned.limit == Limit::surge);
    const float allowed_N = p.surge_share * p.tooth_force_limit_N;
    DOUBLES_EQUAL(1.0, static_cast<double>(force_at(turned.ratio, 1200.0F, 0.8F, 0.75F) / allowed_N), 2e-4);
    float way_mm = 0.0F;
    for (Output output = turned; output.limit == Limit::surge && way_mm < 100.0F;) {
        output = follow(controller, input, output, true);
        way_mm += input.path_speed_mm_s * input.dt_s;
    }
    DOUBLES_EQUAL(static_cast<double>(p.turn_travel_mm), static_cast<double>(way_mm), 0.1);
}

TEST(FeedLaw, does_not_raise_the_feed_while_the_cut_fades) {
    Input input = in_contact();
    input.cut.section_mm2 = 10.0F;
    Controller controller(immediate());
    Output output = settle(controller, input);
    const float before = output.ratio;
    for (float way_mm = 0.0F; way_mm < 5.0F; way_mm += input.path_speed_mm_s * input.dt_s) {
        const float share = 1.0F - way_mm / 5.0F;
        input.cut.section_mm2 = 10.0F * share;
        input.cut.tooth_force_N = force_at(output.ratio, 500.0F * share, 1.0F, 0.75F);
        input.cut.feed_mm_s = output.ratio * input.programmed_feed_mm_s;
        output = follow(controller, input, output, false);
        CHECK(output.ratio < 1.3F * before);  // a little was raised before the fall was known for a fade
    }
    input.cut.section_mm2 = 0.0F;  // without its trend
    CHECK(settled_ratio(immediate(), input) > 3.0F * before);
}

TEST(FeedLaw, comes_back_in_a_cut_that_fades_from_a_dip_at_its_begin) {
    Input input = in_contact();
    input.cut.section_mm2 = 10.0F;
    Controller controller(immediate());
    const float before = settle(controller, input).ratio;
    const float steady_N = input.cut.tooth_force_N;
    input.cut.tooth_force_N = 5.0F * steady_N;  // of two cuts at once
    CHECK_COMPARE(controller.step(input).ratio, <, 0.5F * before);
    input.cut.section_mm2 = 7.0F;
    input.cut.tooth_force_N = 0.5F * steady_N;
    Output output = controller.step(input);
    CHECK_TRUE(output.fading);
    for (int k = 0; k < 20; ++k) {
        output = controller.step(input);
        CHECK_COMPARE(output.ratio, <=, before);
    }
    CHECK_TRUE(output.fading);
    CHECK_COMPARE(output.ratio, >, 0.8F * before);
}

TEST(FeedLaw, is_held_no_lower_by_a_cut_that_fades_than_it_was_at_its_begin) {
    Input input = in_contact();
    input.cut.section_mm2 = 10.0F;
    Controller controller(immediate());
    const float slow = settle(controller, input).ratio;
    input.cut.tooth_force_N *= 0.5F;
    Output output = controller.step(input);
    output = controller.step(input);
    const float fast = output.ratio;
    CHECK_COMPARE(fast, >, 1.5F * slow);
    input.cut.section_mm2 = 7.0F;
    output = controller.step(input);
    CHECK_TRUE(output.fading);
    CHECK_COMPARE(output.ratio, >=, 0.99F * fast);
}

TEST(FeedLaw, forgets_at_a_sharp_turn_out_of_the_cut_what_was_cut_before) {
    check_that_a_turn_ends_the_exit(in_contact().cut.spindle_speed_rad_s);
}

TEST(FeedLaw, follows_a_turn_s_estimates_and_keeps_the_ceiling_where_they_say_nothing_of_a_slot) {
    const Parameters p = immediate();
    const float allowed_N = p.surge_share * p.tooth_force_limit_N;
    Input input = in_contact();
    input.cut.tooth_force_N = 600.0F;
    input.cut.turn_ratio = 2.0F;
    Controller controller(p);
    Output output = follow(controller, input, settle(controller, input), true);
    input.cut.tooth_force_N = 700.0F;
    output = follow(controller, input, output, true);
    DOUBLES_EQUAL(1.0, static_cast<double>(force_at(output.ratio, 1400.0F, 1.0F, 0.75F) / allowed_N), 2e-4);
    const float before = output.ratio;
    input.cut.turn_ratio = not_a_number;
    output = follow(controller, input, output, true);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(output.ratio), 0.0);
    input.cut.turn_ratio = 2.0F;
    input.cut.turn_cutting_share = not_a_number;
    output = follow(controller, input, output, true);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(output.ratio), 0.0);
    input.cut.turn_cutting_share = 1.0F;
    input.cut.turn_ratio = 1.0F;
    input.cut.fresh = false;
    output = follow(controller, input, output, true);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(output.ratio), 0.0);
    input.cut.turn_ratio = 2.0F;
    input.cut.fresh = true;
    input.cut.tooth_force_N = not_a_number;
    output = follow(controller, input, output, true);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(output.ratio), 0.0);
}

TEST(FeedLaw, a_sharp_turn_waits_for_no_new_estimate) {
    Input input = in_contact();
    input.cut.tooth_force_N = 600.0F;
    input.cut.turn_ratio = 2.0F;
    Controller controller(immediate());
    const Output straight = settle(controller, input);
    input.cut.fresh = false;
    CHECK(follow(controller, input, straight, true).limit == Limit::surge);
}

TEST(FeedLaw, a_sharp_turn_lowers_nothing_where_no_immersion_is_assumed_behind_it) {
    Parameters p = immediate();
    p.turn_radial_immersion = 0.0F;
    Input input = in_contact();
    input.cut.turn_ratio = 2.0F;
    Controller controller(p);
    CHECK(follow(controller, input, settle(controller, input), true).limit == Limit::force);
}

TEST(FeedLaw, a_surge_that_makes_nothing_larger_is_no_ceiling) {
    Parameters p = immediate();
    p.surge_radial_immersion = 1.0F;
    Input input = in_contact();
    input.cut.tooth_force_N = 1100.0F;
    input.cut.surge_ratio = 1.0F;
    input.cut.surge_cutting_share = 0.05F;
    Controller controller(p);
    bring_into_cut(controller, input);
    CHECK(controller.step(input).limit == Limit::force);
}

TEST(FeedLaw, a_growing_cut_holds_nothing_where_no_surge_can_come) {
    Input input = in_contact();
    input.cut.section_mm2 = 10.0F;
    Controller controller(immediate());
    Output output = settle(controller, input);
    const float before = output.ratio;
    for (int k = 0; k < 50; ++k) {
        input.cut.section_mm2 *= 1.03F;
        input.cut.tooth_force_N -= 2.0F;
        output = follow(controller, input, output, false);
        CHECK(output.limit == Limit::force);
    }
    CHECK(output.ratio > 1.2F * before);
}

TEST(FeedLaw, a_sharp_turn_is_noticed_though_the_speed_of_the_spindle_is_not_known) {
    check_that_a_turn_ends_the_exit(0.0F);
}

TEST(FeedLaw, may_return_to_the_feed_before_a_growth_while_it_lasts) {
    Parameters p = immediate();
    p.surge_radial_immersion = 1.0F;
    Input input = in_contact();
    input.cut.section_mm2 = 10.0F;
    input.cut.tooth_force_N = 700.0F;
    Controller controller(p);
    Output output = settle(controller, input);
    const float before = output.ratio;
    const auto grow = [&](float tooth_force_N) {
        input.cut.tooth_force_N = tooth_force_N;
        for (int k = 0; k < 10; ++k) {
            input.cut.section_mm2 *= 1.03F;
            output = follow(controller, input, output, false);
        }
        return output.ratio;
    };
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(grow(700.0F)), 1e-5);
    CHECK(grow(900.0F) < 0.9F * before);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(grow(700.0F)), 1e-5);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(grow(400.0F)), 1e-5);
}
