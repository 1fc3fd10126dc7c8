// SPDX-License-Identifier: Apache-2.0
#include "estimation/cutting/cut_geometry.hpp"

#include <CppUTest/TestHarness.h>

#include <numbers>

using namespace millforce::estimation;

namespace {

constexpr double pi_rad = std::numbers::pi;
constexpr double tolerance_rad = 1e-12;

void check_angles(double entry_rad, double exit_rad, const EngagementAngles<double>& angles) {
    DOUBLES_EQUAL(entry_rad, angles.entry_rad, tolerance_rad);
    DOUBLES_EQUAL(exit_rad, angles.exit_rad, tolerance_rad);
}

}  // namespace

TEST_GROUP(CutGeometry){};

TEST(CutGeometry, up_milling_begins_and_down_milling_ends_with_a_chip_of_no_thickness) {
    check_angles(0.0, pi_rad / 3.0, engagement_angles(CutSide::up, 0.5));
    check_angles(2.0 * pi_rad / 3.0, pi_rad, engagement_angles(CutSide::down, 0.5));
}

TEST(CutGeometry, a_side_that_is_not_known_is_taken_for_down) {
    check_angles(2.0 * pi_rad / 3.0, pi_rad, engagement_angles(CutSide::unknown, 0.5));
}

TEST(CutGeometry, a_centred_cut_lies_on_both_sides_of_the_thickest_chip) {
    check_angles(pi_rad / 3.0, 2.0 * pi_rad / 3.0, engagement_angles(CutSide::centred, 1.0));
}

TEST(CutGeometry, a_centred_cut_that_reaches_beyond_the_cutter_ends_at_its_edge) {
    check_angles(0.0, pi_rad / 2.0, engagement_angles(CutSide::centred, 1.0, 0.5));
    check_angles(0.0, 2.0 * pi_rad / 3.0, engagement_angles(CutSide::centred, 1.5, 0.25));
    check_angles(pi_rad / 3.0, pi_rad, engagement_angles(CutSide::centred, 1.5, -0.25));
}

TEST(CutGeometry, an_immersion_beyond_the_diameter_is_a_full_slot) {
    check_angles(0.0, pi_rad, engagement_angles(CutSide::up, 2.5));
    check_angles(0.0, pi_rad, engagement_angles(CutSide::down, 2.5));
}
