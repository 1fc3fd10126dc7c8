// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/standard_cut_fit.hpp"

#include "estimation/fit_statistics.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <vector>

using namespace millforce::estimation;
using millforce::test::Coverage;
using millforce::test::Noise;
using millforce::test::student_t_95;

namespace {

constexpr double K_t1 = 0.7;
constexpr double K_t2 = -0.61;
constexpr double K_x4 = 120.0;
constexpr double K_x5 = -3.0;
constexpr double kappa = 1.1;

struct KnownCut {
    double torque_Nm;
    double force_N;
    double feed_m_per_min;
};

StandardCutStretch stretch(const KnownCut& cut, double drift, Noise& noise, double sd_A) {
    StandardCutStretch s;
    s.torque_Nm = cut.torque_Nm;
    s.drift = drift;
    s.spindle_current_A = (cut.torque_Nm - K_t2) / K_t1 + 0.2 * drift + noise.normal(sd_A);
    s.feed_m_per_min = cut.feed_m_per_min;
    s.friction_current_A = std::copysign(1.6 + 0.6 * std::abs(cut.feed_m_per_min), cut.feed_m_per_min);
    s.feed_force_N = cut.force_N;
    s.feed_current_A =
        kappa * s.friction_current_A + (cut.force_N - K_x5 / cut.feed_m_per_min) / K_x4 + noise.normal(sd_A);
    s.in_cut = cut.torque_Nm > 0.0;
    return s;
}

const std::vector<KnownCut> cuts{
    {0.45, -78, 0.1}, {0.9, -161, 0.25}, {1.9, -359, 0.7}, {0.5, -100, 0.25}, {1.6, -226, 0.25}};

/// Each cut after running in air at its feed, while the bearing warms up.
std::vector<StandardCutStretch> campaign(const std::vector<KnownCut>& of, Noise& noise, double sd_A,
                                         bool with_air = true) {
    std::vector<StandardCutStretch> stretches;
    for (std::size_t k = 0; k < of.size(); ++k) {
        const double drift = std::exp(-static_cast<double>(k) / 4.0);
        if (with_air) {
            stretches.push_back(stretch({0.0, 0.0, of[k].feed_m_per_min}, drift, noise, sd_A));
        }
        stretches.push_back(stretch(of[k], drift * 0.95, noise, sd_A));
    }
    return stretches;
}

}  // namespace

TEST_GROUP(StandardCutFit) {
    Noise noise{1};

    void lacks(StandardCutLack spindle, StandardCutLack feed, const std::vector<KnownCut>& of, bool with_air = true) {
        const auto stretches = campaign(of, noise, 0.003, with_air);
        LONGS_EQUAL(static_cast<int>(spindle), static_cast<int>(fit_spindle_gain(stretches).lack));
        LONGS_EQUAL(static_cast<int>(feed), static_cast<int>(fit_feed_gain(stretches).lack));
    }
};

TEST(StandardCutFit, exact_currents_give_the_exact_gains) {
    const auto stretches = campaign(cuts, noise, 0.0);
    const auto spindle = fit_spindle_gain(stretches);
    const auto feed = fit_feed_gain(stretches);
    DOUBLES_EQUAL(K_t1, spindle.gain, 1e-9);
    DOUBLES_EQUAL(K_t2, spindle.offset, 1e-9);
    DOUBLES_EQUAL(0.2, spindle.nuisance, 1e-9);
    DOUBLES_EQUAL(K_x4, feed.gain, 1e-6);
    DOUBLES_EQUAL(K_x5, feed.offset, 1e-6);
    DOUBLES_EQUAL(kappa, feed.nuisance, 1e-9);
}

TEST(StandardCutFit, standard_errors_cover_in_every_direction_of_feed) {
    std::vector<KnownCut> backwards = cuts;
    for (KnownCut& cut : backwards) {
        cut.force_N = -cut.force_N;
        cut.feed_m_per_min = -cut.feed_m_per_min;
    }
    Coverage gains, offsets;
    for (int k = 0; k < 1000; ++k) {
        const auto stretches = campaign(k % 2 == 0 ? cuts : backwards, noise, 0.01);
        const double quantile = student_t_95(7.0);
        const auto spindle = fit_spindle_gain(stretches);
        const auto feed = fit_feed_gain(stretches);
        gains.add(K_t1, spindle.gain, spindle.gain_se, quantile);
        gains.add(K_x4, feed.gain, feed.gain_se, quantile);
        offsets.add(K_t2, spindle.offset, spindle.offset_se, quantile);
        offsets.add(K_x5, feed.offset, feed.offset_se, quantile);
    }
    DOUBLES_EQUAL(95.0, gains.percent(), 2.0);
    DOUBLES_EQUAL(95.0, offsets.percent(), 2.0);
}

TEST(StandardCutFit, without_K_x5_knows_K_x4_better) {
    auto stretches = campaign(cuts, noise, 0.01);
    for (StandardCutStretch& s : stretches) {
        s.feed_current_A += K_x5 / s.feed_m_per_min / K_x4;  // a drive that has none
    }
    const auto with = fit_feed_gain(stretches);
    const auto without = fit_feed_gain(stretches, {.fits_K_x5 = false});
    DOUBLES_EQUAL(K_x4, without.gain, 3.0 * without.gain_se);
    DOUBLES_EQUAL(0.0, without.offset, 1e-6);
    CHECK(without.gain_se < with.gain_se);
}

TEST(StandardCutFit, hardly_differs_for_currents_rounded_to_float) {
    const auto stretches = campaign(cuts, noise, 0.003);
    const auto rounded = [](double value) { return static_cast<double>(static_cast<float>(value)); };
    std::vector<StandardCutStretch> coarse;
    for (const StandardCutStretch& s : stretches) {
        coarse.push_back({rounded(s.spindle_current_A), rounded(s.torque_Nm), rounded(s.drift),
                          rounded(s.feed_current_A), rounded(s.friction_current_A), rounded(s.feed_m_per_min),
                          rounded(s.feed_force_N), 1.0, s.in_cut});
    }
    DOUBLES_EQUAL(fit_spindle_gain(stretches).gain, fit_spindle_gain(coarse).gain, 1e-4);
    DOUBLES_EQUAL(fit_feed_gain(stretches).gain, fit_feed_gain(coarse).gain, 0.02);
}

TEST(StandardCutFit, names_what_is_missing) {
    using enum StandardCutLack;
    lacks(cut, cut, {{0.0, 0.0, 0.25}, {0.0, 0.0, 0.5}});
    lacks(air, air, cuts, false);
    lacks(second_load, second_feed, {{0.9, -161, 0.25}, {0.9, -161, 0.25}, {0.9, -161, 0.25}});
    lacks(nothing, second_feed, {{0.5, -100, 0.25}, {0.9, -161, 0.25}, {1.6, -226, 0.25}});
    lacks(second_load, second_load, {{0.9, -161, 0.1}, {0.9, -161, 0.25}, {0.9, -161, 0.7}});
    lacks(response, response, {{1e-4, -0.01, 0.1}, {2e-4, -0.02, 0.25}, {3e-4, -0.03, 0.7}});
}

TEST(StandardCutFit, two_rows_leave_no_standard_error) {
    const auto stretches = campaign({cuts[0]}, noise, 0.003);
    CHECK(fit_spindle_gain(stretches).lack != StandardCutLack::nothing);
}
