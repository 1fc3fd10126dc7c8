// SPDX-License-Identifier: Apache-2.0
#include "estimation/engagement/law_doubt.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using millforce::estimation::LawDoubt;

constexpr int teeth = 4;

void follow(LawDoubt& doubt, bool is_contradicted, int estimates) {
    for (int i = 0; i < estimates; ++i) {
        doubt.follow(is_contradicted, 1, teeth);
    }
}

int estimates_until_trusted(LawDoubt& doubt) {
    int estimates = 0;
    while (doubt.is_open()) {
        doubt.follow(false, 1, teeth);
        ++estimates;
    }
    return estimates;
}

}  // namespace

TEST_GROUP(LawDoubt){};

TEST(LawDoubt, two_windows_in_a_row_that_contradict_the_law_open_it) {
    LawDoubt doubt;
    follow(doubt, true, 2 * teeth - 1);
    CHECK_FALSE(doubt.is_open());
    follow(doubt, true, 1);
    CHECK(doubt.is_open());
}

TEST(LawDoubt, a_window_now_and_then_does_not) {
    LawDoubt doubt;
    for (int i = 0; i < 1000; ++i) {
        follow(doubt, true, teeth);
        follow(doubt, false, 4 * teeth);
        CHECK_FALSE(doubt.is_open());
    }
}

TEST(LawDoubt, takes_four_fits_for_each_contradiction_to_close) {
    LawDoubt doubt;
    follow(doubt, true, 3 * teeth);
    LONGS_EQUAL(4 * 3 * teeth, estimates_until_trusted(doubt));
}

TEST(LawDoubt, closes_after_a_thousand_windows_that_fit_however_long_it_was_open) {
    LawDoubt doubt;
    follow(doubt, true, 100000);
    LONGS_EQUAL(1000 * teeth, estimates_until_trusted(doubt));
}

TEST(LawDoubt, estimates_that_stand_for_several_teeth_count_as_many) {
    LawDoubt doubt;
    doubt.follow(true, 2 * teeth, teeth);
    CHECK(doubt.is_open());
}

TEST(LawDoubt, is_forgotten_in_air) {
    LawDoubt doubt;
    follow(doubt, true, 100);
    doubt.forget();
    CHECK_FALSE(doubt.is_open());
}
