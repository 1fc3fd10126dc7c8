// SPDX-License-Identifier: Apache-2.0
#include "estimation/tooth_force/engagement_peaks_impl.hpp"

#include "estimation/cutting/peak_table_impl.hpp"
#include "estimation/engagement/engagement_solver_impl.hpp"
#include "estimation/four_flutes.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>

using namespace millforce::estimation;

namespace {

constexpr float feed_per_tooth_mm = 0.05F;

CuttingLaw<float> steel() {
    return linear_edge_law(1650.0F, 22.0F, 620.0F, 28.0F);
}

PeakFactorSettings<float> tool() {
    PeakFactorSettings<float> s = millforce::tests::peaks_of_four_flutes<float>();
    s.helix_rad = pi<float> / 6.0F;
    return s;
}

float depth_for(float tangential_N, float immersion) {
    constexpr float depth_mm = 1.0F;
    const CutConditions<float> cut{feed_per_tooth_mm, depth_mm, engagement_angles(CutSide::down, immersion), 4.0F};
    return tangential_N / average_forces(steel(), cut).tangential_N;
}

}  // namespace

TEST_GROUP(EngagementPeaks){};

TEST(EngagementPeaks, bound_the_tooth_of_any_cut_that_has_the_tangential_force_where_the_axis_forces_lie) {
    EngagementSolverSettings<float> settings = millforce::tests::solver_of_four_flutes<float>();
    settings.flute_length_mm = 22.0F;
    const EngagementSolver<float> solver(steel(), settings);
    EngagementPeaks<float> peaks(steel(), {.peak = tool(), .largest_depth_mm = 22.0F, .assumed_immersion = 1.0F});
    for (const float F_at_N : {100.0F, 300.0F, 600.0F}) {
        AverageForceMeasurement<float> m;
        m.tangential_N = {true, F_at_N, 25.0F};
        m.x_N = {true, 3.0F * F_at_N, 25.0F};  // no cut has such a force along the feed
        EngagementSolver<float>::Search search;
        solver.begin(search, m, feed_per_tooth_mm, CutSide::down);
        while (!solver.advance(search, 10)) {
        }
        peaks.take(search.estimate(), solver, F_at_N, feed_per_tooth_mm);
        while (peaks.search_due()) {
            peaks.search(solver);
        }
        float worst = 0.0F;
        for (float immersion = search.estimate().radial_immersion_low; immersion < 2.0F; immersion += 0.1F) {
            const float depth_mm = depth_for(F_at_N, immersion);
            worst = std::max(worst, peak_factors(steel(), tool(), immersion, depth_mm).tooth);
        }
        CHECK(peaks.factors().bound > 0.95F * worst);
        CHECK(peaks.factors().bound < 1.05F * worst);
    }
}
