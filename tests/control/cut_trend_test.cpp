// SPDX-License-Identifier: Apache-2.0
#include "control/cut_trend.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <random>

using Trend = millforce::control::CutTrend<float>;

namespace {

/// A stretch of a cut, seen in even steps.
struct Stretch {
    double from_mm;
    double to_mm;
    double step_mm;
    unsigned seed;
};

/// Follows a cut whose section is `section(s)` and whose noise is `noise(s)`; `seen(trend, s)` after each step.
template <typename Section, typename Noise, typename Seen>
void follow(const Stretch& way, Section section, Noise noise, Seen seen) {
    Trend trend;
    std::mt19937 random(way.seed);
    std::normal_distribution<double> normal;
    for (double s = way.from_mm; s < way.to_mm; s += way.step_mm) {
        trend.update(static_cast<float>(section(s) + noise(s) * normal(random)), static_cast<float>(noise(s)),
                     static_cast<float>(way.step_mm));
        seen(trend, s);
    }
}

/// The way until a cut is called fading, or a negative number; its noise is that of its start.
template <typename Section>
double way_until_fading(Section section, double length_mm, double noise_share = 0.0) {
    double first_mm = -1.0;
    follow(
        {0.0, length_mm, 0.05, 3}, section, [&](double) { return noise_share * section(0.0); },
        [&](const Trend& trend, double s) { first_mm = first_mm < 0.0 && trend.fading() ? s : first_mm; });
    return first_mm;
}

Trend in_a_steady_cut(float noise) {
    Trend trend;
    for (int k = 0; k < 100; ++k) {
        trend.update(10.0F, noise, 0.05F);
    }
    return trend;
}

}  // namespace

TEST_GROUP(CutTrend){};

TEST(CutTrend, takes_a_steady_cut_and_a_growing_one_for_no_fade) {
    CHECK(way_until_fading([](double) { return 10.0; }, 50.0) < 0.0);
    CHECK(way_until_fading([](double s) { return 1.0 + s; }, 50.0) < 0.0);
}

TEST(CutTrend, takes_a_ramp_in_depth_for_no_fade) {
    CHECK(way_until_fading([](double s) { return 9.0 - 7.0 * s / 110.0; }, 110.0) < 0.0);
}

TEST(CutTrend, sees_a_cut_that_ends_over_a_cutters_radius_before_half_of_it_is_gone) {
    const double seen_mm = way_until_fading([](double s) { return 10.0 * std::fmax(1.0 - s / 5.0, 0.0); }, 5.0);
    CHECK(seen_mm > 0.0);
    CHECK(seen_mm < 2.5);
    const double with_noise_mm =
        way_until_fading([](double s) { return 10.0 * std::fmax(1.0 - s / 5.0, 0.0); }, 5.0, 0.05);
    CHECK(with_noise_mm > 0.0);
    CHECK(with_noise_mm < 3.5);
}

TEST(CutTrend, ends_a_millimetre_after_a_step_down) {
    Trend trend = in_a_steady_cut(0.2F);
    trend.update(3.0F, 0.2F, 0.05F);
    CHECK(trend.fading());
    double way_mm = 0.0;
    while (trend.fading() && way_mm < 10.0) {
        trend.update(3.0F, 0.2F, 0.05F);
        way_mm += 0.05;
    }
    DOUBLES_EQUAL(1.0, way_mm, 0.1);
}

namespace {

/// A wall: the section grows three times over 3 mm, after `steady_mm` of a steady cut. The ways at which the cut is
/// first and last called growing, from the wall on; negative: never.
struct Growth {
    double first_mm = -1.0;
    double last_mm = -1.0;
};
Growth growth_at_a_wall(double steady_mm, double noise_share) {
    const auto section = [](double s) { return 10.0 + 20.0 * std::fmin(std::fmax(s / 3.0, 0.0), 1.0); };
    Growth growth;
    follow(
        {-steady_mm, 12.0, 0.02, 5}, section, [&](double s) { return noise_share * section(s); },
        [&](const Trend& trend, double s) {
            if (trend.growing()) {
                growth.first_mm = growth.first_mm < 0.0 ? s : growth.first_mm;
                growth.last_mm = s;
            }
        });
    return growth;
}

}  // namespace

TEST(CutTrend, sees_a_wall_from_its_first_half_millimetre_until_it_is_behind) {
    const Growth clean = growth_at_a_wall(5.0, 0.0);
    DOUBLES_EQUAL(0.25, clean.first_mm, 0.25);
    CHECK(clean.last_mm > 3.0);
    CHECK(clean.last_mm < 7.0);
    const Growth noisy = growth_at_a_wall(5.0, 0.05);
    DOUBLES_EQUAL(0.5, noisy.first_mm, 0.5);
    CHECK(noisy.last_mm > 3.0);
    CHECK(noisy.last_mm < 7.0);
}

TEST(CutTrend, takes_the_growth_of_an_entry_for_no_surge) {
    CHECK(growth_at_a_wall(0.0, 0.0).first_mm < 0.0);
}

TEST(CutTrend, sees_no_growth_in_a_steady_cut_or_a_ramp_in_depth) {
    for (const double slope : {0.0, 7.0 / 110.0}) {
        const auto section = [slope](double s) { return 5.0 + slope * s; };
        int steps = 0;
        int growing = 0;
        follow(
            {0.0, 80.0, 0.02, 7}, section, [&](double s) { return 0.03 * section(s); },
            [&](const Trend& trend, double) {
                ++steps;
                growing += trend.growing() ? 1 : 0;
            });
        CHECK(steps >= 4000);
        LONGS_EQUAL(0, growing);
    }
}

TEST(CutTrend, forgets_a_growth_with_the_cut) {
    Trend trend = in_a_steady_cut(0.0F);
    trend.update(13.0F, 0.0F, 0.05F);
    CHECK(trend.growing());
    trend.forget_growth();
    CHECK_FALSE(trend.growing());
    trend.update(16.0F, 0.0F, 0.05F);
    CHECK_FALSE(trend.growing());
}

TEST(CutTrend, is_not_moved_by_what_is_no_number) {
    Trend trend;
    trend.update(10.0F, 0.2F, 0.05F);
    trend.update(NAN, 0.2F, 0.05F);
    trend.update(10.0F, 0.2F, NAN);
    trend.update(-1.0F, 0.2F, 0.05F);
    CHECK_FALSE(trend.fading());
    trend.update(1.0F, 0.2F, 0.05F);
    CHECK(trend.fading());
}

TEST(CutTrend, forgets_all_of_a_cut_that_is_over) {
    Trend trend = in_a_steady_cut(0.0F);
    trend.update(13.0F, 0.0F, 0.05F);
    CHECK(trend.growing());
    trend.clear();
    CHECK_FALSE(trend.growing());
    CHECK_FALSE(trend.fading());
    trend.update(1.0F, 0.0F, 0.05F);  // the first section of the next cut
    CHECK_FALSE(trend.fading());
}

TEST(CutTrend, takes_a_low_section_within_its_noise_for_no_step_down) {
    Trend trend = in_a_steady_cut(0.0F);
    trend.update(7.0F, 3.0F, 0.05F);
    trend.update(10.0F, 0.0F, 0.05F);
    CHECK_FALSE(trend.growing());
}

TEST(CutTrend, follows_a_fall_at_once_only_where_it_is_a_step) {
    Trend small = in_a_steady_cut(0.0F);
    small.update(9.0F, 0.0F, 0.05F);
    small.update(10.0F, 0.0F, 0.05F);
    CHECK_FALSE(small.growing());
    Trend step = in_a_steady_cut(0.0F);
    step.update(7.9F, 0.0F, 0.05F);
    step.update(9.0F, 0.0F, 0.05F);
    CHECK(step.growing());
}
