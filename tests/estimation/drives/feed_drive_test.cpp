// SPDX-License-Identifier: Apache-2.0
#include "estimation/drives/feed_drive.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace millforce::estimation;

namespace {

FeedDriveParameters<double> paper_axis() {
    FeedDriveParameters<double> p;
    p.positive = {3.5788, -7.2469};
    p.negative = {3.5788, -6.0};
    p.K_x3_A = 19.7252;
    p.gravity_A = -5.39;
    p.K_x4_N_per_A = 100.0;
    p.velocity_floor_mm_s = 0.5;
    return p;
}

FeedDrive<double>::Average moving(double velocity_mm_s, double current_A) {
    return {
        .current_A = current_A, .velocity_mm_s = velocity_mm_s, .duration_s = 0.05, .samples = 50.0, .present = true};
}

}  // namespace

TEST_GROUP(FeedDrive){};

TEST(FeedDrive, subtracts_the_papers_friction_in_each_direction_and_the_weight) {
    const FeedDrive<double> axis(paper_axis());
    const double w = 0.3;  // m/min, 5 mm/s
    const double friction = 3.5788 * w * w - 7.2469 * w + 19.7252;
    DOUBLES_EQUAL(250.0, axis.force_N(moving(5.0, friction - 5.39 + 2.5)).value, 1e-6);
    const double back = 3.5788 * w * w - 6.0 * w + 19.7252;
    DOUBLES_EQUAL(-250.0, axis.force_N(moving(-5.0, -back - 5.39 - 2.5)).value, 1e-6);
}

TEST(FeedDrive, adds_the_term_over_feedrate_with_the_sign_of_travel) {
    auto p = paper_axis();
    p.K_x5_N_m_per_min = 12.0;
    const FeedDrive<double> with(p);
    const FeedDrive<double> without(paper_axis());
    DOUBLES_EQUAL(40.0, with.force_N(moving(5.0, 20.0)).value - without.force_N(moving(5.0, 20.0)).value, 1e-9);
    DOUBLES_EQUAL(-40.0, with.force_N(moving(-5.0, 20.0)).value - without.force_N(moving(-5.0, 20.0)).value, 1e-9);
}

TEST(FeedDrive, has_no_estimate_at_rest_or_where_it_turned_round) {
    const FeedDrive<double> axis(paper_axis());
    CHECK_FALSE(axis.force_N(moving(0.0, 3.0)).valid);
    CHECK_FALSE(axis.force_N(moving(0.4, 3.0)).valid);
    auto turning = moving(2.0, 3.0);
    turning.acceleration_mm_s2 = -120.0;  // 3 mm/s less within half of the 50 ms
    CHECK_FALSE(axis.force_N(turning).valid);
    CHECK(axis.force_N(moving(2.0, 3.0)).valid);
}

TEST(FeedDrive, learns_twenty_percent_more_friction_in_air_and_nearly_so_much_for_the_other_direction) {
    FeedDrive<double> axis(paper_axis());
    const double w = 0.6;
    const double friction = 3.5788 * w * w - 7.2469 * w + 19.7252;
    for (int k = 0; k < 100; ++k) {
        axis.rezero(moving(10.0, 1.2 * friction - 5.39));
    }
    DOUBLES_EQUAL(1.2, axis.friction_scale(true), 0.002);
    // The other direction was not travelled: it follows as far as the two belong together.
    DOUBLES_EQUAL(1.19, axis.friction_scale(false), 0.003);
    DOUBLES_EQUAL(0.0, axis.force_N(moving(10.0, 1.2 * friction - 5.39)).value, 3.0);
}

TEST(FeedDrive, learns_at_once_what_denies_its_friction_eight_times_on_end) {
    const auto p = paper_axis();
    const double friction_A = p.positive.at(0.6) + p.K_x3_A;
    const auto with = [&](double scale) { return moving(10.0, p.gravity_A + scale * friction_A); };
    FeedDrive<double> axis(p);
    for (int k = 0; k < 2000; ++k) {
        axis.rezero(with(1.0));
    }
    for (int k = 0; k < 7; ++k) {
        axis.rezero(with(1.1));
    }
    CHECK(axis.friction_scale(true) < 1.01);  // a cut that begins is no friction
    axis.rezero(with(1.1));
    DOUBLES_EQUAL(1.1, axis.friction_scale(true), 0.001);
}

TEST(FeedDrive, learns_slowly_what_denies_its_friction_now_and_then_or_to_both_sides) {
    const auto p = paper_axis();
    const double friction_A = p.positive.at(0.6) + p.K_x3_A;
    const auto with = [&](double scale) { return moving(10.0, p.gravity_A + scale * friction_A); };
    for (const double every_other : {1.0, 0.9}) {
        FeedDrive<double> axis(p);
        for (int k = 0; k < 2000; ++k) {
            axis.rezero(with(1.0));
        }
        for (int k = 0; k < 20; ++k) {
            axis.rezero(with(1.1));
            axis.rezero(with(every_other));
        }
        CHECK(axis.friction_scale(true) < 1.02);
    }
}

TEST(FeedDrive, does_not_learn_a_reversed_current_or_the_friction_of_another_machine) {
    const auto p = paper_axis();
    const double friction_A = p.positive.at(0.6) + p.K_x3_A;
    for (const double scale : {-1.0, 0.0, 3.0, 10.0}) {
        FeedDrive<double> drive(p);  // friction known to 20 %
        drive.rezero(moving(10.0, p.gravity_A + scale * friction_A));
        CHECK(drive.is_implausible());
        DOUBLES_EQUAL(1.0, drive.friction_scale(true), 1e-12);
        CHECK_FALSE(drive.force_N(moving(10.0, 20.0)).valid);
        drive.rezero(moving(10.0, p.gravity_A + 1.2 * friction_A));
        CHECK(drive.force_N(moving(10.0, 20.0)).valid);
    }
}

TEST(FeedDrive, takes_the_moved_mass_out) {
    auto p = paper_axis();
    p.mass_kg = 200.0;
    const FeedDrive<double> axis(p);
    auto accelerating = moving(10.0, 18.0);
    accelerating.acceleration_mm_s2 = 100.0;
    DOUBLES_EQUAL(-20.0, axis.force_N(accelerating).value - axis.force_N(moving(10.0, 18.0)).value, 1e-9);
}

TEST(FeedDrive, knows_of_a_standing_axis_what_its_motor_carries_beyond_static_friction) {
    auto p = paper_axis();
    p.friction_relative_sd = 0.1;
    const FeedDrive<double> axis(p);
    const double held_A = 1.3 * 1.2 * p.K_x3_A;
    for (const double sign : {-1.0, 1.0}) {
        CHECK_FALSE(axis.least_force_at_rest_N(moving(0.0, p.gravity_A + sign * 0.99 * held_A)).valid);
        const auto least_N = axis.least_force_at_rest_N(moving(0.0, p.gravity_A + sign * (held_A + 4.0)));
        CHECK(least_N.valid);
        DOUBLES_EQUAL(sign * 400.0, least_N.value, 1e-6);
    }
    CHECK_FALSE(axis.least_force_at_rest_N(moving(5.0, p.gravity_A + 2.0 * held_A)).valid);
}

TEST(FeedDrive, says_nothing_at_rest_where_it_is_far_noisier_than_stated) {
    auto p = paper_axis();
    FeedDrive<double> tenfold(p);
    const auto loaded = moving(0.0, p.gravity_A + 10.0 * p.K_x3_A);
    CHECK(tenfold.least_force_at_rest_N(loaded).valid);
    for (int k = 0; k < 20; ++k) {
        tenfold.learn_noise(tenfold.change_N(10.0 * p.current_sd_A, 2.0));
    }
    CHECK_FALSE(tenfold.least_force_at_rest_N(loaded).valid);
}

TEST(FeedDrive, gives_no_force_from_air_that_cannot_be_until_air_that_can) {
    auto p = paper_axis();
    FeedDrive<double> axis(p);
    const double friction_A = p.positive.at(0.3) + p.K_x3_A;
    const auto in_air = moving(5.0, friction_A + p.gravity_A);
    axis.rezero(moving(5.0, 10.0 * friction_A + p.gravity_A));
    CHECK_FALSE(axis.force_N(in_air).valid);
    CHECK_FALSE(axis.least_force_at_rest_N(moving(0.0, p.gravity_A + 10.0 * p.K_x3_A)).valid);
    axis.rezero(in_air);
    CHECK(axis.force_N(in_air).valid);
}

/// A week of cuts in one direction, then the friction grows by a twentieth.
TEST(FeedDrive, follows_the_friction_of_one_direction_however_long_the_other_was_not_used) {
    const auto p = paper_axis();
    FeedDrive<double> axis(p);
    const double friction_A = p.positive.at(0.6) + p.K_x3_A;
    const auto mill_for = [&](int minutes, double scale) {
        for (int minute = 0; minute < minutes; ++minute) {
            axis.predict(60.0);
            axis.rezero(moving(10.0, p.gravity_A + scale * friction_A));
        }
    };
    mill_for(10'000, 1.0);
    DOUBLES_EQUAL(1.0, axis.friction_scale(true), 1e-6);
    mill_for(10, 1.05);
    DOUBLES_EQUAL(1.05, axis.friction_scale(true), 0.01);
}

TEST(FeedDrive, doubts_its_friction_beyond_the_feeds_of_the_calibration) {
    auto p = paper_axis();
    p.friction_speed_min_m_per_min = 0.36;
    p.friction_speed_max_m_per_min = 0.58;
    p.K_x1_sd_A_min2_per_m2 = 1.31;
    const FeedDrive<double> axis(p);
    const auto sd_beyond_N = [&](double w) {
        const auto average = moving(w / 0.06, p.positive.at(w) + p.K_x3_A + p.gravity_A);
        return std::sqrt(axis.force_N(average).variance - FeedDrive<double>(paper_axis()).force_N(average).variance);
    };
    DOUBLES_EQUAL(0.0, sd_beyond_N(0.4), 1e-3);
    DOUBLES_EQUAL(100.0 * 1.31 * (6.0 - 0.58) * (6.0 - 0.36), sd_beyond_N(6.0), 1.0);
    DOUBLES_EQUAL(100.0 * 1.31 * (0.36 - 0.1) * (0.58 - 0.1), sd_beyond_N(0.1), 0.1);
}

TEST(FeedDrive, learns_nothing_of_the_cuts_feed_from_a_rapid_that_its_calibration_does_not_know) {
    auto p = paper_axis();
    p.friction_speed_max_m_per_min = 0.6;
    p.K_x1_sd_A_min2_per_m2 = 2.0;
    FeedDrive<double> axis(p);
    const double w = 6.0;
    const double truly_A = p.positive.at(w) + p.K_x3_A - 1.5 * w * w;  // its curvature was not determined
    for (int k = 0; k < 20; ++k) {
        axis.rezero(moving(w / 0.06, truly_A + p.gravity_A));
    }
    CHECK_FALSE(axis.is_implausible());
    const auto in_the_cut = axis.force_N(moving(5.0, p.positive.at(0.3) + p.K_x3_A + p.gravity_A));
    CHECK(std::abs(in_the_cut.value) < 2.0 * std::sqrt(in_the_cut.variance));
}
