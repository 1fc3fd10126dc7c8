// SPDX-License-Identifier: Apache-2.0
#include "firmware/steady_cut_impl.hpp"

#include <CppUTest/TestHarness.h>

using millforce::estimation::CutEstimate;
using millforce::estimation::Measurement;
using SteadyCut = millforce::firmware::SteadyCut<float>;

namespace {

constexpr int settled = 16;

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

void follow(SteadyCut& cut, const CutEstimate<float>& e, int times) {
    for (int k = 0; k < times; ++k) {
        cut.follow(e);
    }
}

SteadyCut in_steady_cut() {
    SteadyCut cut;
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
    CutEstimate<float> deeper = cut_of(340.0F, 170.0F);
    deeper.engagement.axial_depth_mm = 6.0F;
    follow(ramp, deeper, 4 * settled);
    DOUBLES_EQUAL(680.0, largest_N(ramp, deeper), 1e-3);

    SteadyCut wall = in_steady_cut();
    CutEstimate<float> narrower = cut_of(260.0F, 150.0F);
    narrower.engagement.radial_immersion = 0.3F;
    follow(wall, narrower, 4 * settled);
    DOUBLES_EQUAL(520.0, largest_N(wall, narrower), 1e-3);
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
    follow(cut, cut_with_drift(200.0F, 100.0F), 4 * settled);
    DOUBLES_EQUAL(400.0, largest_N(cut, cut_with_drift(200.0F, 100.0F)), 1e-3);
}

TEST(SteadyCut, knows_nothing_of_a_cut_before_its_first_estimates) {
    SteadyCut cut;
    follow(cut, cut_of(300.0F, 150.0F), settled - 1);
    follow(cut, cut_with_drift(240.0F, 150.0F), settled);
    DOUBLES_EQUAL(480.0, largest_N(cut, cut_with_drift(240.0F, 150.0F)), 1e-3);
}

TEST(SteadyCut, keeps_its_doubt_out_of_the_cut_until_the_currents_are_found_sound) {
    SteadyCut cut = in_steady_cut();
    follow(cut, cut_with_drift(240.0F, 150.0F), 2 * settled);
    cut.leave_cut();
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

TEST(SteadyCut, is_not_misled_by_a_feed_force_that_is_lost_in_its_noise) {
    SteadyCut cut;
    CutEstimate<float> e = cut_of(300.0F, 0.5F);  // standard deviation 1 N
    follow(cut, e, 2 * settled);
    follow(cut, cut_with_drift(240.0F, 2.0F), 2 * settled);
    DOUBLES_EQUAL(480.0, largest_N(cut, cut_with_drift(240.0F, 2.0F)), 1e-3);
}
