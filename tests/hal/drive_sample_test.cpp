// SPDX-License-Identifier: Apache-2.0
#include "hal/drive_sample.hpp"

#include <CppUTest/TestHarness.h>

#include <limits>

using namespace millforce::hal;

TEST_GROUP(DriveSample){};

TEST(DriveSample, takes_from_another_what_that_one_knows_and_keeps_the_rest) {
    DriveSample sample;
    sample.time_us = 7;
    sample.spindle_current_A = 1.0F;
    set_present(sample, Present::spindle_current);
    DriveSample other;
    other.time_us = 8;
    other.spindle_current_A = 9.0F;  // not present
    other.spindle_count = 100;
    other.force_N = {30.0F, 40.0F};
    set_present(other, Present::spindle_count);
    set_present(other, Present::force_sensor);
    add(sample, other);
    LONGS_EQUAL(7, sample.time_us);
    CHECK(sample.spindle_current_A == 1.0F);
    LONGS_EQUAL(100, sample.spindle_count);
    CHECK(sample.force_N[1] == 40.0F);
    LONGS_EQUAL(mask(Present::spindle_current) | mask(Present::spindle_count) | mask(Present::force_sensor),
                sample.present);
}

TEST(DriveSample, joins_the_current_of_one_source_with_the_velocity_of_another) {
    DriveSample current;
    current.axis_current_A = {1.0F, 2.0F, 3.0F};
    set_known(current, 1, true, false);
    CHECK_TRUE(knows_current(current, 1));
    CHECK_FALSE(knows_velocity(current, 1));
    DriveSample velocity;
    velocity.axis_velocity_mm_s = {10.0F, 20.0F, 30.0F};
    set_known(velocity, 1, false, true);
    LONGS_EQUAL(0, velocity.present);
    add(current, velocity);
    LONGS_EQUAL(axis_mask(1), current.present);
    LONGS_EQUAL(0, current.part);
    CHECK(current.axis_current_A[1] == 2.0F);
    CHECK(current.axis_velocity_mm_s[1] == 20.0F);
    CHECK(current.axis_velocity_mm_s[0] == 0.0F);
}

TEST(DriveSample, an_axis_rests_below_half_a_millimetre_per_second_either_way) {
    CHECK_TRUE(axes_rest({0.4F, -0.4F, 0.0F}));
    CHECK_FALSE(axes_rest({0.0F, 0.0F, 0.6F}));
    CHECK_FALSE(axes_rest({0.0F, -0.6F, 0.0F}));
    CHECK_FALSE(axes_rest({std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F}));
}
