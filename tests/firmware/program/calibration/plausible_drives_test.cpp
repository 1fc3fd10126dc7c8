// SPDX-License-Identifier: Apache-2.0
#include "calibration/plausible_drives.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <string>

using namespace millforce::host;
using namespace millforce::test;

namespace {

/// Four moves to and fro at 500 mm/s, a sample each millisecond.
AxisMotionUnits moves_with(double acceleration_m_s2, double spike_mm_s = 0.0) {
    constexpr double feed_mm_s = 500.0;
    AxisMotionUnits units;
    double velocity_mm_s = 0.0;
    for (int k = 0; k < 8000; ++k) {
        const double target_mm_s = k / 1000 % 2 == 0 ? feed_mm_s : -feed_mm_s;
        const double step_mm_s = acceleration_m_s2;  // in 1 ms
        velocity_mm_s += std::clamp(target_mm_s - velocity_mm_s, -step_mm_s, step_mm_s);
        units.look_at(0.001 * k, velocity_mm_s + (k == 4500 ? spike_mm_s : 0.0));
    }
    return units;
}

std::string error_of(const AxisMotionUnits& units, double longest_travel_m = 0.5) {
    return message_of<InputError>([&] { units.refuse_implausible("air.csv", 'x', longest_travel_m); });
}

}  // namespace

TEST_GROUP(PlausibleDrives){};

TEST(PlausibleDrives, an_axis_that_accelerates_as_none_can_is_refused_and_as_few_can_is_asked_about) {
    STRCMP_EQUAL("", error_of(moves_with(10.0)).c_str());
    LONGS_EQUAL(0, moves_with(10.0).questions('x').size());
    STRCMP_EQUAL("", error_of(moves_with(25.0)).c_str());
    STRCMP_CONTAINS("which ball screws do not reach", moves_with(25.0).questions('x').at(0).c_str());
    const std::string error = error_of(moves_with(120.0));
    STRCMP_CONTAINS("air.csv: column 'x_velocity_mm_s': x accelerates by ", error.c_str());
    STRCMP_CONTAINS("expected at most 50 m/s²; is it in mm/min, or time_s in min?", error.c_str());
}

TEST(PlausibleDrives, one_wrong_sample_of_a_velocity_is_no_acceleration) {
    STRCMP_EQUAL("", error_of(moves_with(2.0, 100e3)).c_str());
}

TEST(PlausibleDrives, a_long_axis_with_frequent_samples_may_travel_far) {
    STRCMP_EQUAL("", error_of(moves_with(2.0), 20.0).c_str());
}

TEST(PlausibleDrives, a_gain_is_asked_about_beyond_a_third_and_three_times_that_of_the_file) {
    LONGS_EQUAL(0, ask_about_gain("K", 2.9, 1.0).size());
    LONGS_EQUAL(0, ask_about_gain("K", 0.34, 1.0).size());
    LONGS_EQUAL(0, ask_about_gain("K", 70.0, 0.0).size());
    LONGS_EQUAL(1, ask_about_gain("K", 3.1, 1.0).size());
    LONGS_EQUAL(1, ask_about_gain("K", 0.32, 1.0).size());
}
