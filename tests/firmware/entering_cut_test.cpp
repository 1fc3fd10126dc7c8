// SPDX-License-Identifier: Apache-2.0
#include "firmware/entering_cut.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

#include "estimation/number/fixed_point.hpp"

using millforce::control::CutState;
using millforce::estimation::CutEstimate;
using millforce::estimation::CuttingLaw;
using millforce::estimation::Fixed;
using EnteringCut = millforce::firmware::EnteringCut<float>;

namespace {

constexpr float feed_per_tooth_mm = 0.018F;
constexpr float radius_mm = 5.0F;
constexpr float K_s = 1700.0F;
constexpr float r_1 = 0.4F;
constexpr float K_te = 22.0F;
constexpr float K_re = 28.0F;

template <typename Scalar>
CuttingLaw<Scalar> law() {
    CuttingLaw<Scalar> l;
    l.k_s_N_per_mm2 = Scalar(K_s);
    l.k_1 = Scalar(r_1);
    l.K_te_N_per_mm = Scalar(K_te);
    l.K_re_N_per_mm = Scalar(K_re);
    return l;
}

struct Forces {
    float tangential_N = 0.0F;
    float feed_N = 0.0F;
    float left_N = 0.0F;
};

/// Mean forces of four teeth, 6 mm deep, by a sum over the arc. `ahead_mm`: from the tool's axis to the straight face
/// that it enters.
Forces entering(float ahead_mm, float radial_immersion, bool is_up) {
    constexpr int parts = 720;
    constexpr float depth_mm = 6.0F;
    constexpr float per_part = 4.0F * depth_mm / (2.0F * parts);
    const float arc_rad = std::acos(1.0F - radial_immersion);
    Forces sum;
    for (int i = 0; i < parts; ++i) {
        const float phi = std::numbers::pi_v<float> * (static_cast<float>(i) + 0.5F) / parts;
        const bool is_in_arc = is_up ? phi < arc_rad : phi > std::numbers::pi_v<float> - arc_rad;
        if (!is_in_arc || radius_mm * std::sin(phi) < ahead_mm) {
            continue;
        }
        const float chip_mm = 2.0F * feed_per_tooth_mm * std::sin(phi);
        const float F_t = per_part * (K_s * chip_mm + K_te);
        const float F_r = per_part * (r_1 * K_s * chip_mm + K_re);
        sum.tangential_N += F_t;
        sum.feed_N += F_t * std::cos(phi) + F_r * std::sin(phi);
        sum.left_N += -F_t * std::sin(phi) + F_r * std::cos(phi);
    }
    return sum;
}

template <typename Scalar = float>
CutEstimate<Scalar> estimate_of(float tangential_N, float x_N, float y_N, float feed_x_mm_s = 4.0F,
                                float feed_y_mm_s = 4.0F) {
    CutEstimate<Scalar> e;
    e.tooth_periods = 1;
    e.tangential_N = {true, Scalar(tangential_N), Scalar(100), Scalar(50)};
    e.x_N = {true, Scalar(x_N), Scalar(60), Scalar(20)};
    e.y_N = {true, Scalar(y_N), Scalar(60), Scalar(20)};
    e.feed_x_mm_s = Scalar(feed_x_mm_s);
    e.feed_y_mm_s = Scalar(feed_y_mm_s);
    e.feed_mm_s = Scalar(std::hypot(feed_x_mm_s, feed_y_mm_s));
    return e;
}

/// A revolution of four teeth.
template <typename Scalar>
void turn(millforce::firmware::EnteringCut<Scalar>& cut, const CutEstimate<Scalar>& e) {
    for (int tooth = 0; tooth < 4; ++tooth) {
        cut.follow(e, CutState::entry);
    }
}

constexpr int revolutions = 20;

/// Through a straight face; `wrong` alters what the signals show.
template <typename Scalar = float, typename Wrong>
bool contradicts(float radial_immersion, bool is_up, Wrong wrong) {
    millforce::firmware::EnteringCut<Scalar> cut(law<Scalar>(), Scalar(feed_per_tooth_mm), 4);
    for (int k = 0; k <= revolutions; ++k) {
        const float ahead_mm = radius_mm * (1.0F - static_cast<float>(k) / revolutions);
        const Forces f = wrong(entering(ahead_mm, radial_immersion, is_up));
        turn(cut, estimate_of<Scalar>(f.tangential_N, f.feed_N, f.left_N));
    }
    return cut.contradicts();
}

Forces as_it_is(const Forces& f) {
    return f;
}
Forces with_friction(const Forces& f) {
    return {f.tangential_N, f.feed_N + 360.0F, f.left_N};
}
Forces saturated(const Forces& f) {
    return {std::fmin(f.tangential_N, 100.0F), f.feed_N, f.left_N};
}

}  // namespace

TEST_GROUP(EnteringCut){};

TEST(EnteringCut, is_one_cut_in_all_signals_whatever_its_width_and_side) {
    for (const float radial_immersion : {0.1F, 0.5F, 1.0F, 1.4F, 2.0F}) {
        CHECK_FALSE(contradicts(radial_immersion, false, as_it_is));
        CHECK_FALSE(contradicts(radial_immersion, true, as_it_is));
    }
}

TEST(EnteringCut, shows_an_axis_whose_friction_jumps_at_the_contact) {
    CHECK(contradicts(1.0F, false, with_friction));
    CHECK(contradicts(0.5F, true, with_friction));
}

TEST(EnteringCut, shows_a_spindle_current_that_stands_while_the_axes_go_on) {
    CHECK(contradicts(1.0F, false, saturated));
    CHECK(contradicts(2.0F, true, saturated));
}

TEST(EnteringCut, is_judged_alike_in_fixed_point) {
    CHECK_FALSE(contradicts<Fixed>(1.0F, false, as_it_is));
    CHECK(contradicts<Fixed>(1.0F, false, with_friction));
    CHECK(contradicts<Fixed>(1.0F, false, saturated));
}

TEST(EnteringCut, begins_from_the_new_forces_where_the_feed_turns) {
    EnteringCut cut(law<float>(), feed_per_tooth_mm, 4);
    for (int k = 0; k < revolutions; ++k) {
        turn(cut, estimate_of(200.0F, 200.0F, 0.0F, 5.0F, 0.0F));
    }
    for (int k = 0; k < revolutions; ++k) {
        turn(cut, estimate_of(200.0F, 0.0F, 200.0F, 0.0F, 5.0F));
    }
    CHECK_FALSE(cut.contradicts());
}

TEST(EnteringCut, begins_from_the_new_forces_where_the_cut_becomes_lighter) {
    EnteringCut cut(law<float>(), feed_per_tooth_mm, 4);
    for (const float tangential_N : {100.0F, 300.0F, 300.0F, 300.0F, 300.0F, 100.0F, 100.0F, 100.0F, 100.0F, 100.0F}) {
        turn(cut, estimate_of(tangential_N, 0.6F * tangential_N, -tangential_N));
    }
    CHECK_FALSE(cut.contradicts());
}

TEST(EnteringCut, does_not_ask_an_axis_that_has_begun_to_move) {
    EnteringCut cut(law<float>(), feed_per_tooth_mm, 4);
    CutEstimate<float> e = estimate_of(200.0F, 150.0F, 0.0F);
    e.y_N = {};
    for (int k = 0; k < revolutions; ++k) {
        turn(cut, e);
    }
    for (int k = 0; k < revolutions; ++k) {
        turn(cut, estimate_of(200.0F, 150.0F, -200.0F));
    }
    CHECK_FALSE(cut.contradicts());
}

TEST(EnteringCut, is_not_judged_where_the_load_comes_late) {
    EnteringCut cut(law<float>(), 0.0F, 4);
    for (int k = 0; k < revolutions; ++k) {
        turn(cut, estimate_of(0.0F, 500.0F, 0.0F));
    }
    CHECK_FALSE(cut.contradicts());
}

TEST(EnteringCut, stays_in_doubt_until_the_axes_are_found_sound_in_air) {
    EnteringCut cut(law<float>(), feed_per_tooth_mm, 4);
    turn(cut, estimate_of(0.0F, 0.0F, 0.0F));
    turn(cut, estimate_of(0.0F, 500.0F, 0.0F));
    CHECK(cut.contradicts());
    cut.follow(estimate_of(0.0F, 0.0F, 0.0F), CutState::air);
    CHECK(cut.contradicts());
    cut.clear();
    CHECK_FALSE(cut.contradicts());
}
