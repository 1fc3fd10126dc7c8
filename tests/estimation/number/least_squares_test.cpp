// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/least_squares.hpp"

#include "estimation/fit_statistics.hpp"

#include <CppUTest/TestHarness.h>

#include <Eigen/Cholesky>

#include <array>
#include <limits>

using millforce::estimation::LeastSquares;
using millforce::test::Coverage;
using millforce::test::Noise;

TEST_GROUP(LeastSquares){};

TEST(LeastSquares, finds_a_plane_exactly_from_exact_rows) {
    LeastSquares<double, 3> fit;
    Noise noise(1);
    for (int k = 0; k < 20; ++k) {
        const double x = noise.uniform(-1, 1);
        const double y = noise.uniform(-1, 1);
        CHECK(fit.add({1.0, x, y}, 3.0 - 2.0 * x + 0.5 * y));
    }
    const auto solution = fit.solve();
    DOUBLES_EQUAL(3.0, solution.parameters(0), 1e-13);
    DOUBLES_EQUAL(-2.0, solution.parameters(1), 1e-13);
    DOUBLES_EQUAL(0.5, solution.parameters(2), 1e-13);
    DOUBLES_EQUAL(0.0, solution.residual_rms, 1e-13);
    LONGS_EQUAL(0, solution.undetermined);
}

TEST(LeastSquares, states_standard_errors_that_cover_the_truth_in_95_of_100_repetitions) {
    Noise noise(2);
    std::array<Coverage, 3> coverage;
    for (int repetition = 0; repetition < 3000; ++repetition) {
        LeastSquares<double, 3> fit;
        for (int k = 0; k < 15; ++k) {
            const double x = 0.2 * k;
            fit.add({1.0, x, x * x}, 1.0 + 2.0 * x - 0.3 * x * x + noise.normal(0.4));
        }
        const auto solution = fit.solve();
        const std::array<double, 3> truth{1.0, 2.0, -0.3};
        for (int j = 0; j < 3; ++j) {
            const auto index = static_cast<std::size_t>(j);
            coverage[index].add(truth[index], solution.parameters(j), solution.standard_error(j),
                                millforce::test::student_t_95(12));
        }
    }
    for (const Coverage& c : coverage) {
        CHECK(c.percent() > 93.0 && c.percent() < 97.0);
    }
}

TEST(LeastSquares, weights_rows_by_their_precision) {
    LeastSquares<double, 1> fit;
    fit.add(Eigen::Matrix<double, 1, 1>(1.0), 10.0, 1.0);
    fit.add(Eigen::Matrix<double, 1, 1>(1.0), 20.0, 3.0);  // nine times the information
    DOUBLES_EQUAL(19.0, fit.solve().parameters(0), 1e-12);
}

TEST(LeastSquares, keeps_in_float_what_normal_equations_lose) {
    // Columns 1 and 1 + 0.001 k: the condition of XᵀX is beyond float, that of X is not.
    LeastSquares<float, 3> fit;
    Eigen::Matrix3f normal = Eigen::Matrix3f::Zero();
    Eigen::Vector3f right = Eigen::Vector3f::Zero();
    for (int k = 0; k < 2000; ++k) {
        const float x = 10.0F + 0.001F * static_cast<float>(k);
        const Eigen::Vector3f row(1.0F, x, x * x);
        const float y = row.dot(Eigen::Vector3f(5.0F, -1.0F, 0.25F));
        fit.add(row, y);
        normal += row * row.transpose();
        right += row * y;
    }
    const auto solution = fit.solve(1e6F);
    DOUBLES_EQUAL(-1.0, static_cast<double>(solution.parameters(1)), 0.05);
    const Eigen::Vector3f squared = normal.ldlt().solve(right);
    CHECK(std::abs(squared(1) + 1.0F) > 10.0F * std::abs(solution.parameters(1) + 1.0F));
}

TEST(LeastSquares, names_the_parameters_that_the_rows_cannot_tell_apart) {
    LeastSquares<double, 4> fit;
    Noise noise(3);
    for (int k = 0; k < 30; ++k) {
        const double x = noise.uniform(0, 1);
        fit.add({x, 1.0, 1.0, 0.0}, 2.0 * x + 3.0 + noise.normal(0.01));
    }
    const auto solution = fit.solve();
    CHECK(solution.determined(0));
    CHECK(!solution.determined(1));
    CHECK(!solution.determined(2));
    CHECK(!solution.determined(3));
    DOUBLES_EQUAL(2.0, solution.parameters(0), 3.0 * solution.standard_error(0));
    DOUBLES_EQUAL(3.0, solution.parameters(1) + solution.parameters(2), 0.02);
    CHECK(std::isnan(solution.standard_error(1)));
}

TEST(LeastSquares, pulls_an_undetermined_parameter_to_its_prior) {
    LeastSquares<double, 2> fit;
    for (int k = 0; k < 10; ++k) {
        fit.add({1.0, 1.0}, 5.0 + (k % 2 == 0 ? 0.1 : -0.1));
    }
    fit.add_prior(1, 2.0, 100.0);
    const auto solution = fit.solve();
    LONGS_EQUAL(0, solution.undetermined);
    DOUBLES_EQUAL(2.0, solution.parameters(1), 1e-9);
    DOUBLES_EQUAL(3.0, solution.parameters(0), 1e-9);
    LONGS_EQUAL(10, solution.rows);
}

TEST(LeastSquares, leaves_out_rows_that_are_not_finite) {
    LeastSquares<double, 2> fit;
    fit.add({1.0, 0.0}, 1.0);
    fit.add({1.0, 1.0}, 2.0);
    CHECK(!fit.add({1.0, std::numeric_limits<double>::quiet_NaN()}, 1.0));
    CHECK(!fit.add({1.0, 2.0}, std::numeric_limits<double>::infinity()));
    CHECK(!fit.add({1e300, 2.0}, 1.0));
    LONGS_EQUAL(2, fit.rows());
    DOUBLES_EQUAL(1.0, fit.solve().parameters(1), 1e-12);
}

TEST(LeastSquares, says_nothing_without_rows) {
    const auto solution = LeastSquares<double, 2>().solve();
    LONGS_EQUAL(3, solution.undetermined);
    CHECK(std::isnan(solution.standard_error(0)));
}
