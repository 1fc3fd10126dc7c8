// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

#include "cutting/angle_units.hpp"
#include "cutting/bottom_edge.hpp"
#include "cutting/cutting_force.hpp"
#include "files/input_error.hpp"

using namespace millforce::host;
using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;

BottomEdge edge_of_guan() {
    return {.shear_stress_N_mm2 = 500.0,
            .chip_compression = 1.8,
            .friction_angle_rad = 19.8 * degree,
            .rake_rad = 5.0 * degree,
            .width_mm = 0.5};
}

}  // namespace

TEST_GROUP(BottomEdge){};

TEST(BottomEdge, shear_angle_of_guan) {
    DOUBLES_EQUAL(30.2, orthogonal_shear_angle_rad(5.0 * degree, 1.8) / degree, 0.05);
}

TEST(BottomEdge, components_of_guans_68_newton) {
    const BottomEdgeForce force = orthogonal_components(edge_of_guan(), 68.0);
    DOUBLES_EQUAL(65.7, force.cutting_N, 0.05);  // published 65.6 and 17.5
    DOUBLES_EQUAL(17.4, force.thrust_N, 0.05);
}

TEST(BottomEdge, shear_force_on_the_shear_plane_is_stress_times_its_area) {
    const BottomEdge edge = edge_of_guan();
    const double section_mm2 = 0.04;
    const BottomEdgeForce force = orthogonal_components(edge, orthogonal_resultant_N(edge, section_mm2));
    const double phi_c = orthogonal_shear_angle_rad(edge.rake_rad, edge.chip_compression);
    const double along_shear_N = force.cutting_N * std::cos(phi_c) - force.thrust_N * std::sin(phi_c);
    DOUBLES_EQUAL(edge.shear_stress_N_mm2 * section_mm2 / std::sin(phi_c), along_shear_N, 1e-9);
}

TEST(BottomEdge, adds_to_the_flank_only_while_the_tip_is_in_cut_and_presses_down) {
    const CuttingCoefficients coefficients{.K_tc_N_mm2 = 1500.0, .K_rc_N_mm2 = 500.0};
    Cutter cutter;
    cutter.teeth = 1;
    const CuttingForce flank(cutter, coefficients, {});
    const CuttingForce both(cutter, coefficients, {.bottom_edge = edge_of_guan()});
    const EngagementMap map = uniform_engagement(60.0 * degree, 120.0 * degree, 2.0);
    const CuttingLoad one = flank.load(90.0 * degree, 0.1, map);
    const CuttingLoad two = both.load(90.0 * degree, 0.1, map);
    const BottomEdgeForce edge = orthogonal_components(
        edge_of_guan(), orthogonal_resultant_N(
                            edge_of_guan(), 0.5 * chip_thickness_mm(ChipModel::trochoidal,
                                                                    {5.0, 5.0, 0.1 / (2.0 * pi), 2.0 * pi}, 1.0, 0.0)));
    DOUBLES_EQUAL(-edge.cutting_N, two.fy_N - one.fy_N, 1e-9);
    DOUBLES_EQUAL(-edge.thrust_N, two.fz_N - one.fz_N, 1e-9);
    DOUBLES_EQUAL(1e-3 * edge.cutting_N * (5.0 - 0.25), two.spindle_torque_Nm - one.spindle_torque_Nm, 1e-9);
    DOUBLES_EQUAL(0.0, both.load(59.9 * degree, 0.1, map).fz_N, 0.0);

    EngagementMap raised = map;  // material begins above the tip
    for (EngagementMap::Bin& bin : raised.bins) {
        bin.bottom_mm = 0.5F;
    }
    const CuttingLoad above_tip = both.load(90.0 * degree, 0.1, raised);
    CHECK(above_tip.fx_N > 0.0);
    DOUBLES_EQUAL(flank.load(90.0 * degree, 0.1, raised).fy_N, above_tip.fy_N, 0.0);
    DOUBLES_EQUAL(0.0, above_tip.fz_N, 0.0);
}

TEST(BottomEdge, bad_values_are_refused) {
    BottomEdge edge = edge_of_guan();
    edge.width_mm = 6.0;
    CHECK_THROWS(InputError, validate(edge, 5.0));
    edge = edge_of_guan();
    edge.chip_compression = 0.5;
    CHECK_THROWS(InputError, validate(edge, 5.0));
}
