// SPDX-License-Identifier: Apache-2.0
#include "estimation/engagement/engagement_solver_impl.hpp"

#include "estimation/four_flutes.hpp"
#include "estimation/laws.hpp"
#include "host_test.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace millforce::estimation;
using millforce::tests::carbide_in_SM45C;

namespace {

struct Cut {
    CutSide side = CutSide::down;
    double immersion = 0.5;
    double depth_mm = 6.0;
    double feed_per_tooth_mm = 0.05;
    double direction_rad = 0.0;
    bool y_moves = false;
    double centre_offset_in_radii = 0.0;
};

AverageForces<double> true_forces(const Cut& cut, const CuttingLaw<double>& law) {
    const auto angles = engagement_angles(cut.side, cut.immersion, cut.centre_offset_in_radii);
    return average_forces(law, {cut.feed_per_tooth_mm, cut.depth_mm, angles, 4.0});
}

/// What the drives show of a cut, with noise of the given deviation on each force.
AverageForceMeasurement<double> measured(const Cut& cut, double sd_N, std::mt19937* random = nullptr) {
    const auto forces = true_forces(cut, carbide_in_SM45C<double>());
    std::normal_distribution<double> normal(0.0, sd_N);
    const auto noisy = [&](double value) { return value + (random != nullptr ? normal(*random) : 0.0); };
    AverageForceMeasurement<double> m;
    m.feed_direction_x = std::cos(cut.direction_rad);
    m.feed_direction_y = std::sin(cut.direction_rad);
    const double x = m.feed_direction_x * forces.feed_N - m.feed_direction_y * forces.normal_N;
    const double y = m.feed_direction_y * forces.feed_N + m.feed_direction_x * forces.normal_N;
    m.tangential_N = {true, noisy(forces.tangential_N), sd_N * sd_N};
    m.x_N = {true, noisy(x), sd_N * sd_N};
    m.y_N = {cut.y_moves, noisy(y), sd_N * sd_N};
    return m;
}

template <int Nodes = 41>
EngagementSolver<double, Nodes> solver(double law_relative_sd = 0.0) {
    EngagementSolverSettings<double> settings = millforce::tests::solver_of_four_flutes<double>();
    settings.law_relative_sd = law_relative_sd;
    return {carbide_in_SM45C<double>(), settings};
}

/// The immersion that a solver for a cut with the centre at that offset finds.
double immersion_found(const Cut& cut, double centre_offset_in_radii, double largest_immersion = 2.0) {
    EngagementSolverSettings<double> settings = millforce::tests::solver_of_four_flutes<double>();
    settings.centre_offset_in_radii = centre_offset_in_radii;
    settings.largest_immersion = largest_immersion;
    const EngagementSolver<double> solver(carbide_in_SM45C<double>(), settings, cut.side);
    return solver.solve(measured(cut, 3.0), cut.feed_per_tooth_mm, cut.side).radial_immersion;
}

double force_ratio(CutSide side, double immersion) {
    const auto f =
        true_forces({.side = side, .immersion = immersion, .feed_per_tooth_mm = 0.0496}, carbide_in_SM45C<double>());
    return f.feed_N / f.tangential_N;
}

/// Where J stays within its rise, found by looking everywhere.
struct Band {
    double low_rad;
    double high_rad;
};

Band band_by_looking_everywhere(const AverageForceMeasurement<double>& forces, const Cut& cut,
                                const EngagementEstimate<double>& found) {
    constexpr int nodes = 41;
    constexpr int places = 1000;
    using Table = EngagementTable<double, nodes>;
    Table table;
    table.build(carbide_in_SM45C<double>(), 4.0, cut.side, 0.0, pi<double>);
    const ImmersionProfile<double, nodes> J(table, forces, cut.feed_per_tooth_mm, 0.02, {}, 0.0);
    const double most = found.misfit + rise_of_interval(found.misfit);
    Band band{found.engagement_rad, found.engagement_rad};
    for (int n = 0; n <= places; ++n) {
        const double theta_rad = Table::first_rad + (pi<double> - Table::first_rad) * n / places;
        if (J.at(table, theta_rad).misfit <= most) {
            band = {std::min(band.low_rad, theta_rad), std::max(band.high_rad, theta_rad)};
        }
    }
    return band;
}

}  // namespace

TEST_GROUP(EngagementSolver){};

TEST(EngagementSolver, works_on_the_published_force_ratios) {
    // Down milling is monotone, up milling has a flat maximum near 0.2.
    const double down[][2] = {{0.05, -0.876}, {0.2, -0.725}, {0.5, -0.504}, {1.0, -0.200}, {1.5, 0.066}, {2.0, 0.300}};
    for (const auto& row : down) {
        DOUBLES_EQUAL(row[1], force_ratio(CutSide::down, row[0]), 0.0006);
    }
    const double up[][2] = {{0.05, 1.0743}, {0.2, 1.0747}, {0.5, 0.996}, {1.0, 0.800}, {2.0, 0.300}};
    for (const auto& row : up) {
        DOUBLES_EQUAL(row[1], force_ratio(CutSide::up, row[0]), 0.0006);
    }
}

TEST(EngagementSolver, finds_immersion_and_depth_of_down_milling_from_spindle_and_feed_axis_alone) {
    for (double immersion = 0.05; immersion <= 1.95; immersion += 0.05) {
        for (const double depth : {1.0, 12.0}) {
            for (const double feed : {0.02, 0.1}) {
                const Cut cut{.immersion = immersion, .depth_mm = depth, .feed_per_tooth_mm = feed};
                // 0.2 %: what the table's interpolation is off by is no reason to doubt the law.
                const auto e = solver(0.002).solve(measured(cut, 0.02), feed, CutSide::down);
                CHECK(e.immersion_valid);
                DOUBLES_EQUAL(immersion, e.radial_immersion, 0.003);
                DOUBLES_EQUAL(1.0, e.axial_depth_mm / depth, 0.005);
            }
        }
    }
}

TEST(EngagementSolver, shows_in_its_variance_that_up_milling_hides_small_immersions) {
    const auto small = solver().solve(measured({.side = CutSide::up, .immersion = 0.15}, 10.0), 0.05, CutSide::up);
    CHECK(small.radial_immersion_sd > 0.1);
    const auto large = solver().solve(measured({.side = CutSide::up, .immersion = 1.2}, 10.0), 0.05, CutSide::up);
    CHECK(large.immersion_valid);
    CHECK(large.radial_immersion_sd < 0.06);
    DOUBLES_EQUAL(1.2, large.radial_immersion, 0.02);
}

TEST(EngagementSolver, knows_small_immersions_in_up_milling_once_the_y_drive_moves) {
    const Cut cut{.side = CutSide::up, .immersion = 0.15, .direction_rad = 0.6, .y_moves = true};
    const auto e = solver().solve(measured(cut, 5.0), 0.05, CutSide::up);
    CHECK(e.immersion_valid);
    DOUBLES_EQUAL(0.15, e.radial_immersion, 0.01);
    CHECK(e.radial_immersion_sd < 0.08);
}

TEST(EngagementSolver, gives_the_same_answer_in_every_direction_of_feed) {
    for (double direction = -3.0; direction <= 3.0; direction += 0.25) {
        const Cut cut{.immersion = 0.7, .direction_rad = direction, .y_moves = true};
        const auto e = solver().solve(measured(cut, 2.0), 0.05, CutSide::down);
        DOUBLES_EQUAL(0.7, e.radial_immersion, 0.003);
        DOUBLES_EQUAL(6.0, e.axial_depth_mm, 0.03);
    }
}

TEST(EngagementSolver, infers_the_side_from_the_sign_of_the_feed_force) {
    for (const double immersion : {0.4, 0.8, 1.2}) {
        for (const CutSide side : {CutSide::down, CutSide::up}) {
            const Cut cut{.side = side, .immersion = immersion, .direction_rad = 0.5, .y_moves = true};
            const auto e = solver().solve(measured(cut, 5.0), 0.05, CutSide::unknown);
            CHECK(e.side == side);
            DOUBLES_EQUAL(immersion, e.radial_immersion, 0.02);
        }
    }
}

TEST(EngagementSolver, takes_the_other_side_where_the_forces_refute_the_told_one) {
    for (const double immersion : {0.4, 0.8, 1.2}) {
        for (const CutSide side : {CutSide::down, CutSide::up}) {
            const CutSide told = side == CutSide::up ? CutSide::down : CutSide::up;
            for (const bool y_moves : {false, true}) {
                const Cut cut{.side = side, .immersion = immersion, .y_moves = y_moves};
                const auto e = solver(0.02).solve(measured(cut, 5.0), 0.05, told);
                CHECK(e.side == side);
                CHECK(e.immersion_valid);
                DOUBLES_EQUAL(immersion, e.radial_immersion, 0.02);
            }
        }
    }
}

TEST(EngagementSolver, has_no_estimate_where_neither_side_explains_the_forces) {
    for (const CutSide told : {CutSide::down, CutSide::up, CutSide::unknown}) {
        auto forces = measured({.immersion = 0.5, .y_moves = true}, 5.0);
        forces.y_N.value = -forces.y_N.value;  // a reversed current
        const auto e = solver(0.02).solve(forces, 0.05, told);
        CHECK(e.solved);
        CHECK_FALSE(e.immersion_valid);
        CHECK_FALSE(e.depth_valid);
        CHECK(e.radial_immersion_low < 0.02);
        DOUBLES_EQUAL(2.0, e.radial_immersion_high, 1e-9);
    }
}

TEST(EngagementSolver, has_no_estimate_of_a_weak_spindle_current_that_the_resting_axis_contradicts) {
    const Cut slot{.immersion = 1.5};
    auto forces = measured(slot, 5.0);
    forces.tangential_N.value *= 0.3;
    CHECK(solver(0.02).solve(forces, 0.05, CutSide::down).immersion_valid);
    constexpr double static_friction_N = 300.0;
    forces.resting.least_N = {true, forces.y_N.value + static_friction_N, 25.0};
    CHECK(forces.resting.least_N.value < 0.0);
    CHECK_FALSE(solver(0.02).solve(forces, 0.05, CutSide::down).immersion_valid);
}

TEST(EngagementSolver, lets_static_friction_or_a_brake_carry_the_force_on_a_resting_axis) {
    for (const double share_that_the_motor_carries : {0.0, 0.5, 1.0}) {
        const Cut cut{.immersion = 1.0};
        const auto without = measured(cut, 5.0);
        auto with = without;
        with.resting.least_N = {true, share_that_the_motor_carries * without.y_N.value, 25.0};
        const auto e = solver(0.02).solve(with, 0.05, CutSide::down);
        CHECK(e.immersion_valid);
        DOUBLES_EQUAL(1.0, e.radial_immersion, 0.02);
        CHECK(e.misfit < 1.0);
    }
}

TEST(EngagementSolver, widens_the_interval_of_a_law_that_explains_the_forces_badly) {
    const auto exact = measured({.immersion = 0.8, .y_moves = true}, 5.0);
    auto off = exact;
    off.y_N.value *= 1.1;
    const auto e = solver(0.02).solve(exact, 0.05, CutSide::down);
    const auto doubted = solver(0.02).solve(off, 0.05, CutSide::down);
    CHECK(doubted.misfit > 4.0);
    CHECK(doubted.immersion_valid);
    CHECK(doubted.radial_immersion_sd > 1.9 * e.radial_immersion_sd);
}

TEST(EngagementSolver, gives_no_depth_beyond_the_flutes) {
    EngagementSolverSettings<double> settings = millforce::tests::solver_of_four_flutes<double>();
    settings.flute_length_mm = 5.0;
    const EngagementSolver<double> short_flutes(carbide_in_SM45C<double>(), settings);
    for (const double immersion : {0.1, 0.5, 1.0, 1.8}) {
        for (const double depth_mm : {4.9, 20.0}) {
            const Cut cut{.immersion = immersion, .depth_mm = depth_mm};
            const auto e = short_flutes.solve(measured(cut, 5.0), 0.05, CutSide::down);
            CHECK(e.axial_depth_mm <= 5.0);
            CHECK(depth_mm < 5.0 || !e.depth_valid);
        }
    }
}

TEST(EngagementSolver, leaves_each_immersion_for_which_the_flutes_are_long_enough_possible_where_the_law_is_in_doubt) {
    EngagementSolverSettings<double> settings = millforce::tests::solver_of_four_flutes<double>();
    settings.flute_length_mm = 5.0;
    const EngagementSolver<double> short_flutes(carbide_in_SM45C<double>(), settings);
    const Cut cut{.depth_mm = 4.5};
    EngagementSolver<double>::Search search;
    short_flutes.begin(search, measured(cut, 3.0), cut.feed_per_tooth_mm, cut.side, {}, true);
    while (!short_flutes.advance(search, 100)) {
    }
    const auto e = search.estimate();
    CHECK(e.solved && e.law_is_in_doubt);
    CHECK_FALSE(e.immersion_valid || e.depth_valid);
    CHECK(e.radial_immersion_low > 0.2 && e.radial_immersion_low < cut.immersion);
    DOUBLES_EQUAL(2.0, e.radial_immersion_high, 0.0);
    const double doubt_of_K_s = 2.0 * carbide_in_SM45C<double>().K_s_relative_sd;
    CHECK(e.depth_at_low_mm > cut.depth_mm && e.depth_at_low_mm <= 5.0 * (1.0 + doubt_of_K_s));
}

TEST(EngagementSolver, calls_a_slot_a_slot_whichever_side_is_told) {
    for (const CutSide side : {CutSide::down, CutSide::up, CutSide::unknown}) {
        const auto e = solver().solve(measured({.immersion = 2.0}, 3.0), 0.05, side);
        CHECK(e.immersion_valid);
        DOUBLES_EQUAL(2.0, e.radial_immersion, 0.02);
    }
}

TEST(EngagementSolver, finds_the_immersion_of_a_centred_cut_on_either_side_of_the_centre) {
    for (const double offset : {-0.4, 0.0, 0.4}) {
        const Cut cut{.side = CutSide::centred, .immersion = 0.9, .y_moves = true, .centre_offset_in_radii = offset};
        DOUBLES_EQUAL(0.9, immersion_found(cut, offset), 0.05);
    }
}

TEST(EngagementSolver, finds_no_centred_cut_beyond_the_edge_of_the_cutter_nor_beyond_the_largest_immersion) {
    for (const double offset : {-0.4, 0.4}) {
        const Cut clipped{
            .side = CutSide::centred, .immersion = 1.6, .y_moves = true, .centre_offset_in_radii = offset};
        CHECK_COMPARE(immersion_found(clipped, offset), <, 1.2 + 1e-6);
    }
    const Cut wide{.side = CutSide::centred, .immersion = 1.2, .y_moves = true};
    DOUBLES_EQUAL(0.8, immersion_found(wide, 0.0, 0.8), 1e-6);
}

TEST(EngagementSolver, hears_nothing_of_an_offset_of_the_centre_where_the_cut_lies_on_a_side) {
    DOUBLES_EQUAL(2.0, immersion_found({.immersion = 2.0}, 0.4), 0.02);
}

TEST(EngagementSolver, takes_no_more_steps_at_once_than_it_may_and_comes_to_the_same_answer) {
    const auto solver_of_cut = solver();
    const auto forces = measured({}, 3.0);
    EngagementSolver<double>::Search search;
    solver_of_cut.begin(search, forces, 0.05, CutSide::down, {});
    int calls = 0;
    for (; calls < 10; ++calls) {
        CHECK_FALSE(solver_of_cut.advance(search, 2));
    }
    while (!solver_of_cut.advance(search, 1)) {
        ++calls;
    }
    CHECK_COMPARE(calls, <, 60);
    DOUBLES_EQUAL(solver_of_cut.solve(forces, 0.05, CutSide::down).radial_immersion, search.estimate().radial_immersion,
                  0.0);
}

TEST(EngagementSolver, needs_one_moving_axis_whichever_it_is) {
    for (const bool is_x : {true, false}) {
        auto m = measured({.direction_rad = is_x ? 0.0 : 0.5 * pi<double>, .y_moves = true}, 3.0);
        (is_x ? m.y_N : m.x_N).valid = false;
        const auto e = solver().solve(m, 0.05, CutSide::down);
        CHECK(e.immersion_valid);
        DOUBLES_EQUAL(0.5, e.radial_immersion, 0.02);
    }
}

TEST(EngagementSolver, has_no_estimate_without_a_moving_axis_or_a_significant_force) {
    auto standing = measured({}, 2.0);
    standing.x_N.valid = false;
    CHECK_FALSE(solver().solve(standing, 0.05, CutSide::down).solved);
    const auto faint = measured({.depth_mm = 0.05}, 10.0);
    CHECK_FALSE(solver().solve(faint, 0.05, CutSide::down).solved);
    CHECK_FALSE(solver().solve(measured({}, 2.0), 0.0, CutSide::down).solved);
    auto without_torque = measured({}, 2.0);
    without_torque.tangential_N.valid = false;
    CHECK_FALSE(solver().solve(without_torque, 0.05, CutSide::down).solved);
    auto braking = measured({}, 2.0);
    braking.tangential_N.value *= -1.0;
    CHECK_FALSE(solver().solve(braking, 0.05, CutSide::down).solved);
    for (auto force : {&AverageForceMeasurement<double>::tangential_N, &AverageForceMeasurement<double>::x_N}) {
        for (const CutSide side : {CutSide::down, CutSide::unknown}) {
            auto broken = measured({}, 2.0);
            (broken.*force).value = std::nan("");
            const auto e = solver().solve(broken, 0.05, side);
            CHECK_FALSE(e.solved);
            CHECK_FALSE(e.immersion_valid);
            CHECK_FALSE(e.depth_valid);
        }
    }
}

TEST(EngagementSolver, has_an_interval_as_far_as_the_forces_allow_and_seldom_by_a_node_farther) {
    const auto solver_of_cut = solver(0.02);
    constexpr double step_rad = pi<double> / 40.0;
    std::mt19937 random(20261128);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    constexpr int cuts = 400;
    int too_near = 0;
    int low_too_far = 0;
    int high_too_far = 0;
    for (int k = 0; k < cuts; ++k) {
        const Cut cut{.side = k % 2 == 0 ? CutSide::down : CutSide::up,
                      .immersion = 0.05 + 1.95 * share(random),
                      .depth_mm = 1.0 + 11.0 * share(random),
                      .direction_rad = k % 4 < 2 ? 0.0 : 6.28 * share(random),
                      .y_moves = k % 4 >= 2};
        const auto forces = measured(cut, 0.3 * std::pow(100.0, share(random)), &random);
        const auto found = solver_of_cut.solve(forces, cut.feed_per_tooth_mm, cut.side);
        if (!found.solved || found.side != cut.side) {
            continue;
        }
        const Band band = band_by_looking_everywhere(forces, cut, found);
        const double low_beyond = (band.low_rad - found.engagement_low_rad) / step_rad;
        const double high_beyond = (found.engagement_high_rad - band.high_rad) / step_rad;
        too_near += low_beyond < -0.25 || high_beyond < -0.25 ? 1 : 0;
        low_too_far += low_beyond > 1.0 ? 1 : 0;
        high_too_far += high_beyond > 1.0 ? 1 : 0;
        CHECK(found.engagement_low_rad >= 0.0 && found.engagement_high_rad <= pi<double>);
    }
    LONGS_EQUAL(0, too_near);
    CHECK(low_too_far < 0.1 * cuts);
    CHECK(high_too_far < 0.1 * cuts);
}

TEST(EngagementSolver, misses_nothing_by_looking_at_few_immersions) {
    const auto few = solver(0.02);
    static const auto many = solver<161>(0.02);
    std::mt19937 random(20261123);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    constexpr int cuts = 1000;
    int elsewhere = 0;
    int differently_sure = 0;
    for (int k = 0; k < cuts; ++k) {
        const Cut cut{.side = k % 2 == 0 ? CutSide::down : CutSide::up,
                      .immersion = 0.05 + 1.95 * share(random),
                      .depth_mm = 1.0 + 11.0 * share(random),
                      .feed_per_tooth_mm = 0.02 + 0.15 * share(random),
                      .direction_rad = k % 3 == 0 ? 0.0 : 6.28 * share(random),
                      .y_moves = k % 3 != 0};
        const auto forces = measured(cut, 0.3 * std::pow(100.0, share(random)), &random);
        const CutSide told = k % 5 == 0 ? CutSide::unknown : cut.side;
        const auto found = few.solve(forces, cut.feed_per_tooth_mm, told);
        const auto exact = many.solve(forces, cut.feed_per_tooth_mm, told);
        CHECK_EQUAL(exact.solved, found.solved);
        if (!exact.solved) {
            continue;
        }
        CHECK(found.misfit < exact.misfit + 0.1);
        const double apart = std::abs(found.radial_immersion - exact.radial_immersion);
        elsewhere += apart > 0.002 + 0.1 * exact.radial_immersion_sd ? 1 : 0;
        differently_sure += std::abs(found.radial_immersion_sd / exact.radial_immersion_sd - 1.0) > 0.1 ? 1 : 0;
    }
    CHECK(elsewhere < 0.005 * cuts);  // where two immersions, or a range of them, fit alike
    CHECK(differently_sure < 0.02 * cuts);
}

HOST_TEST(EngagementSolver, holds_the_truth_in_its_95_percent_band_as_often_as_it_says) {
    std::mt19937 random(20261121);
    std::uniform_real_distribution<double> immersion(0.3, 1.8);
    std::uniform_real_distribution<double> depth(3.0, 12.0);
    int given = 0;
    int in_immersion_band = 0;
    int in_depth_band = 0;
    constexpr int cuts = 4000;
    for (int k = 0; k < cuts; ++k) {
        const Cut cut{.immersion = immersion(random),
                      .depth_mm = depth(random),
                      .direction_rad = 0.4 * (k % 3),
                      .y_moves = k % 3 != 0};
        const auto e = solver().solve(measured(cut, 12.0, &random), 0.05, CutSide::down);
        given += e.immersion_valid ? 1 : 0;
        in_immersion_band += std::abs(e.radial_immersion - cut.immersion) < 1.96 * e.radial_immersion_sd ? 1 : 0;
        in_depth_band += std::abs(e.axial_depth_mm - cut.depth_mm) < 1.96 * e.axial_depth_sd_mm ? 1 : 0;
    }
    CHECK(given >= 0.998 * cuts);  // forces whose noise is rare explain nothing
    const double immersion_coverage = static_cast<double>(in_immersion_band) / cuts;
    const double depth_coverage = static_cast<double>(in_depth_band) / cuts;
    CHECK(immersion_coverage > 0.93 && immersion_coverage < 0.97);
    CHECK(depth_coverage > 0.93 && depth_coverage < 0.97);
}

TEST(EngagementSolver, takes_an_immersion_that_another_method_tells_for_one_more_measurement) {
    const Cut cut{.side = CutSide::up, .immersion = 0.25};  // where F_ax/F_at is flat and tells nothing
    auto forces = measured(cut, 6.0);
    CHECK(solver(0.02).solve(forces, 0.05, CutSide::up).radial_immersion_sd > 0.1);
    forces.radial_immersion = {true, 0.26, 0.02 * 0.02};
    const auto told = solver(0.02).solve(forces, 0.05, CutSide::up);
    CHECK(told.immersion_valid && told.depth_valid);
    DOUBLES_EQUAL(0.26, told.radial_immersion, 0.01);
    DOUBLES_EQUAL(0.02, told.radial_immersion_sd, 0.004);
    DOUBLES_EQUAL(6.0, told.axial_depth_mm, 0.5);
    // One that is poor beside the forces changes little.
    auto clear = measured({.immersion = 0.8}, 2.0);
    const double alone = solver().solve(clear, 0.05, CutSide::down).radial_immersion;
    clear.radial_immersion = {true, 0.3, 0.5 * 0.5};
    DOUBLES_EQUAL(alone, solver().solve(clear, 0.05, CutSide::down).radial_immersion, 0.002);
}

TEST(EngagementSolver, needs_no_feed_force_where_the_immersion_is_told) {
    auto standing = measured({}, 2.0);
    standing.x_N.valid = false;
    standing.radial_immersion = {true, 0.5, 0.03 * 0.03};
    const auto e = solver().solve(standing, 0.05, CutSide::down);
    DOUBLES_EQUAL(0.5, e.radial_immersion, 0.002);
    DOUBLES_EQUAL(6.0, e.axial_depth_mm, 0.1);
}

TEST(EngagementSolver, doubts_the_depth_by_the_doubt_in_K_s) {
    auto law = carbide_in_SM45C<double>();
    law.K_s_relative_sd = 0.1;
    const EngagementSolver<double> doubtful(law, millforce::tests::solver_of_four_flutes<double>());
    const auto e = doubtful.solve(measured({}, 1.0), 0.05, CutSide::down);
    DOUBLES_EQUAL(0.1, e.axial_depth_sd_mm / e.axial_depth_mm, 0.02);
}

TEST(EngagementSolver, tells_narrow_up_milling_with_one_axis_by_a_remembered_depth) {
    const KnownDepth<double> remembered{6.0, 0.06, false};
    for (const double immersion : {0.2, 0.4, 0.6}) {
        const auto forces = measured({.side = CutSide::up, .immersion = immersion}, 8.0);
        const auto alone = solver(0.02).solve(forces, 0.05, CutSide::up);
        const auto with_memory = solver(0.02).solve(forces, 0.05, CutSide::up, remembered);
        CHECK(!alone.immersion_valid || alone.axial_depth_force_sd_mm > 1.0);
        CHECK(with_memory.immersion_valid);
        CHECK(with_memory.depth_is_remembered);
        DOUBLES_EQUAL(immersion, with_memory.radial_immersion, 0.03);
        DOUBLES_EQUAL(6.0, with_memory.axial_depth_mm, 0.3);
    }
}

TEST(EngagementSolver, leaves_a_remembered_depth_that_the_forces_refute) {
    const auto forces = measured({.side = CutSide::up, .immersion = 0.6, .depth_mm = 9.0}, 8.0);
    const auto e = solver(0.02).solve(forces, 0.05, CutSide::up, {3.0, 0.05, false});
    CHECK_FALSE(e.depth_is_remembered);
    CHECK(e.radial_immersion_low < 0.6);
    CHECK(e.radial_immersion_high > 0.6);
}

TEST(EngagementSolver, needs_no_memory_where_the_forces_tell_the_depth) {
    const auto e = solver(0.02).solve(measured({.immersion = 0.6}, 5.0), 0.05, CutSide::down, {6.0, 0.08, false});
    CHECK(e.immersion_valid);
    CHECK_FALSE(e.depth_is_remembered);
}

TEST(EngagementSolver, leaves_a_declared_depth_that_the_forces_refute_and_says_so) {
    auto law = carbide_in_SM45C<double>();
    law.K_s_relative_sd = 0.1;
    auto settings = millforce::tests::solver_of_four_flutes<double>();
    settings.declared_depth_mm = 6.0;
    const EngagementSolver<double> declared(law, settings);
    const auto forces_of = [](double depth_mm) { return measured({.immersion = 0.6, .depth_mm = depth_mm}, 2.0); };
    const auto right = declared.solve(forces_of(6.0), 0.05, CutSide::down);
    CHECK_FALSE(right.declared_depth_is_refuted);
    // Twice the force: a material twice as hard as the tool's.
    const auto hard = declared.solve(forces_of(12.0), 0.05, CutSide::down);
    CHECK(hard.declared_depth_is_refuted);
    CHECK(hard.immersion_valid);
    DOUBLES_EQUAL(0.6, hard.radial_immersion, 0.03);
    CHECK(hard.misfit < 1.0);
    const auto somewhat_hard = declared.solve(forces_of(7.0), 0.05, CutSide::down);
    CHECK_FALSE(somewhat_hard.declared_depth_is_refuted);
}

TEST(EngagementSolver, states_a_deviation_that_reaches_to_the_farther_end_of_a_lopsided_interval) {
    // Up milling along x: narrow and deep, or wide and shallow; the forces fit both.
    const auto e = solver(0.02).solve(measured({.side = CutSide::up, .immersion = 0.25}, 8.0), 0.05, CutSide::up);
    CHECK(e.depth_at_low_mm - e.axial_depth_mm > 1.5 * (e.axial_depth_mm - e.depth_at_high_mm));
    DOUBLES_EQUAL((e.depth_at_low_mm - e.axial_depth_mm) / 1.96, e.axial_depth_force_sd_mm, 0.15);
    CHECK(e.radial_immersion_sd >= (e.radial_immersion_high - e.radial_immersion) / 1.961);
}

TEST(EngagementSolver, counts_that_an_edge_force_is_a_larger_share_where_K_s_is_smaller_than_told) {
    auto told = linear_edge_law(1650.0, 22.0, 620.0, 28.0);
    told.K_s_relative_sd = 0.15;
    const EngagementSolver<double> solver_of_told(told, millforce::tests::solver_of_four_flutes<double>());
    for (const double K_s_ratio : {0.75, 1.3}) {
        auto truth = told;
        truth.k_s_N_per_mm2 *= K_s_ratio;
        const auto forces = average_forces(truth, {0.03, 6.0, engagement_angles(CutSide::up, 0.8), 4.0});
        AverageForceMeasurement<double> m;
        m.tangential_N = {true, forces.tangential_N, 4.0};
        m.x_N = {true, forces.feed_N, 4.0};
        const auto e = solver_of_told.solve(m, 0.03, CutSide::up);
        CHECK(e.radial_immersion_low < 0.8);
        CHECK(e.radial_immersion_high > 0.8);
    }
}
