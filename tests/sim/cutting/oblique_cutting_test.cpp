// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "cutting/angle_units.hpp"
#include "cutting/oblique_cutting.hpp"
#include "files/input_error.hpp"
#include "random_numbers.hpp"

using namespace millforce::host;
using namespace millforce::sim;

namespace {

ObliqueCut random_oblique_cut(RandomNumbers& random) {
    return {.shear_stress_N_mm2 = random.between(200.0, 1200.0),
            .shear_angle_rad = random.between(15.0, 40.0) * degree,
            .friction_angle_rad = random.between(5.0, 40.0) * degree,
            .rake_rad = random.between(-8.0, 20.0) * degree,
            .inclination_rad = random.between(0.0, 55.0) * degree};
}

}  // namespace

TEST_GROUP(ObliqueCutting){};

TEST(ObliqueCutting, closed_form_agrees_with_the_resultant_form_of_guan) {
    RandomNumbers random(4711);
    for (int i = 0; i < 1000; ++i) {
        const ObliqueCut cut = random_oblique_cut(random);
        const double width_mm = random.between(0.01, 2.0);
        const double chip_mm = random.between(0.005, 0.3);
        const ObliqueForce force = oblique_force(cut, oblique_angles(cut), width_mm, chip_mm);
        const CuttingCoefficients K = oblique_cutting(cut);
        const double section_mm2 = width_mm * chip_mm;
        const double tolerance_N = 1e-9 * std::abs(force.cutting_N);
        DOUBLES_EQUAL(K.K_tc_N_mm2 * section_mm2, force.cutting_N, tolerance_N);
        DOUBLES_EQUAL(K.K_rc_N_mm2 * section_mm2, force.feed_N, tolerance_N);
        DOUBLES_EQUAL(-K.K_ac_N_mm2 * section_mm2, force.passive_N, tolerance_N);
    }
}

TEST(ObliqueCutting, any_other_shear_direction_needs_more_force) {
    RandomNumbers random(815);
    for (int i = 0; i < 200; ++i) {
        const ObliqueCut cut = random_oblique_cut(random);
        const ObliqueAngles along_force = oblique_angles(cut);
        ObliqueAngles aside = along_force;
        aside.phi_i_rad += random.between(1.0, 10.0) * degree * (i % 2 == 0 ? 1.0 : -1.0);
        CHECK(oblique_force(cut, aside, 1.0, 0.1).cutting_N > oblique_force(cut, along_force, 1.0, 0.1).cutting_N);
    }
}

TEST(ObliqueCutting, without_inclination_it_is_orthogonal_cutting) {
    const ObliqueCut cut{.shear_stress_N_mm2 = 600.0,
                         .shear_angle_rad = 28.0 * degree,
                         .friction_angle_rad = 24.0 * degree,
                         .rake_rad = 8.0 * degree,
                         .inclination_rad = 0.0};
    const CuttingCoefficients K = oblique_cutting(cut);
    const double resultant = 600.0 / (std::sin(28.0 * degree) * std::cos((28.0 + 24.0 - 8.0) * degree));
    DOUBLES_EQUAL(resultant * std::cos(16.0 * degree), K.K_tc_N_mm2, 1e-9);
    DOUBLES_EQUAL(resultant * std::sin(16.0 * degree), K.K_rc_N_mm2, 1e-9);
    DOUBLES_EQUAL(0.0, K.K_ac_N_mm2, 1e-9);
}

TEST(ObliqueCutting, the_resultant_lies_on_the_friction_cone_of_the_rake_face) {
    // An independent derivation: chip, rake face and edge as vectors. Cutting velocity v = x, feed normal f = y, axis
    // z.
    RandomNumbers random(99);
    for (int i = 0; i < 200; ++i) {
        const ObliqueCut cut = random_oblique_cut(random);
        const CuttingCoefficients K = oblique_cutting(cut);
        const double sin_i = std::sin(cut.inclination_rad);
        const double cos_i = std::cos(cut.inclination_rad);
        // The edge lags as it rises, e = (−sin i, 0, cos i); n is its normal in the plane of v and z.
        const double normal_part = K.K_tc_N_mm2 * cos_i + K.K_ac_N_mm2 * sin_i;
        const double edge_part = -K.K_tc_N_mm2 * sin_i + K.K_ac_N_mm2 * cos_i;
        const double cos_a = std::cos(cut.rake_rad);
        const double sin_a = std::sin(cut.rake_rad);
        // The rake face leans back by the rake; the chip climbs it away from the work (−y), friction holds it back.
        const double on_face_normal = normal_part * cos_a - K.K_rc_N_mm2 * sin_a;
        const double down_the_face = normal_part * sin_a + K.K_rc_N_mm2 * cos_a;
        const double friction = std::hypot(down_the_face, edge_part);
        DOUBLES_EQUAL(std::tan(cut.friction_angle_rad), friction / on_face_normal, 1e-9);
        // Stabler: the chip flows at η = i from the edge's normal, along the rising edge.
        DOUBLES_EQUAL(std::tan(cut.inclination_rad), -edge_part / down_the_face, 1e-9);
    }
}

TEST(ObliqueCutting, a_right_hand_helix_lifts_the_workpiece) {
    const ObliqueCut cut{.shear_stress_N_mm2 = 600.0,
                         .shear_angle_rad = 28.0 * degree,
                         .friction_angle_rad = 24.0 * degree,
                         .rake_rad = 8.0 * degree,
                         .inclination_rad = 30.0 * degree};
    CHECK(oblique_cutting(cut).K_ac_N_mm2 > 0.0);
}

TEST(ObliqueCutting, impossible_angles_are_refused_with_their_name) {
    ObliqueCut cut{.shear_stress_N_mm2 = 600.0,
                   .shear_angle_rad = 70.0 * degree,
                   .friction_angle_rad = 40.0 * degree,
                   .rake_rad = 0.0,
                   .inclination_rad = 0.0};
    CHECK_THROWS(InputError, oblique_cutting(cut));
    cut.shear_angle_rad = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS(InputError, oblique_cutting(cut));
    CHECK_THROWS(InputError, oblique_angles(cut));
}
