// SPDX-License-Identifier: Apache-2.0
#include "control/feed_law.hpp"

#include "feed_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::control;
using namespace millforce::control::bench;

TEST_GROUP(FeedLawAlone){};

namespace {

using Law = FeedLaw<float>;

/// A second long, and at 400 rad/s: a whole revolution and more.
constexpr StepMotion<float> long_step{0.5F, 20.0F, 10.0F, 0.004F, false};

bool applies_with(float CutEstimateForControl<float>::*field, float value) {
    Input input = in_contact();
    input.cut.*field = value;
    return Law::applies_to(input.cut);
}

/// The demand of a cutter that enters, whose tooth force asks for a tenth of the feed.
float demand_at_entry(float least_tooth_force_N) {
    Input input = in_contact();
    input.cut.tooth_force_N = 5000.0F;
    input.cut.least_tooth_force_N = least_tooth_force_N;
    Law law(1.0F);
    law.follow(Parameters{}, input, CutState::entry, 0.0F);
    return law.demand();
}

float demand_in_cut(const Parameters& parameters, const Input& input, float contact_feed_mm) {
    Law law(1.0F);
    law.follow(parameters, input, CutState::in_cut, contact_feed_mm);
    return law.demand();
}

float demand_for(float force_N, float share = 1.0F) {
    return Law::override_for(Parameters{}, in_contact(), {Parameters{}.setpoint_share, force_N, share});
}

}  // namespace

TEST(FeedLawAlone, applies_to_no_estimate_with_a_value_that_cannot_be) {
    using Cut = CutEstimateForControl<float>;
    CHECK_TRUE(Law::applies_to(in_contact().cut));
    CHECK_FALSE(Law::applies_to(without_force(in_contact()).cut));
    for (float Cut::*const positive : {&Cut::tooth_force_N, &Cut::feed_mm_s, &Cut::feed_exponent}) {
        for (const float value : {0.0F, -1.0F, not_a_number, beyond_all}) {
            CHECK_FALSE(applies_with(positive, value));
        }
    }
    for (float Cut::*const finite : {&Cut::cutting_share, &Cut::surge_ratio, &Cut::surge_cutting_share}) {
        for (const float value : {not_a_number, beyond_all}) {
            CHECK_FALSE(applies_with(finite, value));
        }
    }
}

TEST(FeedLawAlone, takes_no_demand_from_an_old_estimate_nor_from_one_that_it_does_not_apply_to) {
    Law law(1.0F);
    Input input = in_contact();
    law.follow(Parameters{}, input, CutState::in_cut, 0.0F);
    const float before = law.demand();
    input.cut.tooth_force_N = 900.0F;
    input.cut.fresh = false;
    law.follow(Parameters{}, input, CutState::in_cut, 0.0F);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(law.demand()), 0.0);
    input.cut.fresh = true;
    input.cut.surge_ratio = not_a_number;
    law.follow(Parameters{}, input, CutState::in_cut, 0.0F);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(law.demand()), 0.0);
    input.cut.surge_ratio = 1.0F;
    law.follow(Parameters{}, input, CutState::in_cut, 0.0F);
    CHECK(law.demand() < before);
}

TEST(FeedLawAlone, lets_the_feed_fall_with_the_speed_of_the_spindle_until_the_next_estimate_and_not_rise_with_it) {
    Law law(1.0F);
    Input input = in_contact();
    const float speed_rad_s = input.cut.spindle_speed_rad_s;
    law.follow(Parameters{}, input, CutState::in_cut, 0.0F);
    const auto at_full_speed = static_cast<double>(law.demand());
    const auto demand_at = [&](float share_of_speed) {
        input.cut.fresh = false;
        input.cut.spindle_speed_rad_s = share_of_speed * speed_rad_s;
        law.follow(Parameters{}, input, CutState::in_cut, 0.0F);
        return static_cast<double>(law.demand());
    };
    DOUBLES_EQUAL(at_full_speed, demand_at(0.96F), 0.0);
    DOUBLES_EQUAL(0.8 * at_full_speed, demand_at(0.8F), 1e-4);
    DOUBLES_EQUAL(0.5 * at_full_speed, demand_at(0.5F), 1e-4);
    DOUBLES_EQUAL(0.5 * at_full_speed, demand_at(1.0F), 1e-4);
    DOUBLES_EQUAL(0.5 * at_full_speed, demand_at(not_a_number), 1e-4);
    DOUBLES_EQUAL(0.0, demand_at(-0.1F), 0.0);
}

TEST(FeedLawAlone, counts_a_share_of_cutting_below_a_twentieth_as_that) {
    DOUBLES_EQUAL(static_cast<double>(demand_for(960.0F, 0.05F)), static_cast<double>(demand_for(960.0F, 0.01F)), 0.0);
    CHECK(demand_for(960.0F, 0.05F) > 1.1F);
}

TEST(FeedLawAlone, an_entry_is_slowed_below_its_feed_by_a_certain_force_alone) {
    const double entry = static_cast<double>(ratio_of(Parameters{}.entry_feed_per_tooth_mm, in_contact()));
    DOUBLES_EQUAL(entry, static_cast<double>(demand_at_entry(0.0F)), 1e-6);
    DOUBLES_EQUAL(entry, static_cast<double>(demand_at_entry(500.0F)), 1e-6);
    DOUBLES_EQUAL(static_cast<double>(demand_for(2000.0F)), static_cast<double>(demand_at_entry(2000.0F)), 1e-6);
    DOUBLES_EQUAL(static_cast<double>(demand_for(5000.0F)), static_cast<double>(demand_at_entry(9000.0F)), 1e-6);
}

TEST(FeedLawAlone, before_the_program_has_settled_in_a_cut_the_heaviest_one_bounds_no_demand) {
    Parameters p;
    p.depth_step_ratio = 2.0F;
    p.depth_step_share = 1.5F;
    Input input = in_contact();
    input.cut.tooth_force_N = 600.0F;
    const float by_its_force = Law::override_for(p, input, {0.75F, 600.0F, input.cut.cutting_share});
    DOUBLES_EQUAL(static_cast<double>(by_its_force), static_cast<double>(demand_in_cut(p, input, 0.0F)), 1e-6);
    DOUBLES_EQUAL(static_cast<double>(ratio_of(2.0F * 0.04F, input)),
                  static_cast<double>(demand_in_cut(p, input, 0.04F)), 1e-6);
}

/// Over a hole the tool cuts with two arcs, and no bound for one arc holds.
TEST(FeedLawAlone, the_heaviest_cut_bounds_the_demand_where_the_force_on_a_tooth_is_only_known_to_be_small) {
    Parameters p;
    p.depth_step_ratio = 2.0F;
    p.depth_step_share = 1.4F;
    Input input = in_contact();
    input.cut.tooth_force_N = 100.0F;
    input.cut.tooth_force_is_bound = true;
    const float of_heaviest = ratio_of(2.0F * 0.04F, input);
    DOUBLES_EQUAL(static_cast<double>(of_heaviest), static_cast<double>(demand_in_cut(p, input, 0.04F)), 1e-6);
    p.depth_step_ratio = 1.0F;  // the depth never steps
    CHECK(demand_in_cut(p, input, 0.04F) > 2.0F * of_heaviest);
}

TEST(FeedLawAlone, keeps_within_the_range_of_the_override_whatever_is_wanted) {
    const Parameters p;
    Law falling(1.0F);
    falling.approach(p, in_air(), long_step, CutState::air, -5.0F);
    DOUBLES_EQUAL(static_cast<double>(p.override_min), static_cast<double>(falling.override_ratio()), 0.0);
    Law rising(1.0F);
    rising.approach(p, in_air(), long_step, CutState::air, 50.0F);
    DOUBLES_EQUAL(static_cast<double>(p.override_max), static_cast<double>(rising.override_ratio()), 0.0);
}

TEST(FeedLawAlone, rises_in_air_without_estimates_and_not_in_a_cut_whose_spindle_turns_backwards) {
    Input input = in_air();
    input.cut.fresh = false;
    Law in_air_now(0.5F);
    in_air_now.approach(Parameters{}, input, long_step, CutState::air, 0.9F);
    DOUBLES_EQUAL(0.9, static_cast<double>(in_air_now.override_ratio()), 1e-6);
    input = in_contact();
    input.cut.spindle_speed_rad_s = -400.0F;
    Law backwards(0.5F);
    backwards.approach(Parameters{}, input, long_step, CutState::in_cut, 0.9F);
    DOUBLES_EQUAL(0.5, static_cast<double>(backwards.override_ratio()), 0.0);
}

TEST(FeedLawAlone, demands_nothing_out_of_the_cut) {
    Law law(1.0F);
    law.follow(Parameters{}, in_contact(), CutState::in_cut, 0.0F);
    CHECK(law.demand() > Parameters{}.override_max);
    law.follow(Parameters{}, in_contact(), CutState::air, 0.0F);
    DOUBLES_EQUAL(static_cast<double>(Parameters{}.override_max), static_cast<double>(law.demand()), 0.0);
}
