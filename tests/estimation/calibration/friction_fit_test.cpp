// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/friction_fit.hpp"

#include "estimation/fit_statistics.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>

using namespace millforce::estimation;
using millforce::test::Coverage;
using millforce::test::Noise;

namespace {

struct Motion {
    double velocity_m_s;
    double acceleration_m_s2;
};

/// A to-and-fro motion with several speeds.
Motion motion(int k) {
    const double t = 0.01 * k;
    return {0.2 * std::sin(2.0 * t) + 0.05 * std::sin(7.0 * t), 0.4 * std::cos(2.0 * t) + 0.35 * std::cos(7.0 * t)};
}

/// Six feeds in air, in both directions (m/min).
constexpr std::array<double, 12> feeds{0.5, 1, 2, 4, 7, 10, -0.5, -1, -2, -4, -7, -10};

Eigen::Matrix<double, 6, 1> drive() {
    Eigen::Matrix<double, 6, 1> p;
    p << 0.012, 0.09, 0.010, 0.13, 1.9, -5.39;
    return p;
}

}  // namespace

TEST_GROUP(FrictionFit){};

TEST(FrictionFit, finds_mass_and_friction_by_direction_with_honest_standard_errors) {
    const DirectionalFriction truth{95.0, 166.0, 241.0, 20.1, 20.6};
    const std::array<double, 5> values{95.0, 166.0, 241.0, 20.1, 20.6};
    std::array<Coverage, 5> coverage;
    Noise noise(11);
    for (int repetition = 0; repetition < 1500; ++repetition) {
        MechanicalFrictionFit fit(0.002);
        for (int k = 0; k < 300; ++k) {
            const Motion m = motion(k);
            fit.add(m.velocity_m_s, m.acceleration_m_s2,
                    truth.force_N(m.velocity_m_s, m.acceleration_m_s2) + noise.normal(2.0));
        }
        const auto solution = fit.directional();
        LONGS_EQUAL(0, solution.undetermined);
        for (int j = 0; j < 5; ++j) {
            const auto index = static_cast<std::size_t>(j);
            coverage[index].add(values[index], solution.parameters(j), solution.standard_error(j), 1.968);
        }
    }
    for (const Coverage& c : coverage) {
        CHECK(c.percent() > 93.0 && c.percent() < 97.0);
    }
}

TEST(FrictionFit, finds_the_symmetric_form_with_its_offset) {
    const SymmetricFriction truth{95.11, 203.5, 20.39, -3.16};
    MechanicalFrictionFit fit(0.002);
    Noise noise(12);
    for (int k = 0; k < 2000; ++k) {
        const Motion m = motion(k);
        fit.add(m.velocity_m_s, m.acceleration_m_s2,
                truth.force_N(m.velocity_m_s, m.acceleration_m_s2) + noise.normal(2.0));
    }
    const auto solution = fit.symmetric();
    const std::array<double, 4> values{95.11, 203.5, 20.39, -3.16};
    for (int j = 0; j < 4; ++j) {
        DOUBLES_EQUAL(values[static_cast<std::size_t>(j)], solution.parameters(j), 3.0 * solution.standard_error(j));
    }
    DOUBLES_EQUAL(2.0, solution.residual_sd, 0.1);
}

TEST(FrictionFit, in_one_direction_cannot_tell_dry_friction_from_an_offset) {
    MechanicalFrictionFit fit(0.002);
    for (int k = 0; k < 300; ++k) {
        const double v = 0.1 + 0.05 * std::sin(0.1 * k);
        fit.add(v, 0.5 * std::cos(0.1 * k), 20.0 + 200.0 * v);
    }
    const auto solution = fit.symmetric();
    CHECK(solution.determined(symmetric_mass));
    CHECK(solution.determined(symmetric_viscous));
    CHECK(!solution.determined(symmetric_coulomb));
    CHECK(!solution.determined(symmetric_offset));
    CHECK(!fit.directional().determined(negative_viscous));
    CHECK(!fit.directional().determined(negative_coulomb));
    CHECK(fit.directional().determined(positive_coulomb));
}

TEST(FrictionFit, at_one_speed_cannot_tell_viscous_from_dry_friction) {
    MechanicalFrictionFit fit(0.002);
    for (int k = 0; k < 100; ++k) {
        const double v = k % 2 == 0 ? 0.1 : -0.1;
        fit.add(v, 0.0, 300.0 * v);
    }
    const auto solution = fit.symmetric();
    CHECK(!solution.determined(symmetric_mass));
    CHECK(!solution.determined(symmetric_viscous));
    CHECK(!solution.determined(symmetric_coulomb));
    CHECK(solution.determined(symmetric_offset));
}

TEST(FrictionFit, at_rest_uses_nothing) {
    MechanicalFrictionFit fit(0.002);
    for (int k = 0; k < 100; ++k) {
        CHECK(!fit.add(0.001, 0.0, 5.0));
    }
    LONGS_EQUAL(0, fit.symmetric().rows);
    LONGS_EQUAL(0xF, fit.symmetric().undetermined);
}

TEST(FrictionFit, finds_the_quadratic_current_by_direction_with_gravity_and_honest_standard_errors) {
    std::array<Coverage, 6> coverage;
    Noise noise(13);
    for (int repetition = 0; repetition < 3000; ++repetition) {
        FeedCurrentFit fit;
        for (const double w : feeds) {
            fit.add(w, feed_friction_current_A(drive(), w) + noise.normal(0.05));
            fit.add(w, feed_friction_current_A(drive(), w) + noise.normal(0.05));
        }
        const auto solution = fit.solve();
        LONGS_EQUAL(0, solution.undetermined);
        for (int j = 0; j < 6; ++j) {
            coverage[static_cast<std::size_t>(j)].add(drive()(j), solution.parameters(j), solution.standard_error(j),
                                                      millforce::test::student_t_95(18));
        }
    }
    for (const Coverage& c : coverage) {
        CHECK(c.percent() > 93.0 && c.percent() < 97.0);
    }
}

TEST(FrictionFit, recovers_the_published_feed_drive_from_its_curve) {
    FeedCurrentFit fit;  // Kim & Chung Table 3, mirrored
    for (const double w : feeds) {
        const double size = std::abs(w);
        const double current = 3.5788 * size * size - 7.2469 * size + 19.7252;
        fit.add(w, w > 0.0 ? current : -current);
    }
    const auto solution = fit.solve();
    DOUBLES_EQUAL(3.5788, solution.parameters(positive_K_x1), 1e-9);
    DOUBLES_EQUAL(-7.2469, solution.parameters(negative_K_x2), 1e-9);
    DOUBLES_EQUAL(19.7252, solution.parameters(common_K_x3), 1e-9);
    DOUBLES_EQUAL(0.0, solution.parameters(gravity_offset), 1e-9);
}

TEST(FrictionFit, with_one_feed_refuses_the_curve_and_in_one_direction_refuses_gravity) {
    FeedCurrentFit one_feed;
    FeedCurrentFit one_direction;
    for (int k = 0; k < 10; ++k) {
        one_feed.add(k % 2 == 0 ? 2.0 : -2.0, k % 2 == 0 ? 1.0 : -1.2);
        one_direction.add(0.5 + k, feed_friction_current_A(drive(), 0.5 + k));
    }
    for (const int j : {positive_K_x1, positive_K_x2, negative_K_x1, negative_K_x2, common_K_x3}) {
        CHECK(!one_feed.solve().determined(j));
    }
    CHECK(one_direction.solve().determined(positive_K_x1));
    CHECK(one_direction.solve().determined(positive_K_x2));
    for (const int j : {negative_K_x1, negative_K_x2, common_K_x3, gravity_offset}) {
        CHECK(!one_direction.solve().determined(j));
    }
}

TEST(FrictionFit, without_a_term_is_the_fit_of_the_others) {
    FeedCurrentFit fit;
    for (const double w : {0.5, 1.0, 2.0, 3.0, -0.5, -1.0, -2.0, -3.0}) {
        const double size = std::abs(w);
        fit.add(w, std::copysign(0.3 * size + 1.5, w) + 0.2 + 0.01 * std::sin(40.0 * w));
    }
    const unsigned both = (1U << positive_K_x1) | (1U << negative_K_x1);
    const auto held = fit.solve(both);
    LONGS_EQUAL(0, held.undetermined);
    DOUBLES_EQUAL(0.0, held.parameters(positive_K_x1), 1e-9);
    DOUBLES_EQUAL(0.3, held.parameters(positive_K_x2), 0.02);
    DOUBLES_EQUAL(1.5, held.parameters(common_K_x3), 0.02);
    CHECK(held.standard_error(positive_K_x2) < 0.5 * fit.solve().standard_error(positive_K_x2));
}
