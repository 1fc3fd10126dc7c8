// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/force_drop_calibration.hpp"

#include "estimation/force_drop/face_mill_signal.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <random>

using namespace millforce::estimation;
using millforce::tests::FaceMillSignal;

namespace {

/// Jump and mean of an up cut with 1 % of noise on each.
ForceDropCalibrationCut calibration_cut(double immersion, double feed_mm, std::mt19937_64& random) {
    std::normal_distribution<double> normal(0.0, 1.0);
    FaceMillSignal signal;
    signal.exit_rad = std::acos(1.0 - immersion);
    signal.feed_mm = feed_mm;
    signal.e_t_mm = 0.03;
    signal.e_r_mm = 0.05;
    const auto tooth = signal.tooth(signal.exit_rad);
    const auto mean = signal.mean();
    const auto noisy = [&](double force_N, double size_N) {
        const double sd = 0.01 * size_N;
        return Measurement<double>{true, force_N + sd * normal(random), sd * sd, {}};
    };
    ForceDropCalibrationCut cut;
    cut.measured.tooth_x_N = noisy(tooth.x_N, 300.0);
    cut.measured.tooth_y_N = noisy(tooth.y_N, 300.0);
    cut.measured.mean_x_N = noisy(mean.x_N, 60.0);
    cut.measured.mean_y_N = noisy(mean.y_N, 60.0);
    cut.measured.feed_per_tooth_mm = feed_mm;
    cut.measured.teeth = signal.teeth;
    cut.measured.side = CutSide::up;
    cut.axial_depth_mm = 1.5;
    cut.radial_immersion = immersion;
    return cut;
}

ForceDropCalibration cuts_at(std::initializer_list<double> feeds_mm, unsigned seed) {
    std::mt19937_64 random(seed);
    ForceDropCalibration calibration;
    for (const double feed_mm : feeds_mm) {
        for (const double immersion : {0.2, 0.35, 0.5, 0.65, 0.8}) {
            calibration.add(calibration_cut(immersion, feed_mm, random));
        }
    }
    return calibration;
}

}  // namespace

TEST_GROUP(ForceDropCalibration){};

TEST(ForceDropCalibration, finds_the_edge_lengths_within_their_standard_errors) {
    int within = 0;
    for (unsigned seed = 1; seed <= 30; ++seed) {
        const auto result = cuts_at({0.1, 0.15, 0.2}, seed).solve();
        CHECK(result.edges_determined);
        DOUBLES_EQUAL(0.03, result.law.e_t_mm, 0.01);
        DOUBLES_EQUAL(0.05, result.law.e_r_mm, 0.01);
        within += std::abs(result.law.e_t_mm - 0.03) <= 2.0 * result.law.e_t_sd_mm ? 1 : 0;
    }
    CHECK(within >= 25);
}

TEST(ForceDropCalibration, gives_a_line_through_the_material_s_ratio) {
    const auto law = cuts_at({0.1, 0.15, 0.2}, 3).solve().law;
    CHECK(law.valid);
    DOUBLES_EQUAL(0.4, law.a * 0.4 + law.b, 0.02);
    DOUBLES_EQUAL(0.0, law.c(0), 0.05);
    CHECK(law.r_scatter > 0.0);
}

TEST(ForceDropCalibration, does_not_tell_edge_from_chip_at_one_feed) {
    const auto result = cuts_at({0.15, 0.15}, 5).solve();
    CHECK_FALSE(result.edges_determined);
    CHECK_FALSE(result.law.valid);
}

TEST(ForceDropCalibration, without_edges_is_the_papers_law) {
    const auto result = cuts_at({0.1, 0.15, 0.2}, 4).solve_without_edges();
    CHECK(result.law.valid);
    DOUBLES_EQUAL(0.0, result.law.e_t_mm, 0.0);
    const auto with = cuts_at({0.1, 0.15, 0.2}, 4).solve();
    CHECK(result.law.ln_K_scatter > 1.3 * with.law.ln_K_scatter);
}

TEST(ForceDropCalibration, leaves_out_what_it_cannot_use) {
    std::mt19937_64 random(1);
    ForceDropCalibration calibration;
    auto cut = calibration_cut(0.5, 0.15, random);
    cut.radial_immersion = 1.2;
    CHECK_FALSE(calibration.add(cut));
    cut = calibration_cut(0.5, 0.15, random);
    cut.measured.tooth_x_N.valid = false;
    CHECK_FALSE(calibration.add(cut));
    CHECK_FALSE(calibration.solve().law.valid);
}
