// SPDX-License-Identifier: Apache-2.0
#include "firmware/feed_frame.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

using Frame = millforce::firmware::FeedFrame<float>;

namespace {

constexpr float dt_s = 0.001F;

Frame::Pose after(Frame& frame, double direction_rad, int samples, float speed_mm_s = 10.0F) {
    Frame::Pose pose;
    for (int k = 0; k < samples; ++k) {
        pose = frame.update(dt_s, speed_mm_s * static_cast<float>(std::cos(direction_rad)),
                            speed_mm_s * static_cast<float>(std::sin(direction_rad)));
    }
    return pose;
}

}  // namespace

TEST_GROUP(FeedFrame){};

TEST(FeedFrame, turns_forces_into_the_feeds_direction) {
    for (const double direction : {0.0, 0.7, 2.2, -3.0}) {
        Frame frame;
        const auto pose = after(frame, direction, 3);
        CHECK(pose.valid);
        DOUBLES_EQUAL(direction / (2.0 * std::numbers::pi), static_cast<double>(pose.direction_rev), 1e-6);
        const auto x = static_cast<float>(50.0 * std::cos(direction) - 20.0 * std::sin(direction));
        const auto y = static_cast<float>(50.0 * std::sin(direction) + 20.0 * std::cos(direction));
        DOUBLES_EQUAL(50.0, static_cast<double>(pose.along(x, y)), 1e-4);
        DOUBLES_EQUAL(20.0, static_cast<double>(pose.across(x, y)), 1e-4);
    }
}

TEST(FeedFrame, follows_a_bend_of_less_than_three_degrees_and_is_new_beyond) {
    Frame frame;
    CHECK(after(frame, 0.0, 1).is_new);
    CHECK_FALSE(after(frame, 0.0, 1000).is_new);
    const auto bent = after(frame, 0.04, 2000);
    CHECK_FALSE(bent.is_new);
    DOUBLES_EQUAL(0.04 / (2.0 * std::numbers::pi), static_cast<double>(bent.direction_rev), 1e-5);
    int is_new = 0;
    for (int k = 0; k < 2000; ++k) {
        is_new += after(frame, 0.09, 1).is_new ? 1 : 0;
    }
    LONGS_EQUAL(1, is_new);
}

TEST(FeedFrame, is_not_shaken_by_a_drive_that_gives_way_to_each_tooth) {
    Frame frame;
    after(frame, 0.5, 1000);
    for (int k = 0; k < 2000; ++k) {
        const double shake = 0.2 * std::sin(2.0 * std::numbers::pi * 30.0 * k * 0.001);
        CHECK_FALSE(after(frame, 0.5 + shake, 1).is_new);
    }
}

TEST(FeedFrame, has_no_direction_while_the_feed_stands_or_is_no_number) {
    Frame frame;
    CHECK_FALSE(after(frame, 0.0, 10, 0.05F).valid);
    CHECK_FALSE(after(frame, 0.0, 1, std::nanf("")).valid);
    CHECK(after(frame, 1.0, 1).valid);
}
