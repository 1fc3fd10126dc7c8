// SPDX-License-Identifier: Apache-2.0
#include "control/path_turn.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

using Turn = millforce::control::PathTurn<float>;

namespace {

constexpr double feed_mm_s = 20.0;
constexpr double dt_s = 0.001;

Turn::Motion motion_at(double direction_rad, double speed_mm_s = feed_mm_s, double commanded_mm_s = feed_mm_s) {
    return {static_cast<float>(dt_s),
            static_cast<float>(speed_mm_s * std::cos(direction_rad)),
            static_cast<float>(speed_mm_s * std::sin(direction_rad)),
            static_cast<float>(speed_mm_s),
            static_cast<float>(speed_mm_s * dt_s),
            static_cast<float>(commanded_mm_s / feed_mm_s),
            static_cast<float>(feed_mm_s)};
}

int turns_on_an_arc(double radius_mm) {
    Turn turn;
    int turns = 0;
    for (double angle = 0.0; angle < 2.0 * std::numbers::pi; angle += feed_mm_s * dt_s / radius_mm) {
        turns += turn.update(motion_at(angle)) ? 1 : 0;
    }
    return turns;
}

/// Goes straight, then turns by `angle_rad` as a drive does whose position loop follows at 80 /s: the way after the
/// corner until it is noticed.
double way_until_noticed_mm(double angle_rad) {
    Turn turn;
    for (int k = 0; k < 100; ++k) {
        CHECK_FALSE(turn.update(motion_at(0.3)));
    }
    for (double t = 0.0; t < 0.2; t += dt_s) {
        const double share = 1.0 - std::exp(-80.0 * t);
        const double x = (1.0 - share) + share * std::cos(angle_rad);
        const double y = share * std::sin(angle_rad);
        if (turn.update(motion_at(0.3 + std::atan2(y, x), feed_mm_s * std::hypot(x, y), 0.0))) {
            return feed_mm_s * t;
        }
    }
    return -1.0;
}

}  // namespace

TEST_GROUP(PathTurn){};

TEST(PathTurn, notices_a_corner_within_a_third_of_a_millimetre) {
    for (const double angle : {60.0, 90.0, 120.0, 179.0, -90.0}) {
        const double way_mm = way_until_noticed_mm(angle * std::numbers::pi / 180.0);
        CHECK(way_mm >= 0.0);
        CHECK(way_mm < 0.34);
    }
}

TEST(PathTurn, takes_no_arc_of_two_millimetres_or_more_for_a_corner) {
    LONGS_EQUAL(0, turns_on_an_arc(2.0));
    LONGS_EQUAL(0, turns_on_an_arc(25.0));
    CHECK(turns_on_an_arc(0.2) > 0);
}

TEST(PathTurn, notices_that_the_machine_brakes_unasked_once) {
    Turn turn;
    int noticed = 0;
    for (int k = 0; k < 100; ++k) {
        const double speed = k < 50 ? 20.0 : 20.0 - 2.0 * std::fmin(k - 50, 8.0);
        noticed += turn.update(motion_at(0.0, speed)) ? 1 : 0;
    }
    LONGS_EQUAL(1, noticed);
}

TEST(PathTurn, does_not_take_the_shaking_of_slow_teeth_for_braking) {
    // 600 rpm, three teeth: each slows the axis to a third and lets it spring back.
    const auto noticed = [](float tooth_period_s) {
        Turn turn;
        int count = 0;
        for (int k = 0; k < 2000; ++k) {
            const double phase = 2.0 * std::numbers::pi * 30.0 * k * dt_s;
            Turn::Motion motion = motion_at(0.1 * std::sin(phase), feed_mm_s * (1.0 + 0.6 * std::sin(phase)));
            motion.tooth_period_s = tooth_period_s;
            count += turn.update(motion) ? 1 : 0;
        }
        return count;
    };
    LONGS_EQUAL(0, noticed(1.0F / 30.0F));
    CHECK(noticed(0.0F) > 0);
}

TEST(PathTurn, does_not_take_a_falling_or_rising_override_for_braking) {
    Turn turn;
    double speed = 20.0;
    double commanded = 20.0;
    for (int k = 0; k < 4000; ++k) {
        const bool falling = (k / 500) % 2 == 0;
        commanded = falling ? std::fmax(commanded - 0.8, 2.0) : std::fmin(commanded + 0.04, 20.0);
        // 10 ms behind, at most 2000 mm/s² faster or slower.
        speed += std::fmax(std::fmin((commanded - speed) * dt_s / 0.010, 2.0), -2.0);
        CHECK_FALSE(turn.update(motion_at(0.0, speed, commanded)));
    }
}

TEST(PathTurn, is_not_misled_by_standing_still_or_by_what_is_no_number) {
    Turn turn;
    CHECK_FALSE(turn.update(motion_at(0.0)));
    CHECK_FALSE(turn.update(motion_at(2.0, 0.1, 0.0)));
    CHECK_FALSE(turn.update(motion_at(std::nan(""))));
    CHECK_FALSE(turn.update({}));
    CHECK_FALSE(turn.update(motion_at(0.0)));
    CHECK(turn.update(motion_at(2.0)));
}

TEST(PathTurn, takes_a_velocity_without_travel_for_no_turn) {
    for (const float path_speed_mm_s : {0.0F, -20.0F, NAN}) {
        Turn turn;
        for (int k = 0; k < 100; ++k) {
            CHECK_FALSE(turn.update(motion_at(0.0)));
        }
        Turn::Motion motion = motion_at(1.5, feed_mm_s, 0.0);
        motion.path_speed_mm_s = path_speed_mm_s;
        CHECK_FALSE(turn.update(motion));
    }
}

TEST(PathTurn, notices_a_corner_with_slow_teeth_and_after_a_velocity_that_is_no_number) {
    for (const double direction : {0.0, 0.5 * std::numbers::pi}) {
        const auto slow = [](double direction_rad) {
            Turn::Motion motion = motion_at(direction_rad);
            motion.tooth_period_s = 1.0F / 30.0F;
            return motion;
        };
        Turn turn;
        bool noticed = false;
        for (int k = 0; k < 200; ++k) {
            noticed = turn.update(slow(direction)) || noticed;
        }
        noticed = turn.update(slow(std::nan(""))) || noticed;
        for (int k = 0; k < 200; ++k) {
            noticed = turn.update(slow(direction)) || noticed;
        }
        CHECK_FALSE(noticed);
        for (int k = 0; k < 100; ++k) {
            noticed = turn.update(slow(direction - 0.5 * std::numbers::pi)) || noticed;
        }
        CHECK_TRUE(noticed);
    }
}

TEST(PathTurn, remembers_the_direction_of_a_first_step_that_has_gone_no_way_yet) {
    Turn turn;
    Turn::Motion first = motion_at(0.0);
    first.travel_mm = 0.0F;
    CHECK_FALSE(turn.update(first));
    CHECK(turn.update(motion_at(1.5)));
}

TEST(PathTurn, follows_a_bend_in_steps_longer_than_its_memory) {
    Turn turn;
    constexpr double rapid_mm_s = 1000.0;  // a millimetre in each step
    for (const double direction_degrees : {0.0, 25.0, 10.0, 25.0, 50.0}) {
        CHECK_FALSE(turn.update(motion_at(direction_degrees * std::numbers::pi / 180.0, rapid_mm_s, 0.0)));
    }
}
