// SPDX-License-Identifier: Apache-2.0
#include "estimation/tooth_force/tooth_force_impl.hpp"

#include "estimation/cutting/peak_table_impl.hpp"
#include "estimation/engagement/engagement_solver_impl.hpp"
#include "estimation/four_flutes.hpp"
#include "estimation/tooth_force/engagement_peaks_impl.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace millforce::estimation;

namespace {

constexpr float feed_per_tooth_mm = 0.05F;
constexpr float flutes_mm = 22.0F;

CuttingLaw<float> steel() {
    return linear_edge_law(1650.0F, 22.0F, 620.0F, 28.0F);
}

EngagementPeaks<float>::Settings tool() {
    PeakFactorSettings<float> peak = millforce::tests::peaks_of_four_flutes<float>();
    peak.helix_rad = pi<float> / 6.0F;
    return {.peak = peak, .largest_depth_mm = flutes_mm, .assumed_immersion = 1.0F};
}

EngagementEstimate<float> narrow_and_shallow() {
    EngagementEstimate<float> found;
    found.solved = found.immersion_valid = found.depth_valid = true;
    found.radial_immersion = found.radial_immersion_low = found.radial_immersion_high = 0.1F;
    found.engagement_rad = found.engagement_low_rad = found.engagement_high_rad = std::acos(0.9F);
    found.axial_depth_mm = found.depth_at_low_mm = found.depth_at_high_mm = 1.0F;
    found.side = CutSide::down;
    return found;
}

}  // namespace

/// A cut of which F_at alone is known.
TEST_GROUP(ToothForce) {
    EngagementSolver<float> solver{steel(), millforce::tests::solver_of_four_flutes<float>()};
    EngagementPeaks<float> peaks{steel(), tool()};
    CutEstimate<float> e;

    void set_tangential_N(float tangential_N) {
        e.tangential_N = e.steady_tangential_N = {true, tangential_N, 1.0F, 1.0F};
        e.newest_tangential_N = tangential_N;
        e.feed_per_tooth_mm = feed_per_tooth_mm;
        peaks.take(e.engagement, solver, tangential_N, feed_per_tooth_mm);
        while (peaks.search_due()) {
            peaks.search(solver);
        }
        ToothForce<float> tooth_force(millforce::tests::estimator_of_four_flutes<float>(), steel());
        tooth_force.fill(e, peaks, solver.table(CutSide::down), 0.0F);
    }
};

TEST(ToothForce, without_an_immersion_is_that_of_the_worst_cut_with_its_tangential_force) {
    set_tangential_N(100.0F);
    CHECK(e.tooth_force_is_bound);
    CHECK(peaks.factors().bound > 1.1F * peaks.factors().now);
    DOUBLES_EQUAL(static_cast<double>(e.newest_tangential_N * peaks.factors().bound),
                  static_cast<double>(e.tooth_force_N.value), 1e-3);
}

TEST(ToothForce, without_an_immersion_is_no_smaller_than_at_the_last_one) {
    peaks.take(narrow_and_shallow(), solver, 100.0F, feed_per_tooth_mm);
    set_tangential_N(600.0F);
    CHECK(e.tooth_force_is_bound);
    CHECK(peaks.factors().now > 1.1F * peaks.factors().bound);
    DOUBLES_EQUAL(static_cast<double>(e.newest_tangential_N * peaks.factors().now),
                  static_cast<double>(e.tooth_force_N.value), 1e-3);
}

/// The long edge of a narrow and deep cut comes in bit by bit.
TEST(ToothForce, is_certain_as_far_as_the_narrowest_cut_of_the_interval_makes_it_where_that_is_deep) {
    e.engagement = narrow_and_shallow();
    e.engagement.depth_at_low_mm = flutes_mm;
    e.engagement.radial_immersion_high = 1.0F;
    e.engagement.engagement_high_rad = 0.5F * pi<float>;
    set_tangential_N(100.0F);
    CHECK(peaks.factors().at_low < 0.7F * peaks.factors().at_high);
    DOUBLES_EQUAL(static_cast<double>(e.newest_tangential_N * peaks.factors().at_low),
                  static_cast<double>(e.certain_tooth_force_N), 1e-3);
}

TEST(ToothForce, is_certain_as_far_as_the_widest_cut_of_the_interval_makes_it) {
    e.engagement = narrow_and_shallow();
    e.engagement.engagement_low_rad = 0.5F * e.engagement.engagement_rad;
    e.engagement.engagement_high_rad = 2.0F * e.engagement.engagement_rad;
    e.engagement.radial_immersion_low = 1.0F - std::cos(e.engagement.engagement_low_rad);
    e.engagement.radial_immersion_high = 1.0F - std::cos(e.engagement.engagement_high_rad);
    set_tangential_N(100.0F);
    CHECK(e.certain_tooth_force_N > e.least_tooth_force_N);
    CHECK(e.certain_tooth_force_N < 0.7F * e.tooth_force_N.value);
}
