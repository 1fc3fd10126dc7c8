// SPDX-License-Identifier: Apache-2.0
#include "firmware/settled_feed.hpp"

#include <CppUTest/TestHarness.h>

#include <limits>

using Settled = millforce::firmware::SettledFeed<float>;

namespace {

constexpr float tick_s = 0.001F;

void follow(Settled& feed, float feed_mm_s, int ticks) {
    for (int i = 0; i < ticks; ++i) {
        feed.take(feed_mm_s);
        feed.wait(tick_s);
    }
}

}  // namespace

TEST_GROUP(SettledFeed){};

TEST(SettledFeed, is_always_settled_where_the_force_is_not_late) {
    Settled feed(0.0F);
    follow(feed, 10.0F, 1);
    follow(feed, 20.0F, 1);
    CHECK(feed.is_settled());
}

TEST(SettledFeed, is_settled_again_when_it_has_stayed_for_as_long_as_the_force_is_late) {
    Settled feed(0.25F);
    follow(feed, 10.0F, 300);
    CHECK(feed.is_settled());
    follow(feed, 11.0F, 1);
    CHECK_FALSE(feed.is_settled());
    follow(feed, 11.0F, 240);
    CHECK_FALSE(feed.is_settled());
    follow(feed, 11.0F, 11);
    CHECK(feed.is_settled());
}

TEST(SettledFeed, does_not_mind_a_ripple_but_a_creep) {
    Settled feed(0.25F);
    follow(feed, 10.0F, 300);
    for (int i = 0; i < 300; ++i) {
        follow(feed, i % 2 == 0 ? 10.3F : 9.7F, 1);
    }
    CHECK(feed.is_settled());
    for (int i = 0; i < 100; ++i) {
        follow(feed, 10.0F + 0.02F * static_cast<float>(i), 1);
    }
    CHECK_FALSE(feed.is_settled());
}

TEST(SettledFeed, is_not_settled_by_a_feed_that_falls) {
    Settled feed(0.25F);
    follow(feed, 10.0F, 300);
    follow(feed, 9.0F, 1);
    CHECK_FALSE(feed.is_settled());
}

TEST(SettledFeed, of_no_number_is_not_settled) {
    Settled feed(0.25F);
    follow(feed, 10.0F, 300);
    follow(feed, std::numeric_limits<float>::quiet_NaN(), 300);
    CHECK_FALSE(feed.is_settled());
}
