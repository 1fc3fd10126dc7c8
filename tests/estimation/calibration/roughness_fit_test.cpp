// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/roughness_fit.hpp"

#include "estimation/calibration/roughness_cuts.hpp"
#include "estimation_calibration/roughness_in_double.hpp"

#include <Eigen/LU>  // before CppUTest, which makes `new` a macro

#include <CppUTest/TestHarness.h>

#include <array>

using namespace millforce::estimation;
using namespace millforce::test;

namespace {

constexpr int speed = roughness_spindle_speed;
constexpr int diameter = roughness_tool_diameter;
constexpr int depth = roughness_axial_depth;

RoughnessTests tests_of_seed(unsigned seed, double ln_sd = 0.1) {
    Noise noise(seed);
    const auto cuts = published_cuts(noise);
    return made_with(published_Ra(), cuts, noise, ln_sd);
}

/// The same fit from the textbook: β = (XᵀX)⁻¹Xᵀy on logarithms as they are, in long double.
struct Textbook {
    using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
    Matrix inverse;
    Vector beta;
    long double s = 0.0L;

    static Vector row(const Cut& cut) {
        Vector x(6);
        x(0) = 1.0L;
        for (int j = 0; j < 5; ++j) {
            x(j + 1) = std::log(static_cast<long double>(cut[static_cast<std::size_t>(j)]));
        }
        return x;
    }
    explicit Textbook(const RoughnessTests& tests) {
        const auto n = static_cast<Eigen::Index>(tests.size());
        Matrix X(n, 6);
        Vector y(n);
        for (Eigen::Index k = 0; k < n; ++k) {
            X.row(k) = row(tests[static_cast<std::size_t>(k)].cut).transpose();
            y(k) = std::log(static_cast<long double>(tests[static_cast<std::size_t>(k)].roughness_um));
        }
        inverse = (X.transpose() * X).inverse();
        beta = inverse * X.transpose() * y;
        s = std::sqrt((y - X * beta).squaredNorm() / static_cast<long double>(n - 6));
    }
    double ln_R(const Cut& cut) const { return static_cast<double>(row(cut).dot(beta)); }
    double half_interval(const Cut& cut, double t) const {
        const Vector x = row(cut);
        return t * static_cast<double>(s * std::sqrt(1.0L + x.dot(inverse * x)));
    }
};

}  // namespace

TEST_GROUP(RoughnessFit){};

TEST(RoughnessFit, finds_both_published_models_exactly_from_exact_tests) {
    Noise noise(1);
    const auto cuts = published_cuts(noise);
    for (const auto& truth : {published_Ra(), published_Rz()}) {
        const auto found = fit(made_with(truth, cuts, noise, 0.0));
        CHECK(found.is_determined());
        DOUBLES_EQUAL(1.0, found.model.constant_um / truth.constant_um, 1e-8);
        for (std::size_t j = 0; j < 5; ++j) {
            DOUBLES_EQUAL(truth.exponent[j], found.model.exponent[j], 1e-10);
        }
        DOUBLES_EQUAL(1.0, found.determination, 1e-12);
    }
}

TEST(RoughnessFit, is_the_textbooks_least_squares_with_its_prediction_interval) {
    const auto tests = tests_of_seed(2);
    const auto found = fit(tests);
    const Textbook textbook(tests);
    const RoughnessPredictor<double> predictor(found.model);
    const double t = 2.042272;  // 36 tests, 6 parameters: 30 degrees of freedom
    Noise noise(3);
    for (int k = 0; k < 100; ++k) {
        const Cut cut = any_cut(noise);
        const auto prediction = predictor.predict(cut);
        DOUBLES_EQUAL(textbook.ln_R(cut), std::log(prediction.roughness_um), 1e-9);
        DOUBLES_EQUAL(textbook.half_interval(cut, t), std::log(prediction.high_um / prediction.roughness_um), 1e-6);
        DOUBLES_EQUAL(textbook.half_interval(cut, t), std::log(prediction.roughness_um / prediction.low_um), 1e-6);
    }
    for (int j = 0; j < 5; ++j) {
        DOUBLES_EQUAL(static_cast<double>(textbook.s * std::sqrt(textbook.inverse(j + 1, j + 1))),
                      found.exponent_standard_error[static_cast<std::size_t>(j)], 1e-10);
    }
    DOUBLES_EQUAL(static_cast<double>(textbook.s * std::sqrt(textbook.inverse(0, 0))), found.constant_ln_standard_error,
                  1e-8);
}

TEST(RoughnessFit, recovers_the_published_exponents_within_two_standard_errors_in_95_of_100_series_of_tests) {
    for (const auto& truth : {published_Ra(), published_Rz()}) {
        Noise noise(4);
        std::array<Coverage, 5> within;
        for (int series = 0; series < 1500; ++series) {
            const auto cuts = published_cuts(noise);
            const auto found = fit(made_with(truth, cuts, noise, 0.15));
            for (std::size_t j = 0; j < 5; ++j) {
                within[j].add(truth.exponent[j], found.model.exponent[j], found.exponent_standard_error[j], 2.0);
            }
        }
        for (const Coverage& exponent : within) {
            CHECK(exponent.percent() > 92.5 && exponent.percent() < 96.5);  // exact: 94.5, Student's t with 30
        }
    }
}

TEST(RoughnessFit, in_float_gives_the_same_interval_to_a_thousandth) {
    const auto tests = tests_of_seed(5);
    const RoughnessPredictor<float> rough(in_float(fit(tests).model));
    const RoughnessPredictor<double> exact(fit(tests).model);
    for (const auto& test : tests) {
        RoughnessConditions<float> cut{};
        std::transform(test.cut.begin(), test.cut.end(), cut.begin(),
                       [](double value) { return static_cast<float>(value); });
        const auto a = rough.predict(cut);
        const auto b = exact.predict(test.cut);
        DOUBLES_EQUAL(b.roughness_um, static_cast<double>(a.roughness_um), 1e-3 * b.roughness_um);
        DOUBLES_EQUAL(b.high_um, static_cast<double>(a.high_um), 1e-3 * b.high_um);
        DOUBLES_EQUAL(b.low_um, static_cast<double>(a.low_um), 1e-3 * b.low_um);
    }
}

TEST(RoughnessFit, names_the_variable_that_does_not_vary) {
    auto tests = tests_of_seed(6);
    for (auto& test : tests) {
        test.cut[diameter] = 6.0;
    }
    const auto found = fit(tests);
    CHECK(!found.is_determined());
    LONGS_EQUAL(1U << diameter, found.undetermined);
    LONGS_EQUAL(-1, found.variable_it_goes_with(diameter));
}

TEST(RoughnessFit, names_both_variables_that_vary_only_together) {
    Noise noise(7);
    auto cuts = published_cuts(noise);
    for (Cut& cut : cuts) {
        cut[depth] = 0.05 * cut[diameter] * (1.0 + noise.normal(0.005));
    }
    const auto found = fit(made_with(published_Ra(), cuts, noise, 0.1));
    LONGS_EQUAL((1U << diameter) | (1U << depth), found.undetermined);
    LONGS_EQUAL(depth, found.variable_it_goes_with(diameter));
    LONGS_EQUAL(diameter, found.variable_it_goes_with(depth));
}

TEST(RoughnessFit, holds_the_diameter_of_a_shop_with_one_tool) {
    Noise noise(8);
    auto cuts = published_cuts(noise);
    for (Cut& cut : cuts) {
        cut[diameter] = 6.0;
    }
    const auto found = fit(made_with(published_Ra(), cuts, noise, 0.1), 1U << diameter);
    CHECK(found.is_determined());
    LONGS_EQUAL(31, found.degrees_of_freedom);
    DOUBLES_EQUAL(0.0, found.model.exponent[diameter], 0.0);
    DOUBLES_EQUAL(0.964, found.model.exponent[speed], 3.0 * found.exponent_standard_error[speed]);
    const RoughnessPredictor<double> predictor(found.model);
    CHECK(predictor.predict({10000, 0.02, 6, 0.4, 1}).in_range());
    LONGS_EQUAL(1U << diameter, predictor.predict({10000, 0.02, 8, 0.4, 1}).outside);
}

TEST(RoughnessFit, refuses_as_many_tests_as_parameters_and_takes_one_more) {
    auto tests = tests_of_seed(9);
    std::swap(tests[1], tests[35]);
    std::swap(tests[2], tests[17]);
    std::swap(tests[3], tests[20]);
    tests.resize(6);
    CHECK(!fit(tests).is_determined());
    LONGS_EQUAL(0, fit(tests).degrees_of_freedom);
    tests.push_back(tests_of_seed(10)[25]);
    CHECK(fit(tests).is_determined());
    LONGS_EQUAL(1, fit(tests).degrees_of_freedom);
}

TEST(RoughnessFit, leaves_out_a_test_that_was_not_measured_and_points_at_the_odd_one) {
    auto tests = tests_of_seed(11);
    tests[4].roughness_um = -1.0;
    tests[5].cut[depth] = std::nan("");
    tests[20].roughness_um *= 2.0;  // seven standard deviations
    const auto found = fit(tests);
    LONGS_EQUAL(34, found.tests);
    LONGS_EQUAL(20, found.worst_test);
    CHECK(found.worst_residual > 3.5);
}
