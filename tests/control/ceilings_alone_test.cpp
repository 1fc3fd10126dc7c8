// SPDX-License-Identifier: Apache-2.0
#include "control/ceilings.hpp"

#include "ceilings_bench.hpp"

#include <CppUTest/TestHarness.h>

#include <initializer_list>

using namespace millforce::control;
using namespace millforce::control::bench;

namespace {

constexpr float present = 0.5F;

Ceilings<float>::Situation in_state(CutState state) {
    return {state, true, present, Parameters{}.override_max};
}

Ceiling<float> lowest(const Input& input, CutState state) {
    return Ceilings<float>{}.lowest(Parameters{}, input, in_state(state));
}

void check_present(const Ceiling<float>& ceiling) {
    DOUBLES_EQUAL(static_cast<double>(present), static_cast<double>(ceiling.override_ratio), 1e-6);
    CHECK(ceiling.limit == Limit::no_estimate);
}

Input overloaded_at_the_lowest_override() {
    Input input = with_way(in_contact(), 0.0F);
    input.cut.tooth_force_N = 1.3F * Parameters{}.tooth_force_limit_N;
    return input;
}

}  // namespace

/// Without the controller, which puts the highest feed so far in the place of one that is not told.
TEST_GROUP(CeilingsAlone){};

TEST(CeilingsAlone, in_a_cut_without_a_feed_the_override_stays_with_or_without_a_map) {
    for (const float unknown : {0.0F, -20.0F, not_a_number}) {
        Input input = in_contact();
        input.programmed_feed_mm_s = unknown;
        check_present(lowest(input, CutState::in_cut));
        check_present(lowest(with_way(input, 10.0F), CutState::in_cut));
    }
}

TEST(CeilingsAlone, a_feed_without_end_is_not_the_highest_of_a_program) {
    Ceilings<float> ceilings;
    Input input = in_air();
    ceilings.follow(Parameters{}, input, {}, in_state(CutState::air));
    input.programmed_feed_mm_s = beyond_all;
    ceilings.follow(Parameters{}, input, {}, in_state(CutState::air));
    DOUBLES_EQUAL(in_air().programmed_feed_mm_s, ceilings.highest_programmed_feed_mm_s(), 0.0);
}

TEST(CeilingsAlone, behind_a_gap_a_cut_goes_on_at_the_override_that_the_tool_came_with) {
    constexpr float came_with = 0.9F;
    Ceilings<float> ceilings;
    ceilings.follow(Parameters{}, in_contact(), {}, in_state(CutState::in_cut));
    ceilings.enter_state(came_with);
    CHECK_COMPARE(ratio_of(Parameters{}.entry_feed_per_tooth_mm, in_contact()), <, came_with);
    const Ceiling<float> entry = ceilings.lowest(Parameters{}, in_contact(), in_state(CutState::entry));
    DOUBLES_EQUAL(static_cast<double>(came_with), static_cast<double>(entry.override_ratio), 1e-6);
}

TEST(CeilingsAlone, an_override_at_its_lowest_warns_of_a_force_above_the_limit_only_where_a_cut_shows_it_for_certain) {
    const Input overloaded = overloaded_at_the_lowest_override();
    CHECK(lowest(overloaded, CutState::in_cut).limit == Limit::force_at_minimum);
    CHECK(lowest(overloaded, CutState::exit).limit == Limit::override_min);
    Input outside_the_law = overloaded;
    outside_the_law.cut.feed_exponent = not_a_number;
    Input guessed = overloaded;
    guessed.cut.tooth_force_valid = false;
    Input bound = overloaded;
    bound.cut.tooth_force_is_bound = true;
    for (const Input& input : {outside_the_law, guessed, bound}) {
        CHECK(lowest(input, CutState::in_cut).limit == Limit::override_min);
    }
}

TEST(CeilingsAlone, an_override_at_its_lowest_for_want_of_an_estimate_says_so) {
    Input blind = in_air();
    blind.cut.force_valid = false;
    const Ceiling<float> fed_blind = lowest(blind, CutState::air);
    CHECK(fed_blind.limit == Limit::no_estimate);
    DOUBLES_EQUAL(static_cast<double>(Parameters{}.override_min), static_cast<double>(fed_blind.override_ratio), 0.0);
}
