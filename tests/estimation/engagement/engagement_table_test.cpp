// SPDX-License-Identifier: Apache-2.0
#include "estimation/engagement/engagement_solver_impl.hpp"

#include "estimation/four_flutes.hpp"
#include "estimation/laws.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <initializer_list>

using namespace millforce::estimation;
using millforce::tests::carbide_in_SM45C;

namespace {

CuttingLaw<double> law_with_edges_and_doubt() {
    CuttingLaw<double> law = carbide_in_SM45C<double>();
    law.K_te_N_per_mm = 22.0;
    law.K_re_N_per_mm = 28.0;
    law.K_s_relative_sd = 0.1;
    law.K_s_exponent_sd = 0.02;
    law.r_1_relative_sd = 0.05;
    law.r_1_exponent_sd = 0.03;
    law.reference_chip_thickness_mm = 0.05;
    return law;
}

}  // namespace

TEST_GROUP(EngagementTable){};

TEST(EngagementTable, tells_the_forces_of_the_closed_law) {
    const auto law = law_with_edges_and_doubt();
    const EngagementSolver<double> solver(law, millforce::tests::solver_of_four_flutes<double>());
    for (const CutSide side : {CutSide::down, CutSide::up}) {
        const auto& table = solver.table(side);
        for (const double feed_mm : {0.01, 0.05, 0.3}) {
            const auto feed = table.feed(feed_mm);
            for (double theta = 0.25; theta <= 3.14; theta += 0.017) {
                const auto told = table.at(theta, feed);
                const auto exact = average_forces_with_doubt(
                    law, CutConditions<double>{feed_mm, 1.0, engagement_angles(side, 1.0 - std::cos(theta)), 4.0});
                const double scale = exact.mean.tangential_N;
                const double bound = theta < 0.5 ? 0.0015 : 0.0003;
                DOUBLES_EQUAL(1.0, told.tangential_N / scale, bound);
                DOUBLES_EQUAL(exact.mean.feed_N / scale, told.feed_N / scale, bound);
                DOUBLES_EQUAL(exact.mean.normal_N / scale, told.normal_N / scale, bound);
                DOUBLES_EQUAL(exact.per_ln_r_1.feed_N / scale, told.feed_per_ln_r_1_N / scale, bound);
                DOUBLES_EQUAL(exact.per_ln_r_1.normal_N / scale, told.normal_per_ln_r_1_N / scale, bound);
                DOUBLES_EQUAL(exact.per_ln_K_s.tangential_N / scale, told.cutting_tangential_N / scale, bound);
                const double ln_K_s_variance = table.doubt_of_K_s().variance_at(told.ln_t_in_references);
                const double ln_r_1_variance = table.doubt_of_r_1().variance_at(told.ln_t_in_references);
                DOUBLES_EQUAL(1.0, ln_K_s_variance / exact.coefficients.ln_K_s_variance, 0.002);
                DOUBLES_EQUAL(1.0, ln_r_1_variance / exact.coefficients.ln_r_1_variance, 0.002);
            }
        }
    }
}

TEST(EngagementTable, is_taken_at_its_end_beyond_it) {
    const EngagementSolver<double> solver(law_with_edges_and_doubt(),
                                          millforce::tests::solver_of_four_flutes<double>());
    const auto& table = solver.table(CutSide::down);
    const auto feed = table.feed(0.05);
    CHECK(table.at(-1.0, feed).tangential_N == table.at(0.2, feed).tangential_N);
    CHECK(table.at(9.0, feed).tangential_N == table.at(table.last_rad(), feed).tangential_N);
}

TEST(EngagementTable, a_solution_in_slices_is_the_solution_at_once) {
    const EngagementSolver<double> solver(law_with_edges_and_doubt(),
                                          millforce::tests::solver_of_four_flutes<double>());
    AverageForceMeasurement<double> forces;
    forces.tangential_N = {true, 250.0, 25.0};
    forces.x_N = {true, -120.0, 36.0};
    for (const CutSide side : {CutSide::down, CutSide::unknown}) {
        const auto at_once = solver.solve(forces, 0.05, side);
        CHECK(at_once.solved);
        for (const int steps : {1, 7}) {
            EngagementSolver<double>::Search search;
            solver.begin(search, forces, 0.05, side);
            int calls = 1;
            while (!solver.advance(search, steps)) {
                ++calls;
            }
            constexpr int most_of_a_side = 21 + 10 + 4;  // nodes scanned, valleys, and what follows
            CHECK(calls * steps <= (side == CutSide::unknown ? 2 : 1) * most_of_a_side + steps);
            CHECK(search.estimate().radial_immersion == at_once.radial_immersion);
            CHECK(search.estimate().axial_depth_sd_mm == at_once.axial_depth_sd_mm);
            CHECK(search.estimate().side == at_once.side);
        }
    }
}
