// SPDX-License-Identifier: Apache-2.0
#include "feed_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::control;
using namespace millforce::control::bench;

namespace {

Parameters with_limit() {
    Parameters p = immediate();
    p.Ra_limit_um = 1.6F;
    return p;
}

/// A light cut: the force alone would let the override rise to its maximum.
Input light_cut(float ceiling_mm_s, bool valid = true, bool in_range = true) {
    Input input = in_contact();
    input.cut.tooth_force_N = 20.0F;
    input.surface = {valid, in_range, ceiling_mm_s};
    return input;
}

double settled(Controller& controller, const Input& input) {
    return static_cast<double>(repeat(controller, input, 20).ratio);
}

}  // namespace

TEST_GROUP(Surface){};

TEST(Surface, feed_is_held_at_the_ceiling_of_the_roughness) {
    Controller controller(with_limit());
    const Output output = repeat(controller, light_cut(14.0F), 20);
    DOUBLES_EQUAL(0.7, static_cast<double>(output.ratio), 1e-5);
    CHECK(output.limit == Limit::roughness);
    STRCMP_EQUAL("roughness", name(output.limit));
    DOUBLES_EQUAL(0.9, settled(controller, light_cut(18.0F)), 1e-5);
}

TEST(Surface, ceiling_does_not_act_where_no_limit_is_set) {
    Parameters p = with_limit();
    p.Ra_limit_um = 0.0F;
    Controller controller(p);
    CHECK(settled(controller, light_cut(14.0F)) > 5.0);
    CHECK(settled(controller, light_cut(14.0F, false, false)) > 5.0);
}

TEST(Surface, without_a_prediction_the_ceiling_holds_and_nothing_speeds_up) {
    Controller controller(with_limit());
    DOUBLES_EQUAL(0.7, settled(controller, light_cut(14.0F)), 1e-5);
    for (const float nothing : {40.0F, 0.0F, -1.0F, not_a_number, beyond_all}) {
        DOUBLES_EQUAL(0.7, settled(controller, light_cut(nothing, false)), 1e-5);
    }
    DOUBLES_EQUAL(0.7, settled(controller, light_cut(not_a_number)), 1e-5);
    Controller never_told(with_limit());
    const double at_contact = static_cast<double>(bring_into_cut(never_told, light_cut(0.0F, false)).ratio);
    CHECK(settled(never_told, light_cut(0.0F, false)) <= at_contact);
}

TEST(Surface, outside_the_fitted_range_the_feed_falls_but_does_not_rise) {
    Controller controller(with_limit());
    DOUBLES_EQUAL(0.7, settled(controller, light_cut(14.0F)), 1e-5);
    DOUBLES_EQUAL(0.7, settled(controller, light_cut(18.0F, true, false)), 1e-5);
    DOUBLES_EQUAL(0.5, settled(controller, light_cut(10.0F, true, false)), 1e-5);
    DOUBLES_EQUAL(0.5, settled(controller, light_cut(18.0F, true, false)), 1e-5);
    DOUBLES_EQUAL(0.9, settled(controller, light_cut(18.0F)), 1e-5);
}

TEST(Surface, force_goes_before_surface_where_it_asks_for_less) {
    Controller controller(with_limit());
    Input heavy = light_cut(14.0F);
    heavy.cut.tooth_force_N = 5000.0F;
    const Output output = repeat(controller, heavy, 3);
    CHECK(output.ratio < 0.5F);
    CHECK(output.limit == Limit::force);
}

TEST(Surface, ceiling_of_one_cut_does_not_bind_the_way_to_the_next) {
    Parameters p = with_limit();
    p.exit_travel_mm = 0.0F;
    p.air_feed_per_tooth_mm = 0.1F;
    Controller controller(p);
    Input cut = light_cut(10.0F);
    cut.cut.turn_ratio = 50.0F;  // a slot of that depth is too heavy
    DOUBLES_EQUAL(0.5, settled(controller, cut), 1e-5);
    DOUBLES_EQUAL(static_cast<double>(ratio_of(0.1F, in_air())), settled(controller, in_air()), 1e-4);
}

TEST(Surface, limit_that_is_no_number_is_a_bad_configuration) {
    for (const float limit : {-1.0F, not_a_number, beyond_all}) {
        Parameters p = with_limit();
        p.Ra_limit_um = limit;
        Controller controller(p);
        CHECK(controller.step(in_air()).fault == Fault::bad_configuration);
    }
}

TEST(Surface, ceiling_never_speeds_up_what_runs_without_it_whatever_comes_in) {
    Dice dice(31);
    Parameters without = with_limit();
    without.Ra_limit_um = 0.0F;
    for (int k = 0; k < 2000; ++k) {
        Controller limited(with_limit());
        Controller unlimited(without);
        bring_into_cut(limited, light_cut(20.0F));
        bring_into_cut(unlimited, light_cut(20.0F));
        for (int step = 0; step < 5; ++step) {
            Input input = light_cut(dice.anything(), !dice.one_in(3), !dice.one_in(3));
            input.cut.fresh = !dice.one_in(3);
            const float ratio = limited.step(input).ratio;
            CHECK(ratio >= 0.001F && ratio <= unlimited.step(input).ratio);
        }
    }
}

TEST(Surface, only_a_new_estimate_moves_the_ceiling) {
    Controller controller(with_limit());
    DOUBLES_EQUAL(0.7, settled(controller, light_cut(14.0F)), 1e-5);
    Input old = light_cut(10.0F);
    old.cut.fresh = false;
    DOUBLES_EQUAL(0.7, static_cast<double>(controller.step(old).ratio), 1e-5);
}

TEST(Surface, without_a_prediction_in_the_fitted_range_the_feed_stays_that_of_the_entry) {
    const float entry = ratio_of(Parameters{}.entry_feed_per_tooth_mm, in_contact());
    Controller without(with_limit());
    CHECK(repeat(without, light_cut(0.0F, false), 20).ratio <= 1.001F * entry);
    Controller outside(with_limit());
    CHECK(repeat(outside, light_cut(40.0F, true, false), 20).ratio <= 1.001F * entry);
}

TEST(Surface, a_ceiling_from_outside_the_fitted_range_is_not_kept_for_later) {
    Controller controller(with_limit());
    DOUBLES_EQUAL(0.7, settled(controller, light_cut(14.0F)), 1e-5);
    controller.step(light_cut(18.0F, true, false));
    Input within = light_cut(18.0F);
    within.cut.fresh = false;
    DOUBLES_EQUAL(0.7, static_cast<double>(controller.step(within).ratio), 1e-5);
}
