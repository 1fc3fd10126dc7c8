// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cutting/angle_units.hpp"
#include "cutting/revolution_load.hpp"
#include "files/input_error.hpp"

using namespace millforce::host;
using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;
constexpr CuttingCoefficients steel{
    .K_tc_N_mm2 = 1800.0, .K_rc_N_mm2 = 700.0, .K_ac_N_mm2 = 200.0, .K_te_N_mm = 25.0, .K_re_N_mm = 30.0};

Cutter helical(std::size_t teeth, double helix_deg) {
    Cutter cutter;
    cutter.teeth = teeth;
    cutter.helix_rad = helix_deg * degree;
    return cutter;
}

EngagementMap down_milling(double radial_immersion, double axial_depth_mm) {
    return uniform_engagement(pi - std::acos(1.0 - radial_immersion), pi, axial_depth_mm);
}

}  // namespace

TEST_GROUP(RevolutionLoad){};

TEST(RevolutionLoad, agrees_with_plain_sampling_at_many_angles) {
    Cutter cutter = helical(3, 35.0);
    cutter.runout_mm = 0.01;
    const CuttingForce force(cutter, steel, {});
    const EngagementMap map = down_milling(0.6, 5.0);
    const RevolutionLoad load = revolution_load(force, 0.08, map);
    double fx_N = 0.0;
    double fz_N = 0.0;
    double peak_N = 0.0;
    constexpr int samples = 20000;
    for (int i = 0; i < samples; ++i) {
        const CuttingLoad sample = force.load(2.0 * pi * (i + 0.5) / samples, 0.08, map);
        fx_N += sample.fx_N / samples;
        fz_N += sample.fz_N / samples;
        peak_N = std::max(peak_N, std::hypot(sample.fx_N, sample.fy_N));
    }
    DOUBLES_EQUAL(fx_N, load.mean_fx_N, 1e-3 * peak_N);
    DOUBLES_EQUAL(fz_N, load.mean_fz_N, 1e-3 * peak_N);
    DOUBLES_EQUAL(peak_N, load.peak_total_N, 1e-3 * peak_N);
}

TEST(RevolutionLoad, at_low_immersion_the_total_is_one_tooths_force) {
    const RevolutionLoad load = revolution_load(CuttingForce(helical(4, 30.0), steel, {}), 0.1, down_milling(0.1, 3.0));
    DOUBLES_EQUAL(load.peak_tooth_N, load.peak_total_N, 1e-9);
}

TEST(RevolutionLoad, in_a_slot_straight_teeth_add_up_to_a_quarter_of_their_number) {
    // Over half a turn Σ sin²φ = N/4 and Σ sin φ cos φ = 0, so the total is steady at N/4 of one tooth's peak.
    const CuttingCoefficients chip_only{.K_tc_N_mm2 = 1800.0, .K_rc_N_mm2 = 700.0};
    for (const std::size_t teeth : {4UL, 6UL, 8UL, 12UL}) {
        const CuttingForce force(helical(teeth, 0.0), chip_only, {.chip_model = ChipModel::circular});
        const RevolutionLoad slot = revolution_load(force, 0.1, down_milling(2.0, 3.0));
        DOUBLES_EQUAL(0.1 * 3.0 * std::hypot(1800.0, 700.0), slot.peak_tooth_N, 1e-4 * slot.peak_tooth_N);
        DOUBLES_EQUAL(0.25 * static_cast<double>(teeth), slot.peak_total_N / slot.peak_tooth_N, 1e-4);
    }
}

TEST(RevolutionLoad, the_more_immersion_the_more_the_total_exceeds_the_tooths_force) {
    const CuttingForce force(helical(8, 30.0), steel, {});
    double before = 1.0;
    for (const double radial_immersion : {0.5, 1.0, 1.5, 2.0}) {
        const RevolutionLoad load = revolution_load(force, 0.1, down_milling(radial_immersion, 3.0));
        const double ratio = load.peak_total_N / load.peak_tooth_N;
        CHECK(ratio > 1.05 * before);
        before = ratio;
    }
}

TEST(RevolutionLoad, the_peak_of_straight_teeth_stands_at_the_jump_of_their_entry) {
    const CuttingForce force(helical(2, 0.0), steel, {.chip_model = ChipModel::circular});
    const double entry_rad = 130.123 * degree;
    const RevolutionLoad load = revolution_load(force, 0.1, uniform_engagement(entry_rad, pi, 2.0));
    const double h_mm = 0.1 * std::sin(entry_rad);
    const double tooth_N = 2.0 * std::hypot(1800.0 * h_mm + 25.0, 700.0 * h_mm + 30.0);
    DOUBLES_EQUAL(tooth_N, load.peak_tooth_N, 1e-5 * tooth_N);
    DOUBLES_EQUAL(load.peak_tooth_N, load.tooth_peak_N[1], 0.0);
}

TEST(RevolutionLoad, one_pitch_stands_for_all_where_the_teeth_are_equal) {
    Cutter equal = helical(4, 30.0);
    Cutter spelled_out = equal;
    spelled_out.tooth_pitch_rad = {pi / 2.0, pi / 2.0, pi / 2.0, pi / 2.0};  // takes the long way round
    const EngagementMap map = down_milling(0.7, 6.0);
    const RevolutionLoad a = revolution_load(CuttingForce(equal, steel, {}), 0.1, map);
    const RevolutionLoad b = revolution_load(CuttingForce(spelled_out, steel, {}), 0.1, map);
    DOUBLES_EQUAL(b.mean_fx_N, a.mean_fx_N, 1e-3 * a.peak_total_N);
    DOUBLES_EQUAL(b.mean_torque_Nm, a.mean_torque_Nm, 1e-3 * a.mean_torque_Nm);
    DOUBLES_EQUAL(b.peak_tooth_N, a.peak_tooth_N, 1e-3 * a.peak_tooth_N);
    DOUBLES_EQUAL(b.peak_torque_Nm, a.peak_torque_Nm, 1e-3 * a.peak_torque_Nm);
}

TEST(RevolutionLoad, air_gives_nothing_and_a_senseless_step_is_refused) {
    const CuttingForce force(helical(4, 30.0), steel, {});
    const RevolutionLoad air = revolution_load(force, 0.1, EngagementMap{});
    DOUBLES_EQUAL(0.0, air.peak_total_N, 0.0);
    DOUBLES_EQUAL(0.0, air.mean_torque_Nm, 0.0);
    CHECK_THROWS(InputError, revolution_load(force, 0.1, EngagementMap{}, 0.0));
}
