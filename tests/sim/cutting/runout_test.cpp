// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cutting/angle_units.hpp"
#include "cutting/revolution_load.hpp"
#include "random_numbers.hpp"

using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;
constexpr CuttingCoefficients chip_only{.K_tc_N_mm2 = 1800.0, .K_rc_N_mm2 = 700.0, .K_ac_N_mm2 = 200.0};
constexpr ChipModel all_models[] = {ChipModel::circular, ChipModel::offset_circle, ChipModel::trochoidal};

}  // namespace

TEST_GROUP(Runout){};

TEST(Runout, modulates_the_teeth_and_keeps_the_mean) {
    Cutter even;
    Cutter eccentric = even;
    eccentric.runout_mm = 0.02;
    eccentric.runout_angle_rad = 0.3;
    const EngagementMap map = uniform_engagement(50.0 * degree, 130.0 * degree, 3.0);
    for (const ChipModel model : all_models) {
        const RevolutionLoad a = revolution_load(CuttingForce(even, chip_only, {.chip_model = model}), 0.1, map);
        const RevolutionLoad b = revolution_load(CuttingForce(eccentric, chip_only, {.chip_model = model}), 0.1, map);
        const double size_N = std::hypot(a.mean_fx_N, a.mean_fy_N);
        DOUBLES_EQUAL(a.mean_fx_N, b.mean_fx_N, 1e-3 * size_N);
        DOUBLES_EQUAL(a.mean_fy_N, b.mean_fy_N, 1e-3 * size_N);
        DOUBLES_EQUAL(a.mean_torque_Nm, b.mean_torque_Nm, 5e-3 * a.mean_torque_Nm);
        // Tooth k takes R_k − R_(k−1) more or less than the feed; force at φ = 90° is proportional to its chip.
        const double at_90 = std::hypot(1800.0, 700.0) * 3.0;
        for (std::size_t k = 0; k < 4; ++k) {
            const double rise_mm = runout_offset_mm(eccentric, k, 0.0) - runout_offset_mm(eccentric, (k + 3) % 4, 0.0);
            DOUBLES_EQUAL(at_90 * (0.1 + rise_mm), b.tooth_peak_N[k], 0.01 * at_90 * 0.1);
        }
    }
}

TEST(Runout, whatever_one_tooth_misses_the_others_take) {
    // In the circular model the work done per turn is the feed per turn, however the teeth share it.
    RandomNumbers random(31);
    for (int i = 0; i < 60; ++i) {
        Cutter cutter;
        cutter.teeth = random.whole(2, 8);
        cutter.helix_rad = random.between(0.0, 45.0) * degree;
        cutter.flute_length_mm = 6.0;
        const EngagementMap map = uniform_engagement(0.0, random.between(0.4, pi), 5.0);
        const double f_z = random.between(0.01, 0.1);
        const CuttingForceOptions options{.chip_model = ChipModel::circular};
        const RevolutionLoad even = revolution_load(CuttingForce(cutter, chip_only, options), f_z, map);
        cutter.runout_mm = random.between(0.0, 0.15);
        cutter.runout_angle_rad = random.between(0.0, 2.0 * pi);
        const RevolutionLoad eccentric = revolution_load(CuttingForce(cutter, chip_only, options), f_z, map);
        const double size_N = std::hypot(even.mean_fx_N, even.mean_fy_N);
        DOUBLES_EQUAL(even.mean_fx_N, eccentric.mean_fx_N, 2e-3 * size_N);
        DOUBLES_EQUAL(even.mean_fy_N, eccentric.mean_fy_N, 2e-3 * size_N);
    }
}

TEST(Runout, a_tooth_that_misses_leaves_its_chip_to_the_next) {
    Cutter cutter;
    cutter.teeth = 2;
    cutter.runout_mm = 0.05;  // tooth 0 stands out by 0.05 mm, tooth 1 back by as much
    const double f_z = 0.04;
    Cutter lone;
    lone.teeth = 1;
    lone.diameter_mm = cutter.diameter_mm + 2.0 * 0.05;
    const EngagementMap map = uniform_engagement(0.4, 2.6, 3.0);
    for (const ChipModel model : all_models) {
        const CuttingForce force(cutter, chip_only, {.chip_model = model});
        const CuttingForce alone(lone, chip_only, {.chip_model = model});
        for (const double phi : {0.5, 1.0, 1.6, 2.5}) {
            const CuttingLoad load = force.load(phi, f_z, map);
            const CuttingLoad expected = alone.load(phi, 2.0 * f_z, map);
            DOUBLES_EQUAL(expected.fx_N, load.fx_N, 1e-9);
            DOUBLES_EQUAL(expected.fy_N, load.fy_N, 1e-9);
            DOUBLES_EQUAL(expected.spindle_torque_Nm, load.spindle_torque_Nm, 1e-12);
        }
        const RevolutionLoad revolution = revolution_load(force, f_z, map);
        DOUBLES_EQUAL(0.0, revolution.tooth_peak_N[1], 0.0);
    }
}

TEST(Runout, the_chip_is_the_least_that_any_of_the_last_teeth_left) {
    RandomNumbers random(41);
    for (int i = 0; i < 4000; ++i) {
        Cutter cutter;
        cutter.teeth = random.whole(2, 12);
        cutter.runout_mm = random.between(0.0, 0.3);
        cutter.runout_angle_rad = random.between(0.0, 2.0 * pi);
        const double f_z = random.between(0.005, 0.2);
        const double phi = random.between(0.001, pi - 0.001);
        const std::size_t teeth = cutter.teeth;
        for (const ChipModel model : all_models) {
            double least_mm = 1.0;
            for (std::size_t m = 1; m <= teeth; ++m) {
                const EdgePass pass{5.0 + runout_offset_mm(cutter, 0, 0.0),
                                    5.0 + runout_offset_mm(cutter, (teeth - m) % teeth, 0.0),
                                    f_z * static_cast<double>(teeth) / (2.0 * pi),
                                    2.0 * pi * static_cast<double>(m) / static_cast<double>(teeth)};
                least_mm = std::min(least_mm, chip_thickness_mm(model, pass, std::sin(phi), std::cos(phi)));
            }
            const CuttingForce force(cutter, chip_only, {.chip_model = model});
            const CuttingLoad load = force.load(phi, f_z, uniform_engagement(0.0, pi, 2.0));
            DOUBLES_EQUAL(2.0 * std::hypot(1800.0, 700.0) * std::max(0.0, least_mm), load.tooth_force_N[0], 1e-9);
        }
    }
}

TEST(Runout, a_tooth_that_misses_shows_no_edge_force) {
    CuttingCoefficients with_edge = chip_only;
    with_edge.K_te_N_mm = 30.0;
    Cutter cutter;
    cutter.teeth = 2;
    cutter.runout_mm = 0.05;
    const CuttingForce force(cutter, with_edge, {});
    const CuttingLoad load = force.load(pi + 1.2, 0.04, uniform_engagement(0.4, 2.6, 3.0));  // tooth 1 at 1.2 rad
    DOUBLES_EQUAL(0.0, load.tooth_force_N[1], 0.0);
    DOUBLES_EQUAL(0.0, load.spindle_torque_Nm, 0.0);
}

TEST(Runout, repeats_once_a_revolution_and_not_once_a_tooth) {
    Cutter cutter;
    cutter.helix_rad = 30.0 * degree;
    cutter.runout_mm = 0.02;
    const CuttingForce force(cutter, chip_only, {});
    const EngagementMap map = uniform_engagement(0.4, 2.0, 3.0);
    const double here_N = force.load(1.2, 0.1, map).fx_N;
    DOUBLES_EQUAL(here_N, force.load(1.2 + 2.0 * pi, 0.1, map).fx_N, 1e-6);
    CHECK(std::abs(here_N - force.load(1.2 + pi / 2.0, 0.1, map).fx_N) > 0.05 * std::abs(here_N));
}

TEST(Runout, unequal_pitch_gives_each_tooth_the_feed_of_its_own_gap) {
    Cutter cutter;
    cutter.teeth = 3;
    cutter.tooth_pitch_rad = {1.8, 2.2, 2.0 * pi - 4.0};
    const CuttingForce force(cutter, chip_only, {.chip_model = ChipModel::circular});
    const EngagementMap map = uniform_engagement(60.0 * degree, 120.0 * degree, 2.0);
    const RevolutionLoad load = revolution_load(force, 0.1, map);
    const double per_radian_N = std::hypot(1800.0, 700.0) * 2.0 * 0.3 / (2.0 * pi);
    DOUBLES_EQUAL(per_radian_N * (2.0 * pi - 4.0), load.tooth_peak_N[0], 0.05);
    DOUBLES_EQUAL(per_radian_N * 1.8, load.tooth_peak_N[1], 0.05);
    DOUBLES_EQUAL(per_radian_N * 2.2, load.tooth_peak_N[2], 0.05);
    Cutter even;
    even.teeth = 3;
    const RevolutionLoad same =
        revolution_load(CuttingForce(even, chip_only, {.chip_model = ChipModel::circular}), 0.1, map);
    DOUBLES_EQUAL(same.mean_fy_N, load.mean_fy_N, 1e-3 * std::abs(same.mean_fy_N));
}
