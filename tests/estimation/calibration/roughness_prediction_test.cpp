// SPDX-License-Identifier: Apache-2.0
#include "estimation/calibration/roughness_cuts.hpp"
#include "estimation_calibration/roughness_in_double.hpp"

#include <CppUTest/TestHarness.h>

#include <limits>

using namespace millforce::estimation;
using namespace millforce::test;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

RoughnessModel<double> fitted_model(unsigned seed = 1, double ln_sd = 0.1) {
    Noise noise(seed);
    const auto cuts = published_cuts(noise);
    return fit(made_with(published_Ra(), cuts, noise, ln_sd)).model;
}

Measurement<double> force(double newton, double sd = 0.0) {
    return {true, newton, sd * sd, 0.0};
}

const Cut middle{10000, 0.02, 6, 0.4, 1.0};

/// How often R of a new test lies in the interval, in %: 1000 calibrations, one held-out test each. `sd` of either
/// force in the loop, relative.
double coverage_percent(unsigned seed, double ln_sd, double force_sd) {
    Noise noise(seed);
    int covered = 0;
    constexpr int trials = 1000;
    for (int k = 0; k < trials; ++k) {
        const auto cuts = published_cuts(noise);
        const RoughnessPredictor<double> predictor(fit(made_with(published_Ra(), cuts, noise, ln_sd)).model);
        const Cut cut = any_cut(noise);
        const double R = roughness_by_power_law_um(published_Ra(), cut) * std::exp(noise.normal(ln_sd));
        const double f_x = cut[4] * 100.0;
        const auto prediction = predictor.predict(cut, force(f_x * (1.0 + noise.normal(force_sd)), force_sd * f_x),
                                                  force(-100.0 * (1.0 + noise.normal(force_sd)), force_sd * 100.0));
        covered += prediction.valid && R >= prediction.low_um && R <= prediction.high_um ? 1 : 0;
    }
    return 100.0 * covered / trials;
}

}  // namespace

TEST_GROUP(RoughnessPrediction){};

TEST(RoughnessPrediction, has_the_published_value_of_both_models) {
    // By hand: 7.5e-6 · 10000^0.964 · 0.03^0.195 · 6^2.69 · 0.3^0.917 · 0.8^−2.6 and the like.
    const Cut cut{10000, 0.03, 6, 0.3, 0.8};
    DOUBLES_EQUAL(1.9944, RoughnessPredictor<double>(published_Ra()).predict(cut).roughness_um, 1e-4);
    DOUBLES_EQUAL(27.349, RoughnessPredictor<double>(published_Rz()).predict(cut).roughness_um, 1e-3);
}

TEST(RoughnessPrediction, covers_93_to_97_of_100_held_out_tests) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        const double percent = coverage_percent(seed, 0.15, 0.0);
        CHECK(percent >= 93.0 && percent <= 97.0);
    }
}

TEST(RoughnessPrediction, covers_as_many_where_two_motor_currents_tell_the_forces) {
    for (const unsigned seed : {4U, 5U}) {
        const double percent = coverage_percent(seed, 0.1, 0.04);
        CHECK(percent >= 93.0 && percent <= 97.0);
    }
}

TEST(RoughnessPrediction, grows_wider_away_from_the_tests) {
    const RoughnessPredictor<double> predictor(fitted_model());
    const auto here = predictor.predict(middle);
    const auto edge = predictor.predict({12000, 0.03, 8, 0.5, 1.2});
    const auto beyond = predictor.predict({24000, 0.03, 8, 0.5, 1.2});
    CHECK(here.in_range());
    CHECK(edge.in_range());
    CHECK(edge.high_um / edge.roughness_um > 1.01 * here.high_um / here.roughness_um);
    CHECK(beyond.high_um / beyond.roughness_um > 1.01 * edge.high_um / edge.roughness_um);
    LONGS_EQUAL((1U << roughness_spindle_speed), beyond.outside & 31U);
}

TEST(RoughnessPrediction, says_which_variable_lies_outside_the_fitted_range) {
    const RoughnessPredictor<double> predictor(fitted_model());
    const Cut low{7000, 0.005, 3, 0.2, 0.3};
    const Cut high{13000, 0.04, 9, 0.6, 1.7};
    for (std::size_t j = 0; j < middle.size(); ++j) {
        for (const Cut& limit : {low, high}) {
            Cut cut = middle;
            cut[j] = limit[j];
            LONGS_EQUAL(1U << j, predictor.predict(cut).outside & 31U);
            CHECK(!predictor.predict(cut).in_range());
        }
    }
    CHECK(predictor.predict({12050, 0.02, 6, 0.4, 1}).in_range());  // a spindle does not hold 12 000 rpm to the digit
}

TEST(RoughnessPrediction, says_where_only_the_combination_is_new) {
    Noise noise(12);
    auto cuts = published_cuts(noise);
    for (Cut& cut : cuts) {
        cut[4] = 0.5 * std::pow(cut[2] / 4.0, 1.5) * std::exp(noise.normal(0.05));  // small ρ with small tools alone
    }
    const RoughnessPredictor<double> predictor(fit(made_with(published_Ra(), cuts, noise, 0.1)).model);
    CHECK(predictor.predict({10000, 0.02, 4, 0.4, 0.5}).in_range());
    LONGS_EQUAL(RoughnessPrediction<double>::hidden_extrapolation,
                predictor.predict({10000, 0.02, 4, 0.4, 1.4}).outside);
}

TEST(RoughnessPrediction, of_a_published_model_has_no_interval_and_is_nothing_to_act_on) {
    auto model = published_Ra();
    model.minimum = {8000, 0.01, 4, 0.3, 0};
    model.maximum = {12000, 0.03, 8, 0.5, 0};
    const RoughnessPredictor<double> predictor(model);
    const auto prediction = predictor.predict(middle);
    CHECK(prediction.valid && prediction.in_range());
    CHECK(!prediction.has_interval);
    LONGS_EQUAL(1U << roughness_force_ratio, prediction.range_not_given);
    CHECK(!prediction.is_sure());
    CHECK(!predictor.feed_ceiling(middle, force(100), force(-100), 1.0).valid);
    CHECK(!predictor.predict({10000, 0.02, 12, 0.4, 1}).in_range());
}

TEST(RoughnessPrediction, needs_both_forces_clear_of_their_noise) {
    const RoughnessPredictor<double> predictor(fitted_model());
    CHECK(predictor.predict(middle, force(100, 5), force(-100, 5)).valid);
    CHECK(!predictor.predict(middle, force(100, 40), force(-100, 5)).valid);
    CHECK(!predictor.predict(middle, force(100, 5), force(-10, 5)).valid);
    CHECK(!predictor.predict(middle, Measurement<double>{}, force(-100, 5)).valid);  // x stands
    CHECK(!predictor.predict(middle, force(100, 5), Measurement<double>{}).valid);   // z stands
    CHECK(!predictor.predict(middle, force(100, 5), force(0, 0)).valid);
    CHECK(!predictor.predict(middle, force(100, 5), force(not_a_number, 1)).valid);
    CHECK(!predictor.predict(middle, force(100, 5), force(100, not_a_number)).valid);
}

TEST(RoughnessPrediction, gives_no_estimate_for_conditions_that_are_none) {
    const RoughnessPredictor<double> predictor(fitted_model());
    for (const double nothing : {0.0, -1.0, not_a_number, std::numeric_limits<double>::infinity()}) {
        for (std::size_t j = 0; j < middle.size(); ++j) {
            Cut cut = middle;
            cut[j] = nothing;
            CHECK(!predictor.predict(cut).valid);
        }
    }
    CHECK(!RoughnessPredictor<double>().predict(middle).valid);
}

TEST(RoughnessPrediction, finds_the_feed_at_which_the_upper_bound_meets_the_limit) {
    const RoughnessPredictor<double> predictor(fitted_model());
    const auto f_x = force(90, 2);
    const auto f_z = force(-100, 2);
    const auto upper = [&](double feed) {
        Cut cut = middle;
        cut[roughness_feed] = feed;
        return predictor.predict(cut, f_x, f_z).high_um;
    };
    const double limit = upper(0.017);
    const auto ceiling = predictor.feed_ceiling(middle, f_x, f_z, limit);
    CHECK(ceiling.valid && ceiling.reachable && ceiling.in_range);
    DOUBLES_EQUAL(0.017, ceiling.feed_mm_rev, 1e-5);
    CHECK(upper(ceiling.feed_mm_rev) <= limit);
    DOUBLES_EQUAL(0.03, predictor.feed_ceiling(middle, f_x, f_z, upper(0.03) * 2.0).feed_mm_rev, 1e-12);
}

TEST(RoughnessPrediction, stays_at_the_lowest_fitted_feed_where_no_feed_keeps_the_limit) {
    const RoughnessPredictor<double> predictor(fitted_model());
    const auto ceiling = predictor.feed_ceiling(middle, force(90), force(-100), 0.01);
    CHECK(ceiling.valid);
    CHECK(!ceiling.reachable);
    DOUBLES_EQUAL(0.01, ceiling.feed_mm_rev, 0.0);
}

TEST(RoughnessPrediction, gives_a_ceiling_out_of_range_where_the_cut_is) {
    const RoughnessPredictor<double> predictor(fitted_model());
    const auto ceiling = predictor.feed_ceiling({14000, 0.02, 6, 0.4, 1}, force(90), force(-100), 3.0);
    CHECK(ceiling.valid);
    CHECK(!ceiling.in_range);
    // The feed itself may be out: the ceiling is another one.
    CHECK(predictor.feed_ceiling({10000, 0.002, 6, 0.4, 1}, force(90), force(-100), 3.0).in_range);
}

TEST(RoughnessPrediction, gives_no_ceiling_where_a_slower_feed_would_not_help) {
    auto model = fitted_model();
    model.exponent[roughness_feed] = -0.1;
    CHECK(!RoughnessPredictor<double>(model).feed_ceiling(middle, force(90), force(-100), 1.0).valid);
}
