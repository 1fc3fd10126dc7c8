// SPDX-License-Identifier: Apache-2.0
#include "estimation/engagement/side_choice.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::estimation;

namespace {

EngagementEstimate<float> fit(CutSide side, float misfit, float radial_immersion = 0.5F) {
    EngagementEstimate<float> found;
    found.solved = true;
    found.immersion_valid = true;
    found.depth_valid = true;
    found.radial_immersion = radial_immersion;
    found.radial_immersion_sd = 0.05F;
    found.side = side;
    found.misfit = misfit;
    return found;
}

EngagementEstimate<float> without_immersion(EngagementEstimate<float> found) {
    found.immersion_valid = false;
    return found;
}

CutSide chosen(float declared_misfit, const EngagementEstimate<float>& other) {
    return declared_or_other_side(fit(CutSide::down, declared_misfit), other).side;
}

}  // namespace

TEST_GROUP(SideChoice){};

TEST(SideChoice, keeps_the_declared_side_unless_the_other_fits_better_by_three_deviations) {
    CHECK(chosen(12.0F, fit(CutSide::up, 3.5F)) == CutSide::down);
    CHECK(chosen(12.0F, fit(CutSide::up, 2.5F)) == CutSide::up);
}

TEST(SideChoice, takes_no_other_side_that_is_refuted_or_was_not_solved) {
    CHECK(chosen(40.0F, fit(CutSide::up, 17.0F)) == CutSide::down);
    CHECK(chosen(40.0F, fit(CutSide::up, 15.0F)) == CutSide::up);
    CHECK(chosen(40.0F, {}) == CutSide::down);
}

TEST(SideChoice, takes_the_side_that_clearly_fits_better_where_none_is_declared) {
    CHECK(better_of_sides(fit(CutSide::down, 0.0F), fit(CutSide::up, 4.0F)).side == CutSide::down);
    CHECK(better_of_sides(fit(CutSide::down, 4.0F), fit(CutSide::up, 0.0F)).side == CutSide::up);
}

TEST(SideChoice, gives_what_two_sides_that_fit_alike_agree_on_and_nothing_else) {
    const auto agreed = better_of_sides(fit(CutSide::down, 0.0F), fit(CutSide::up, 1.0F, 0.6F));
    CHECK(agreed.immersion_valid && agreed.depth_valid);
    CHECK(agreed.side == CutSide::unknown);
    DOUBLES_EQUAL(0.5, static_cast<double>(agreed.radial_immersion), 1e-6);
    DOUBLES_EQUAL(
        0.6,
        static_cast<double>(better_of_sides(fit(CutSide::down, 2.0F), fit(CutSide::up, 1.0F, 0.6F)).radial_immersion),
        1e-6);
    const auto apart = better_of_sides(fit(CutSide::down, 0.0F), fit(CutSide::up, 1.0F, 0.8F));
    CHECK_FALSE(apart.immersion_valid || apart.depth_valid);
    CHECK(apart.side == CutSide::unknown);
}

TEST(SideChoice, tries_the_other_side_where_the_declared_one_fits_badly) {
    CHECK(may_be_the_other_side(fit(CutSide::down, 9.1F)));
    CHECK_FALSE(may_be_the_other_side(fit(CutSide::down, 8.9F)));
}

TEST(SideChoice, widens_the_interval_of_a_model_that_explains_the_forces_badly) {
    DOUBLES_EQUAL(3.84, static_cast<double>(rise_of_interval(3.0F)), 1e-5);
    DOUBLES_EQUAL(3.84 * 3.0, static_cast<double>(rise_of_interval(5.84F)), 1e-4);
}

TEST(SideChoice, takes_the_only_immersion_where_the_other_side_fits_clearly_worse) {
    const auto up = without_immersion(fit(CutSide::up, 4.0F, 0.6F));
    CHECK(better_of_sides(fit(CutSide::down, 0.0F), up).side == CutSide::down);
    CHECK(better_of_sides(up, fit(CutSide::down, 0.0F)).side == CutSide::down);
    CHECK(better_of_sides(fit(CutSide::down, 1.0F), up).side == CutSide::unknown);
    CHECK_FALSE(better_of_sides(fit(CutSide::down, 0.0F), without_immersion(fit(CutSide::up, 1.0F, 0.9F))).side ==
                CutSide::down);
}
