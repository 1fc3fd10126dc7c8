// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "cutting/angle_units.hpp"
#include "cutting/cutting_force.hpp"
#include "cutting/revolution_load.hpp"
#include "files/input_error.hpp"
#include "random_numbers.hpp"

using namespace millforce::host;
using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;
constexpr CuttingCoefficients steel{.K_tc_N_mm2 = 1800.0,
                                    .K_rc_N_mm2 = 700.0,
                                    .K_ac_N_mm2 = 200.0,
                                    .K_te_N_mm = 25.0,
                                    .K_re_N_mm = 30.0,
                                    .K_ae_N_mm = 2.0};
constexpr CuttingForceOptions circular{.chip_model = ChipModel::circular};

Cutter single_tooth() {
    Cutter cutter;
    cutter.teeth = 1;
    return cutter;
}

/// Material between two heights only, as a disc of the workpiece would be.
EngagementMap disc(double entry_rad, double exit_rad, double bottom_mm, double top_mm) {
    EngagementMap map = uniform_engagement(entry_rad, exit_rad, top_mm);
    for (EngagementMap::Bin& bin : map.bins) {
        bin.bottom_mm = static_cast<float>(bottom_mm);
    }
    return map;
}

bool cuts(const CuttingLoad& load) {
    return load.tooth_force_N[0] > 0.0;
}

/// The axial extent of one edge in cut, from its edge force alone: all the rest is proportional to the chip.
double length_in_cut_mm(double spindle_rad, const Cutter& cutter, const EngagementMap& map) {
    const CuttingCoefficients only_axial_edge{.K_tc_N_mm2 = 1e-6, .K_ae_N_mm = 1.0};
    return CuttingForce(cutter, only_axial_edge, circular).load(spindle_rad, 0.1, map).fz_N;
}

}  // namespace

TEST_GROUP(CuttingForce){};

TEST(CuttingForce, a_straight_tooth_follows_the_sign_convention) {
    const CuttingForce force(single_tooth(), steel, circular);
    const double depth_mm = 2.0;
    const EngagementMap map = uniform_engagement(0.0, pi, depth_mm);
    for (const double phi : {0.3, 1.1, 2.0, 2.9}) {
        const CuttingLoad load = force.load(phi, 0.1, map);
        const double h_mm = 0.1 * std::sin(phi);
        const double F_t = depth_mm * (steel.K_tc_N_mm2 * h_mm + steel.K_te_N_mm);
        const double F_r = depth_mm * (steel.K_rc_N_mm2 * h_mm + steel.K_re_N_mm);
        DOUBLES_EQUAL(F_t * std::cos(phi) + F_r * std::sin(phi), load.fx_N, 1e-9);
        DOUBLES_EQUAL(-F_t * std::sin(phi) + F_r * std::cos(phi), load.fy_N, 1e-9);
        DOUBLES_EQUAL(depth_mm * (steel.K_ac_N_mm2 * h_mm + steel.K_ae_N_mm), load.fz_N, 1e-9);
        DOUBLES_EQUAL(1e-3 * 5.0 * F_t, load.spindle_torque_Nm, 1e-12);
        DOUBLES_EQUAL(std::hypot(load.fx_N, load.fy_N), load.tooth_force_N[0], 1e-9);
    }
}

TEST(CuttingForce, each_disc_cuts_exactly_while_its_own_angle_is_in_cut) {
    Cutter cutter = single_tooth();
    cutter.helix_rad = 55.0 * degree;
    RandomNumbers random(17);
    const CuttingForce force(cutter, steel, circular);
    for (int i = 0; i < 300; ++i) {
        const double entry_rad = random.between(0.02, 2.0);
        const double exit_rad = random.between(entry_rad + 0.05, pi - 0.02);
        const double height_mm = random.between(0.01, 15.0);
        const EngagementMap map = disc(entry_rad, exit_rad, height_mm - 1e-4, height_mm + 1e-4);
        const double lag_rad = height_mm * std::tan(55.0 * degree) / 5.0;
        const double margin_rad = 1e-4;
        CHECK_FALSE(cuts(force.load(entry_rad + lag_rad - margin_rad, 0.1, map)));
        CHECK(cuts(force.load(entry_rad + lag_rad + margin_rad, 0.1, map)));
        CHECK(cuts(force.load(exit_rad + lag_rad - margin_rad, 0.1, map)));
        CHECK_FALSE(cuts(force.load(exit_rad + lag_rad + margin_rad, 0.1, map)));
    }
}

TEST(CuttingForce, the_edge_in_cut_follows_guans_three_phases_when_the_cut_is_wider_than_the_sweep) {
    Cutter cutter = single_tooth();
    cutter.helix_rad = 30.0 * degree;
    const double depth_mm = 4.0;
    const double sweep_rad = depth_mm * std::tan(cutter.helix_rad) / 5.0;  // ψ_a, 26.5°
    const double entry_rad = 0.0;
    const double exit_rad = 60.0 * degree;
    const EngagementMap map = uniform_engagement(entry_rad, exit_rad, depth_mm);
    DOUBLES_EQUAL(depth_mm * 0.4, length_in_cut_mm(0.4 * sweep_rad, cutter, map), 1e-6);
    DOUBLES_EQUAL(depth_mm, length_in_cut_mm(0.7, cutter, map), 1e-6);
    DOUBLES_EQUAL(depth_mm * 0.4, length_in_cut_mm(exit_rad + 0.6 * sweep_rad, cutter, map), 1e-6);
    DOUBLES_EQUAL(0.0, length_in_cut_mm(exit_rad + 1.01 * sweep_rad, cutter, map), 0.0);
}

TEST(CuttingForce, the_edge_in_cut_follows_guans_three_phases_when_the_cut_is_narrower_than_the_sweep) {
    Cutter cutter = single_tooth();
    cutter.helix_rad = 55.0 * degree;
    const double depth_mm = 6.0;
    const double mm_per_rad = 5.0 / std::tan(cutter.helix_rad);
    const double entry_rad = 150.0 * degree;
    const double exit_rad = pi;  // climb milling
    const double width_rad = exit_rad - entry_rad;
    const EngagementMap map = uniform_engagement(entry_rad, exit_rad, depth_mm);
    DOUBLES_EQUAL(0.3 * mm_per_rad, length_in_cut_mm(entry_rad + 0.3, cutter, map), 1e-6);
    DOUBLES_EQUAL(width_rad * mm_per_rad, length_in_cut_mm(entry_rad + 0.9, cutter, map), 1e-6);
    const double sweep_rad = depth_mm / mm_per_rad;
    DOUBLES_EQUAL(0.2 * mm_per_rad, length_in_cut_mm(exit_rad + sweep_rad - 0.2, cutter, map), 1e-6);
}

TEST(CuttingForce, no_force_and_no_edge_force_out_of_the_material_or_without_feed) {
    const CuttingForce force(single_tooth(), steel, circular);
    const EngagementMap map = uniform_engagement(0.5, 1.5, 2.0);
    for (const double phi : {0.49, 1.51, 4.0}) {
        DOUBLES_EQUAL(0.0, force.load(phi, 0.1, map).spindle_torque_Nm, 0.0);
    }
    CHECK(force.load(1.0, 0.1, map).spindle_torque_Nm > 0.0);
    for (const double feed_mm : {0.0, -0.1}) {
        const CuttingLoad load = force.load(1.0, feed_mm, map);
        DOUBLES_EQUAL(0.0, load.spindle_torque_Nm, 0.0);
        DOUBLES_EQUAL(0.0, load.fz_N, 0.0);
    }
    // Material behind the cutter is left by the feed, never cut.
    DOUBLES_EQUAL(0.0, force.load(4.5, 0.1, uniform_engagement(3.3, 6.2, 2.0)).spindle_torque_Nm, 0.0);
}

TEST(CuttingForce, numbers_that_are_none_are_refused) {
    const CuttingForce force(single_tooth(), steel, circular);
    const EngagementMap map = uniform_engagement(0.5, 1.5, 2.0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS(InputError, force.load(1.0, nan, map));
    CHECK_THROWS(InputError, force.load(nan, 0.1, map));
    CHECK_THROWS(InputError, force.load(std::numeric_limits<double>::infinity(), 0.1, map));
}

TEST(CuttingForce, many_turns_and_negative_angles_are_the_same_place) {
    Cutter cutter;
    cutter.helix_rad = 30.0 * degree;
    const CuttingForce force(cutter, steel, {});
    const EngagementMap map = uniform_engagement(0.3, 2.1, 3.0);
    for (const double angle : {0.0, 1.0, 3.0, 6.2}) {
        const CuttingLoad here = force.load(angle, 0.1, map);
        DOUBLES_EQUAL(here.fx_N, force.load(angle - 2.0 * pi, 0.1, map).fx_N, 1e-6);
        DOUBLES_EQUAL(here.fx_N, force.load(angle + 2000.0 * pi, 0.1, map).fx_N, 1e-6);
    }
    DOUBLES_EQUAL(force.load(0.0, 0.1, map).fx_N, force.load(-1e-17, 0.1, map).fx_N, 1e-6);
}

TEST(CuttingForce, depth_grows_without_steps) {
    Cutter cutter;
    cutter.helix_rad = 20.0 * degree;
    const CuttingForce force(cutter, steel, {});
    double before_Nm = 0.0;
    double largest_step_Nm = 0.0;
    for (int i = 1; i <= 500; ++i) {
        const EngagementMap map = uniform_engagement(0.0, pi, 0.01 * i);
        const double torque_Nm = force.load(1.2, 0.1, map).spindle_torque_Nm;
        CHECK(torque_Nm >= before_Nm);
        largest_step_Nm = std::max(largest_step_Nm, torque_Nm - before_Nm);
        before_Nm = torque_Nm;
    }
    CHECK(largest_step_Nm < 2.1 * before_Nm / 500.0);
}

TEST(CuttingForce, an_undercut_leaves_only_the_material_above_it) {
    const CuttingForce force(single_tooth(), steel, circular);
    const double whole_N = force.load(1.0, 0.1, uniform_engagement(0.5, 1.5, 6.0)).fx_N;
    const double lower_N = force.load(1.0, 0.1, uniform_engagement(0.5, 1.5, 2.5)).fx_N;
    const double upper_N = force.load(1.0, 0.1, disc(0.5, 1.5, 2.5, 6.0)).fx_N;
    DOUBLES_EQUAL(whole_N, lower_N + upper_N, 1e-9);
}

TEST(CuttingForce, material_that_differs_from_bin_to_bin_is_summed_bin_by_bin) {
    Cutter cutter = single_tooth();
    cutter.helix_rad = 40.0 * degree;
    cutter.flute_length_mm = 8.0;
    RandomNumbers random(23);
    EngagementMap map;
    for (std::size_t k = 100; k < 250; ++k) {
        const double bottom_mm = random.between(0.0, 3.0);
        map.bins[k] = {static_cast<float>(bottom_mm), static_cast<float>(random.between(bottom_mm - 1.0, 9.0)), 1.0F};
    }
    const double spindle_rad = 140.0 * degree;
    double expected_mm = 0.0;
    constexpr int steps = 800000;
    for (int i = 0; i < steps; ++i) {
        const double z = 8.0 * (i + 0.5) / steps;
        const double phi = spindle_rad - z * std::tan(40.0 * degree) / 5.0;
        const EngagementMap::Bin& bin = map.bins[static_cast<std::size_t>(phi / EngagementMap::bin_rad)];
        const bool in_cut =
            bin.covered > 0.0F && z >= static_cast<double>(bin.bottom_mm) && z < static_cast<double>(bin.top_mm);
        expected_mm += in_cut ? 8.0 / steps : 0.0;
    }
    DOUBLES_EQUAL(expected_mm, length_in_cut_mm(spindle_rad, cutter, map), 2e-3);
}

TEST(CuttingForce, pressure_rises_on_thin_chips_down_to_the_floor) {
    CuttingCoefficients coefficients{.K_tc_N_mm2 = 1000.0, .K_rc_N_mm2 = 400.0};
    coefficients.size_effect = {
        .tangential_exponent = -0.25, .radial_exponent = -0.4, .reference_mm = 0.1, .floor_mm = 0.01};
    const CuttingForce force(single_tooth(), coefficients, circular);
    const EngagementMap map = uniform_engagement(0.0, pi, 1.0);
    const auto pressures = [&](double h_mm) {
        const CuttingLoad load = force.load(pi / 2.0, h_mm, map);
        return std::pair{-load.fy_N / h_mm, load.fx_N / h_mm};
    };
    DOUBLES_EQUAL(1000.0, pressures(0.1).first, 1e-6);
    DOUBLES_EQUAL(400.0, pressures(0.1).second, 1e-6);
    DOUBLES_EQUAL(1000.0 * std::pow(0.5, -0.25), pressures(0.05).first, 1e-6);
    DOUBLES_EQUAL(400.0 * std::pow(0.5, -0.4), pressures(0.05).second, 1e-6);
    DOUBLES_EQUAL(pressures(0.01).first, pressures(0.001).first, 1e-6);
}

TEST(CuttingForce, inserts_under_a_lead_angle_thin_the_chip_and_press_along_the_axis) {
    Cutter shoulder = single_tooth();
    shoulder.type = CutterType::face_mill;
    Cutter inclined = shoulder;
    inclined.lead_angle_rad = 45.0 * degree;
    const CuttingCoefficients coefficients{.K_tc_N_mm2 = 1800.0, .K_rc_N_mm2 = 700.0, .K_te_N_mm = 20.0};
    const EngagementMap map = uniform_engagement(0.5, 2.5, 2.0);
    const CuttingLoad at_90 = CuttingForce(shoulder, coefficients, circular).load(pi / 2.0, 0.2, map);
    const CuttingLoad at_45 = CuttingForce(inclined, coefficients, circular).load(pi / 2.0, 0.2, map);
    // The section is the same; only the edge is longer.
    DOUBLES_EQUAL(at_90.fy_N - 20.0 * 2.0 * (std::sqrt(2.0) - 1.0), at_45.fy_N, 1e-9);
    DOUBLES_EQUAL(at_90.fx_N * std::sqrt(0.5), at_45.fx_N, 1e-9);
    DOUBLES_EQUAL(-at_90.fx_N * std::sqrt(0.5), at_45.fz_N, 1e-9);
    DOUBLES_EQUAL(1e-3 * 6.0, at_45.spindle_torque_Nm / -at_45.fy_N, 1e-9);  // at the mean radius, 6 mm
}

TEST(CuttingForce, a_ball_end_agrees_with_a_sum_over_its_sphere) {
    Cutter ball;
    ball.type = CutterType::ball_end_mill;
    ball.teeth = 2;
    ball.helix_rad = 30.0 * degree;
    const double depth_mm = 1.5;
    const double f_z = 0.05;
    const CuttingForce force(ball, steel, {.chip_model = ChipModel::circular, .resolution = {.axial_slices = 400}});
    const double theta = 1.9;
    const CuttingLoad load = force.load(theta, f_z, uniform_engagement(0.0, pi, depth_mm));
    double fx = 0.0;
    double fy = 0.0;
    double fz = 0.0;
    double torque = 0.0;
    constexpr int steps = 200000;
    const double arc = std::acos(1.0 - depth_mm / 5.0);
    for (int i = 0; i < steps; ++i) {
        const double kappa = arc * (i + 0.5) / steps;
        const double z = 5.0 * (1.0 - std::cos(kappa));
        const double phi = theta - z * std::tan(30.0 * degree) / 5.0;
        const double db = 5.0 * arc / steps;
        const double h = f_z * std::sin(phi) * std::sin(kappa);
        const double F_t = (steel.K_tc_N_mm2 * h + steel.K_te_N_mm) * db;
        const double F_r = (steel.K_rc_N_mm2 * h + steel.K_re_N_mm) * db;
        const double F_a = (steel.K_ac_N_mm2 * h + steel.K_ae_N_mm) * db;
        const double outward = F_r * std::sin(kappa) + F_a * std::cos(kappa);
        fx += F_t * std::cos(phi) + outward * std::sin(phi);
        fy += -F_t * std::sin(phi) + outward * std::cos(phi);
        fz += F_a * std::sin(kappa) - F_r * std::cos(kappa);
        torque += 1e-3 * F_t * 5.0 * std::sin(kappa);
    }
    const double size_N = std::hypot(fx, fy);
    DOUBLES_EQUAL(fx, load.fx_N, 1e-3 * size_N);
    DOUBLES_EQUAL(fy, load.fy_N, 1e-3 * size_N);
    DOUBLES_EQUAL(fz, load.fz_N, 1e-3 * size_N);
    DOUBLES_EQUAL(torque, load.spindle_torque_Nm, 1e-3 * torque);
    CHECK(load.fz_N < 0.0);
}

TEST(CuttingForce, a_ball_with_the_default_slices_is_within_one_percent) {
    Cutter ball;
    ball.type = CutterType::ball_end_mill;
    ball.teeth = 2;
    const CuttingForce coarse(ball, steel, {});
    const CuttingForce fine(ball, steel, {.resolution = {.axial_slices = 500}});
    for (const double depth_mm : {0.2, 1.0, 3.0}) {
        const EngagementMap map = uniform_engagement(0.3, 2.0, depth_mm);
        const RevolutionLoad a = revolution_load(coarse, 0.1, map);
        const RevolutionLoad b = revolution_load(fine, 0.1, map);
        DOUBLES_EQUAL(b.mean_torque_Nm, a.mean_torque_Nm, 0.01 * b.mean_torque_Nm);
        DOUBLES_EQUAL(b.peak_total_N, a.peak_total_N, 0.01 * b.peak_total_N);
    }
}

TEST(CuttingForce, coarse_and_fine_slices_agree) {
    Cutter cutter;
    cutter.helix_rad = 45.0 * degree;
    const CuttingForce coarse(cutter, steel, {});
    const CuttingForce fine(cutter, steel, {.resolution = {.axial_slices = 500}});
    const EngagementMap map = uniform_engagement(0.2, 1.3, 12.0);
    for (int i = 0; i < 200; ++i) {
        const CuttingLoad a = coarse.load(0.0314 * i, 0.1, map);
        const CuttingLoad b = fine.load(0.0314 * i, 0.1, map);
        const double tolerance_N = 5e-4 * std::hypot(b.fx_N, b.fy_N);
        DOUBLES_EQUAL(b.fx_N, a.fx_N, tolerance_N);
        DOUBLES_EQUAL(b.fy_N, a.fy_N, tolerance_N);
    }
}

TEST(CuttingForce, new_coefficients_take_effect_and_bad_ones_leave_the_old) {
    CuttingForce force(single_tooth(), steel, circular);
    const EngagementMap map = uniform_engagement(0.5, 1.5, 2.0);
    const double before_N = force.load(1.0, 0.1, map).fx_N;
    CHECK_THROWS(InputError, force.set_coefficients(CuttingCoefficients{}));
    DOUBLES_EQUAL(before_N, force.load(1.0, 0.1, map).fx_N, 0.0);
    CuttingCoefficients doubled = steel;
    doubled.K_tc_N_mm2 *= 2.0;
    force.set_coefficients(doubled);
    CHECK(force.load(1.0, 0.1, map).spindle_torque_Nm > 0.0);
    CHECK(force.load(1.0, 0.1, map).fx_N > before_N);
}
