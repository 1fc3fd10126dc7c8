// SPDX-License-Identifier: Apache-2.0
#include "estimation/force_drop/force_drop_immersion.hpp"

#include "estimation/force_drop/face_mill_signal.hpp"
#include "host_test.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace millforce::estimation;
using millforce::tests::FaceMillSignal;

namespace {

using Immersion = ForceDropImmersion<float>;

FaceMillSignal milled(double immersion, CutSide side, double e_t_mm = 0.0, double e_r_mm = 0.0) {
    FaceMillSignal signal;
    const double theta = std::acos(1.0 - immersion);
    signal.entry_rad = side == CutSide::up ? 0.0 : std::numbers::pi - theta;
    signal.exit_rad = side == CutSide::up ? theta : std::numbers::pi;
    signal.e_t_mm = e_t_mm;
    signal.e_r_mm = e_r_mm;
    return signal;
}

/// Jump and mean as they are, each known within `sd_N`.
ForceDropMeasurement<float> measured(const FaceMillSignal& signal, CutSide side, double sd_N = 1.0) {
    const auto tooth = signal.tooth(side == CutSide::up ? signal.exit_rad : signal.entry_rad);
    const auto mean = signal.mean();
    const auto variance = static_cast<float>(sd_N * sd_N);
    ForceDropMeasurement<float> m;
    m.tooth_x_N = {true, static_cast<float>(tooth.x_N), variance, variance};
    m.tooth_y_N = {true, static_cast<float>(tooth.y_N), variance, variance};
    m.mean_x_N = {true, static_cast<float>(mean.x_N), variance / 100.0F, 0.0F};
    m.mean_y_N = {true, static_cast<float>(mean.y_N), variance / 100.0F, 0.0F};
    m.feed_per_tooth_mm = static_cast<float>(signal.feed_mm);
    m.teeth = static_cast<float>(signal.teeth);
    m.side = side;
    return m;
}

ForceDropLaw<float> exact_law(double e_t_mm = 0.0, double e_r_mm = 0.0) {
    ForceDropLaw<float> law;
    law.valid = true;
    law.largest_immersion = 0.95F;
    law.e_t_mm = static_cast<float>(e_t_mm);
    law.e_r_mm = static_cast<float>(e_r_mm);
    return law;
}

}  // namespace

TEST_GROUP(ForceDropImmersion){};

TEST(ForceDropImmersion, follows_from_exact_forces_in_up_and_down_milling) {
    for (const CutSide side : {CutSide::up, CutSide::down}) {
        for (const double immersion : {0.15, 0.2, 0.35, 0.5, 0.65, 0.8, 0.92}) {
            const auto estimate = Immersion(exact_law()).solve(measured(milled(immersion, side), side));
            CHECK(estimate.valid());
            DOUBLES_EQUAL(immersion, static_cast<double>(estimate.by_direction.immersion()), 0.004);
            DOUBLES_EQUAL(immersion, static_cast<double>(estimate.by_magnitude.immersion()), 0.002);
            DOUBLES_EQUAL(immersion, static_cast<double>(estimate.radial_immersion), 0.003);
            DOUBLES_EQUAL(0.4, static_cast<double>(estimate.r), 0.02);
        }
    }
}

TEST(ForceDropImmersion, is_right_with_the_edge_force_told_and_wrong_without) {
    const auto m = measured(milled(0.2, CutSide::up, 0.03, 0.04), CutSide::up);
    const auto told = Immersion(exact_law(0.03, 0.04)).solve(m);
    CHECK(told.valid());
    DOUBLES_EQUAL(0.2, static_cast<double>(told.radial_immersion), 0.003);
    const auto untold = Immersion(exact_law()).solve(m);
    CHECK(!untold.valid() || std::abs(static_cast<double>(untold.radial_immersion) - 0.2) > 0.02);
}

TEST(ForceDropImmersion, is_found_where_the_papers_iteration_would_diverge) {
    auto law = exact_law();
    law.a = 1.6F;  // r = 1.6 r_av − 0.24 holds at r = 0.4
    law.b = -0.24F;
    const auto estimate = Immersion(law).solve(measured(milled(0.5, CutSide::up), CutSide::up));
    CHECK(estimate.by_direction.valid);
    DOUBLES_EQUAL(0.5, static_cast<double>(estimate.by_direction.immersion()), 0.01);
}

TEST(ForceDropImmersion, does_not_depend_on_depth_or_pressure) {
    auto signal = milled(0.4, CutSide::up, 0.03, 0.03);
    const Immersion solver(exact_law(0.03, 0.03));
    const auto one = solver.solve(measured(signal, CutSide::up));
    signal.pressure_N_per_mm *= 2.5;
    const auto other = solver.solve(measured(signal, CutSide::up));
    DOUBLES_EQUAL(static_cast<double>(one.radial_immersion), static_cast<double>(other.radial_immersion), 1e-3);
}

HOST_TEST(ForceDropImmersion, errs_as_much_as_its_deviation_says) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal(0.0, 1.0);
    const Immersion solver(exact_law());
    int within_two = 0;
    constexpr int trials = 300;
    for (int trial = 0; trial < trials; ++trial) {
        auto m = measured(milled(0.35, CutSide::up), CutSide::up, 6.0);
        for (auto* force : {&m.tooth_x_N, &m.tooth_y_N, &m.mean_x_N, &m.mean_y_N}) {
            force->value += static_cast<float>(normal(random) * std::sqrt(static_cast<double>(force->variance)));
        }
        const auto estimate = solver.solve(m);
        const double error = static_cast<double>(estimate.radial_immersion) - 0.35;
        within_two += std::abs(error) <= 2.0 * static_cast<double>(estimate.radial_immersion_sd) ? 1 : 0;
    }
    CHECK(within_two >= trials * 91 / 100);
    CHECK(within_two <= trials * 99 / 100);
}

TEST(ForceDropImmersion, doubts_more_where_forces_are_known_less) {
    const auto signal = milled(0.5, CutSide::up);
    const Immersion solver(exact_law());
    const auto sharp = solver.solve(measured(signal, CutSide::up, 1.0));
    const auto blurred = solver.solve(measured(signal, CutSide::up, 4.0));
    DOUBLES_EQUAL(4.0, static_cast<double>(blurred.radial_immersion_sd / sharp.radial_immersion_sd), 0.2);
    const auto useless = solver.solve(measured(signal, CutSide::up, 120.0));
    CHECK_FALSE(useless.valid());
}

TEST(ForceDropImmersion, gives_no_estimate_without_law_side_or_forces) {
    using Reason = ForceDropEstimate<float>::Reason;
    auto m = measured(milled(0.5, CutSide::up), CutSide::up);
    CHECK(Immersion().solve(m).reason == Reason::no_law);
    m.side = CutSide::unknown;
    CHECK(Immersion(exact_law()).solve(m).reason == Reason::side_unknown);
    m.side = CutSide::up;
    m.mean_y_N.valid = false;
    CHECK(Immersion(exact_law()).solve(m).reason == Reason::no_drop);
}

TEST(ForceDropImmersion, gives_no_estimate_where_direction_and_size_of_the_drop_disagree) {
    auto m = measured(milled(0.5, CutSide::up), CutSide::up);
    m.tooth_x_N.value *= 1.3F;
    m.tooth_y_N.value *= 1.3F;
    CHECK(Immersion(exact_law()).solve(m).reason == ForceDropEstimate<float>::Reason::disagreement);
}

TEST(ForceDropImmersion, gives_no_estimate_for_forces_that_no_immersion_makes) {
    auto m = measured(milled(0.5, CutSide::up), CutSide::up);
    m.mean_x_N.value = -m.mean_x_N.value;
    m.mean_y_N.value = -m.mean_y_N.value;
    CHECK(Immersion(exact_law()).solve(m).reason == ForceDropEstimate<float>::Reason::no_root);
}
