// SPDX-License-Identifier: Apache-2.0
#include "reproduce/fine_integration.hpp"
#include "reproduction_checks.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;

/// A slot with one material on the flank, no bottom edge.
FineCut slot(double helix_rad, double feed_per_tooth_mm) {
    const ShearedEdge edge{600.0, 0.5, 0.4, 0.1};
    return {4, 5.0, helix_rad, 2.0, feed_per_tooth_mm, 0.0, pi, edge, edge, 0.0};
}

}  // namespace

TEST_GROUP(Guan){};

TEST(Guan, every_figure_of_the_paper_and_every_promise_about_it_holds) {
    const Reproduction guan = reproduce_guan();
    millforce::test::check_reproduction(guan);
    LONGS_EQUAL(6, millforce::test::count_judged(guan.figures));
    LONGS_EQUAL(11, millforce::test::count_judged(guan.checks));
    LONGS_EQUAL(3, guan.plots.size());
    LONGS_EQUAL(5, guan.plots[0].series.size());
}

TEST(Guan, fine_integration_has_the_orthogonal_force_of_a_thin_chip_in_closed_form) {
    // Straight teeth, h → f_z sin φ: F_t per width = τ_s h cos(β − γ) / (sin φ_c cos(φ_c + β − γ)); mean torque of a
    // slot N a_p R f_z K/π.
    const FineCut cut = slot(0.0, 1e-4);
    const double K = 600.0 * std::cos(0.3) / (std::sin(0.5) * std::cos(0.8));
    const double torque_Nm = 1e-3 * 4.0 * 2.0 * 5.0 * 1e-4 * K / pi;
    DOUBLES_EQUAL(torque_Nm, fine_average(cut, 200, 4).torque_Nm, 1e-4 * torque_Nm);
}

TEST(Guan, fine_integration_does_not_change_with_finer_steps) {
    const FineCut cut = slot(0.9, 0.1);
    const FineForce coarse = fine_average(cut, 50, 25);
    const FineForce fine = fine_average(cut, 200, 100);
    const double size_N = std::hypot(fine.fx_N, fine.fy_N);
    DOUBLES_EQUAL(fine.fx_N, coarse.fx_N, 2e-4 * size_N);
    DOUBLES_EQUAL(fine.fy_N, coarse.fy_N, 2e-4 * size_N);
    DOUBLES_EQUAL(fine.fz_N, coarse.fz_N, 2e-4 * size_N);
}
