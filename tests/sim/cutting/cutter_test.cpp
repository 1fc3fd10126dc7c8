// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "cutting/angle_units.hpp"
#include "cutting/cutter.hpp"
#include "cutting/cutting_coefficients.hpp"
#include "cutting/cutting_force.hpp"
#include "files/input_error.hpp"

using namespace millforce::host;
using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::string refusal_of(const Cutter& cutter) {
    try {
        validate(cutter);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_GROUP(Cutter){};

TEST(Cutter, the_default_is_valid) {
    STRCMP_EQUAL("", refusal_of(Cutter{}).c_str());
}

TEST(Cutter, bad_fields_are_refused_by_name_value_and_range) {
    Cutter cutter;
    cutter.teeth = 13;
    STRCMP_EQUAL("cutter.teeth: 13, expected 1 to 12", refusal_of(cutter).c_str());
    cutter = {};
    cutter.teeth = 0;
    STRCMP_CONTAINS("cutter.teeth: 0", refusal_of(cutter).c_str());
    cutter = {};
    cutter.diameter_mm = not_a_number;
    STRCMP_EQUAL("cutter.diameter_mm: nan, expected 0.1 to 1000", refusal_of(cutter).c_str());
    cutter = {};
    cutter.helix_rad = -0.1;
    STRCMP_CONTAINS("cutter.helix_rad: -0.1", refusal_of(cutter).c_str());
    cutter = {};
    cutter.runout_mm = std::numeric_limits<double>::infinity();
    STRCMP_CONTAINS("cutter.runout_mm: inf", refusal_of(cutter).c_str());
    cutter = {};
    cutter.lead_angle_rad = 45.0 * degree;
    STRCMP_CONTAINS("cutter.lead_angle_rad", refusal_of(cutter).c_str());  // only inserts have one
    cutter.type = CutterType::face_mill;
    STRCMP_EQUAL("", refusal_of(cutter).c_str());
}

TEST(Cutter, unequal_pitches_must_make_one_turn) {
    Cutter cutter;
    cutter.teeth = 3;
    cutter.tooth_pitch_rad = {1.9, 2.1, 2.0 * pi - 4.0};
    STRCMP_EQUAL("", refusal_of(cutter).c_str());
    DOUBLES_EQUAL(4.0, tooth_position_rad(cutter, 2), 1e-12);
    cutter.tooth_pitch_rad[2] = 2.0;
    STRCMP_CONTAINS("cutter.tooth_pitch_rad: the sum is 6", refusal_of(cutter).c_str());
}

TEST(Cutter, runout_turns_with_the_teeth_and_along_the_helix) {
    Cutter cutter;
    cutter.helix_rad = 30.0 * degree;
    cutter.runout_mm = 0.02;
    cutter.runout_angle_rad = 0.4;
    for (std::size_t k = 0; k < 4; ++k) {
        DOUBLES_EQUAL(0.02 * std::cos(0.4 - static_cast<double>(k) * pi / 2.0), runout_offset_mm(cutter, k, 0.0),
                      1e-12);
    }
    const double lag_rad = 6.0 * std::tan(30.0 * degree) / 5.0;
    DOUBLES_EQUAL(0.02 * std::cos(0.4 - lag_rad), runout_offset_mm(cutter, 0, 6.0), 1e-12);
}

TEST(Cutter, profile_of_inserts_and_of_a_ball) {
    Cutter inserts;
    inserts.type = CutterType::face_mill;
    inserts.lead_angle_rad = 45.0 * degree;
    DOUBLES_EQUAL(7.0, local_radius_mm(inserts, 2.0), 1e-12);
    Cutter ball;
    ball.type = CutterType::ball_end_mill;
    DOUBLES_EQUAL(3.0, local_radius_mm(ball, 1.0), 1e-12);
    DOUBLES_EQUAL(5.0, local_radius_mm(ball, 8.0), 0.0);
    DOUBLES_EQUAL(std::asin(0.6), local_lead_angle_rad(ball, 1.0), 1e-12);
    DOUBLES_EQUAL(pi / 2.0, local_lead_angle_rad(ball, 8.0), 0.0);
}

TEST(Cutter, bad_coefficients_and_resolutions_are_refused) {
    const CuttingCoefficients good{.K_tc_N_mm2 = 1000.0};
    CuttingCoefficients bad = good;
    bad.K_re_N_mm = not_a_number;
    CHECK_THROWS(InputError, CuttingForce(Cutter{}, bad));
    bad = good;
    bad.size_effect.floor_mm = 0.0;
    CHECK_THROWS(InputError, CuttingForce(Cutter{}, bad));
    CHECK_THROWS(InputError, CuttingForce(Cutter{}, CuttingCoefficients{}));
    CHECK_THROWS(InputError, CuttingForce(Cutter{}, good, {.resolution = {.axial_slices = 0}}));
    Cutter drill_like;
    drill_like.diameter_mm = 0.1;
    drill_like.flute_length_mm = 500.0;
    drill_like.helix_rad = 60.0 * degree;
    CHECK_THROWS(InputError, CuttingForce(drill_like, good));
    CHECK_THROWS(InputError, coefficients_at({.k_s = 1000.0}, 0.0));
}
