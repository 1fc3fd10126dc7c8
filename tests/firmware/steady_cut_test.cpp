// SPDX-License-Identifier: Apache-2.0
#include "firmware/steady_cut_impl.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using millforce::estimation::CutEstimate;
using millforce::estimation::Measurement;
using SteadyCut = millforce::firmware::SteadyCut<float>;

namespace {

constexpr int settled = 16;
constexpr float drift_N_per_s = 60.0F;
constexpr float tooth_period_s = 0.01F;

Measurement<float> force(float value_N) {
    return {true, value_N, 1.0F, 1.0F};
}

/// A cut whose tooth force is twice F_at, and four times the force along the feed.
CutEstimate<float> cut_of(float tangential_N, float feed_N) {
    CutEstimate<float> e;
    e.tangential_N = force(tangential_N);
    e.feed_N = force(feed_N);
    e.tooth_force_N = force(2.0F * tangential_N);
    e.feed_per_tooth_mm = 0.1F;
    e.tooth_periods = 1;
    e.engagement.immersion_valid = true;
    e.engagement.radial_immersion = 0.5F;
    e.engagement.radial_immersion_sd = 0.05F;
    e.engagement.depth_valid = true;
    e.engagement.axial_depth_mm = 5.0F;
    return e;
}

/// As a spindle current that reads too little makes it look: a narrower and deeper cut with a smaller force.
CutEstimate<float> cut_with_drift(float tangential_N, float feed_N) {
    CutEstimate<float> e = cut_of(tangential_N, feed_N);
    e.engagement.radial_immersion = 0.3F;
    e.engagement.axial_depth_mm = 8.0F;
    return e;
}

/// A cut of the same depth and F_at, whose width makes the force on a tooth smaller by `factor`.
CutEstimate<float> wider(float factor, float feed_N = 150.0F) {
    CutEstimate<float> e = cut_of(300.0F, feed_N);
    e.tooth_force_N.value /= factor;
    e.engagement.radial_immersion *= factor;
    return e;
}

float per_root_feed(const CutEstimate<float>& e) {
    return e.feed_per_tooth_mm > 0.0F ? 1.0F / std::sqrt(e.feed_per_tooth_mm) : 0.0F;
}

void follow(SteadyCut& cut, const CutEstimate<float>& e, int times) {
    for (int k = 0; k < times; ++k) {
        cut.follow(e, per_root_feed(e), tooth_period_s);
    }
}

SteadyCut in_steady_cut() {
    SteadyCut cut(drift_N_per_s);
    follow(cut, cut_of(300.0F, 150.0F), 2 * settled);
    return cut;
}

double largest_N(const SteadyCut& cut, const CutEstimate<float>& e) {
    return static_cast<double>(cut.largest_force_N(e, e.tooth_force_N.value));
}

}  // namespace

TEST_GROUP(SteadyCut){};

TEST(SteadyCut, leaves_the_force_of_a_cut_that_does_not_change) {
    DOUBLES_EQUAL(600.0, largest_N(in_steady_cut(), cut_of(300.0F, 150.0F)), 1e-3);
}

TEST(SteadyCut, takes_the_force_by_the_axes_where_the_spindles_current_drifts) {
    SteadyCut cut = in_steady_cut();
    follow(cut, cut_with_drift(240.0F, 150.0F), 2 * settled);
    DOUBLES_EQUAL(600.0, largest_N(cut, cut_with_drift(240.0F, 150.0F)), 1e-3);
    DOUBLES_EQUAL(640.0, largest_N(cut, cut_with_drift(240.0F, 160.0F)), 1e-3);
}

TEST(SteadyCut, takes_the_force_by_the_spindle_where_an_axis_current_drifts) {
    SteadyCut cut = in_steady_cut();
    CutEstimate<float> e = cut_with_drift(300.0F, 90.0F);
    e.tooth_force_N.value = 400.0F;
    follow(cut, e, 2 * settled);
    DOUBLES_EQUAL(600.0, largest_N(cut, e), 1e-3);
}

TEST(SteadyCut, leaves_the_force_of_a_ramp_and_of_a_wall_that_converges) {
    SteadyCut ramp = in_steady_cut();
    CutEstimate<float> deeper = cut_of(340.0F, 200.0F);
    deeper.engagement.axial_depth_mm = 6.0F;
    follow(ramp, deeper, 4 * settled);
    DOUBLES_EQUAL(680.0, largest_N(ramp, deeper), 1e-3);

    SteadyCut wall = in_steady_cut();
    CutEstimate<float> narrower = cut_of(260.0F, 150.0F);
    narrower.engagement.radial_immersion = 0.3F;
    follow(wall, narrower, 4 * settled);
    DOUBLES_EQUAL(520.0, largest_N(wall, narrower), 1e-3);
    CHECK_FALSE(wall.has_question());
}

TEST(SteadyCut, asks_whether_a_width_that_makes_the_tooth_force_smaller_is_a_drift) {
    SteadyCut cut = in_steady_cut();
    follow(cut, wider(1.1F), 4 * settled);
    CHECK_FALSE(cut.has_question());
    follow(cut, wider(1.3F), 4 * settled);
    CHECK_TRUE(cut.has_question());
    DOUBLES_EQUAL(wider(1.3F).tooth_force_N.value, largest_N(cut, wider(1.3F)), 1e-3);
}

TEST(SteadyCut, doubts_the_width_where_the_answer_is_a_drift_and_begins_anew_where_it_is_none) {
    SteadyCut drifted = in_steady_cut();
    follow(drifted, wider(1.3F), 4 * settled);
    SteadyCut sound = drifted;
    drifted.take_answer(false);
    follow(drifted, wider(1.3F), settled);
    CHECK_TRUE(drifted.is_doubtful());
    DOUBLES_EQUAL(600.0, largest_N(drifted, wider(1.3F)), 1e-3);

    sound.take_answer(true);
    follow(sound, wider(1.3F), 1);
    CHECK_TRUE(sound.begins());
    follow(sound, wider(1.3F), 2 * settled);
    CHECK_FALSE(sound.has_question());
    CHECK_FALSE(sound.is_doubtful());
}

TEST(SteadyCut, asks_nothing_of_a_cut_that_is_in_doubt_already_has_kept_its_width_or_has_no_known_force) {
    CutEstimate<float> in_doubt = cut_with_drift(300.0F, 90.0F);
    in_doubt.tooth_force_N.value = 400.0F;
    CutEstimate<float> as_wide = wider(1.0F);
    as_wide.tooth_force_N.value = 400.0F;
    CutEstimate<float> unknown = wider(1.5F);
    unknown.tooth_force_N.valid = false;
    for (const CutEstimate<float>& e : {in_doubt, as_wide, unknown}) {
        SteadyCut cut = in_steady_cut();
        follow(cut, e, 4 * settled);
        CHECK_FALSE(cut.has_question());
    }
}

TEST(SteadyCut, doubts_no_width_that_is_as_it_was_though_the_answer_is_a_drift) {
    SteadyCut unmoved = in_steady_cut();
    unmoved.take_answer(false);
    CHECK_FALSE(unmoved.is_doubtful());

    SteadyCut back = in_steady_cut();
    follow(back, wider(1.3F), 4 * settled);
    back.take_answer(false);
    follow(back, wider(1.3F), 1);
    CHECK_TRUE(back.is_doubtful());
    follow(back, wider(1.0F), 4 * settled);
    CHECK_FALSE(back.is_doubtful());
}

TEST(SteadyCut, keeps_its_doubt_of_a_cut_where_a_force_changes_faster_than_a_current_can_drift) {
    SteadyCut cut = in_steady_cut();
    follow(cut, cut_with_drift(240.0F, 150.0F), 2 * settled);
    const CutEstimate<float> fast = cut_with_drift(240.0F, 350.0F);
    follow(cut, fast, 4 * settled);
    CHECK_TRUE(cut.is_doubtful());
    DOUBLES_EQUAL(4.0 * 350.0, largest_N(cut, fast), 1e-2);
}

TEST(SteadyCut, asks_nothing_about_a_force_that_changes_faster_than_a_current_can_drift) {
    const CutEstimate<float> slowly = wider(1.3F, 140.0F);
    const CutEstimate<float> fast = wider(1.3F, 300.0F);
    SteadyCut cut = in_steady_cut();
    follow(cut, slowly, 60);
    CHECK_TRUE(cut.has_question());
    cut = in_steady_cut();
    follow(cut, fast, 60);
    CHECK_FALSE(cut.has_question());

    SteadyCut of_unknown_drift(0.0F);
    follow(of_unknown_drift, cut_of(300.0F, 150.0F), 2 * settled);
    follow(of_unknown_drift, fast, 60);
    CHECK_TRUE(of_unknown_drift.has_question());
}

TEST(SteadyCut, is_not_misled_by_an_immersion_that_is_hardly_known) {
    SteadyCut cut = in_steady_cut();
    CutEstimate<float> e = cut_with_drift(240.0F, 150.0F);
    e.engagement.radial_immersion_sd = 0.3F;
    e.engagement.radial_immersion = 1.5F;
    follow(cut, e, 4 * settled);
    DOUBLES_EQUAL(480.0, largest_N(cut, e), 1e-3);
}

TEST(SteadyCut, begins_anew_where_both_forces_change_at_once) {
    SteadyCut cut = in_steady_cut();
    const CutEstimate<float> other = cut_with_drift(200.0F, 110.0F);
    for (int k = 0; k < 4 * settled; ++k) {
        cut.follow(other, per_root_feed(other), tooth_period_s);
        DOUBLES_EQUAL(400.0, largest_N(cut, other), 1e-3);
    }
}

TEST(SteadyCut, takes_a_jump_of_one_current_for_no_other_cut) {
    SteadyCut cut = in_steady_cut();
    follow(cut, cut_with_drift(200.0F, 150.0F), 2 * settled);
    DOUBLES_EQUAL(600.0, largest_N(cut, cut_with_drift(200.0F, 150.0F)), 1e-3);

    SteadyCut pulled(drift_N_per_s);  // along the feed by the cut
    follow(pulled, cut_of(300.0F, -150.0F), 2 * settled);
    follow(pulled, cut_with_drift(200.0F, -150.0F), 2 * settled);
    DOUBLES_EQUAL(600.0, largest_N(pulled, cut_with_drift(200.0F, -150.0F)), 1e-3);
}

TEST(SteadyCut, lowers_no_force) {
    SteadyCut cut = in_steady_cut();
    CutEstimate<float> e = cut_with_drift(240.0F, 150.0F);
    follow(cut, e, 2 * settled);
    e.tooth_force_N.value = 900.0F;
    DOUBLES_EQUAL(900.0, largest_N(cut, e), 1e-3);
}

TEST(SteadyCut, says_nothing_by_a_force_that_is_not_known) {
    SteadyCut cut = in_steady_cut();
    const CutEstimate<float> drifted = cut_with_drift(240.0F, 150.0F);
    follow(cut, drifted, 2 * settled);
    CutEstimate<float> without_spindle = drifted;
    without_spindle.tangential_N.valid = false;
    DOUBLES_EQUAL(480.0, largest_N(cut, without_spindle), 1e-3);
    CutEstimate<float> without_axes = drifted;
    without_axes.feed_N.valid = false;
    DOUBLES_EQUAL(480.0, largest_N(cut, without_axes), 1e-3);
}

TEST(SteadyCut, does_not_follow_an_estimate_that_is_not_whole) {
    const CutEstimate<float> drifted = cut_with_drift(240.0F, 150.0F);
    CutEstimate<float> without_immersion = drifted;
    without_immersion.engagement.immersion_valid = false;
    CutEstimate<float> without_depth = drifted;
    without_depth.engagement.depth_valid = false;
    CutEstimate<float> without_axes = drifted;
    without_axes.feed_N.valid = false;
    for (const CutEstimate<float>& e : {without_immersion, without_depth, without_axes}) {
        SteadyCut cut = in_steady_cut();
        follow(cut, e, 2 * settled);
        DOUBLES_EQUAL(480.0, largest_N(cut, drifted), 1e-3);
    }
}

TEST(SteadyCut, is_not_begun_anew_by_an_estimate_without_force_or_feed) {
    const CutEstimate<float> drifted = cut_with_drift(240.0F, 150.0F);
    CutEstimate<float> without_feed = drifted;
    without_feed.feed_per_tooth_mm = 0.0F;
    for (const CutEstimate<float>& e : {cut_of(0.0F, 0.0F), without_feed}) {
        SteadyCut cut = in_steady_cut();
        follow(cut, e, 1);
        follow(cut, drifted, 2 * settled);
        DOUBLES_EQUAL(600.0, largest_N(cut, drifted), 1e-3);
    }
}

TEST(SteadyCut, begins_with_a_tooth_force_that_is_known) {
    const CutEstimate<float> drifted = cut_with_drift(240.0F, 150.0F);
    CutEstimate<float> unknown = cut_of(300.0F, 150.0F);
    unknown.tooth_force_N.valid = false;
    CutEstimate<float> bound = cut_of(300.0F, 150.0F);
    bound.tooth_force_is_bound = true;
    for (const CutEstimate<float>& e : {unknown, bound}) {
        SteadyCut cut(drift_N_per_s);
        follow(cut, e, 2 * settled);
        follow(cut, drifted, 2 * settled);
        DOUBLES_EQUAL(480.0, largest_N(cut, drifted), 1e-3);
    }
}

TEST(SteadyCut, knows_nothing_of_a_cut_before_its_first_estimates) {
    SteadyCut cut(drift_N_per_s);
    follow(cut, cut_of(300.0F, 150.0F), settled - 1);
    follow(cut, cut_with_drift(240.0F, 150.0F), settled);
    DOUBLES_EQUAL(480.0, largest_N(cut, cut_with_drift(240.0F, 150.0F)), 1e-3);
}

TEST(SteadyCut, keeps_its_doubt_out_of_the_cut_until_the_currents_are_found_sound) {
    SteadyCut cut = in_steady_cut();
    follow(cut, cut_with_drift(240.0F, 150.0F), 2 * settled);
    cut.leave_cut();
    follow(cut, cut_with_drift(240.0F, 150.0F), 2 * settled);
    DOUBLES_EQUAL(600.0, largest_N(cut, cut_with_drift(240.0F, 150.0F)), 1e-3);
    cut.clear();
    DOUBLES_EQUAL(480.0, largest_N(cut, cut_with_drift(240.0F, 150.0F)), 1e-3);
}

TEST(SteadyCut, forgets_a_cut_without_doubt_at_its_end) {
    SteadyCut cut = in_steady_cut();
    cut.leave_cut();
    follow(cut, cut_with_drift(240.0F, 150.0F), 2 * settled);
    DOUBLES_EQUAL(480.0, largest_N(cut, cut_with_drift(240.0F, 150.0F)), 1e-3);
}

TEST(SteadyCut, does_not_mix_a_cut_with_the_one_before) {
    SteadyCut cut = in_steady_cut();
    cut.leave_cut();
    CutEstimate<float> e = cut_of(300.0F, 150.0F);
    e.engagement.radial_immersion = 0.2F;
    e.engagement.axial_depth_mm = 12.0F;
    follow(cut, e, 4 * settled);
    e.feed_N.value = 170.0F;
    DOUBLES_EQUAL(600.0, largest_N(cut, e), 1e-3);
}

TEST(SteadyCut, is_not_misled_by_a_feed_force_that_is_lost_in_its_noise) {
    SteadyCut cut(drift_N_per_s);
    CutEstimate<float> e = cut_of(300.0F, 0.5F);  // standard deviation 1 N
    follow(cut, e, 2 * settled);
    follow(cut, cut_with_drift(240.0F, 2.0F), 2 * settled);
    DOUBLES_EQUAL(480.0, largest_N(cut, cut_with_drift(240.0F, 2.0F)), 1e-3);
}
