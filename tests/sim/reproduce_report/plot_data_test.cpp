// SPDX-License-Identifier: Apache-2.0
#include "reproduce_report/plot_data.hpp"

#include <algorithm>
#include <limits>

#include <CppUTest/TestHarness.h>

using namespace millforce::sim;

namespace {

Plot::Series long_series(Plot::Series::Style style) {
    Plot::Series series{"long", style, {}, {}};
    for (int k = 0; k < 100000; ++k) {
        series.x.push_back(k);
        series.y.push_back(k == 12345 ? 50.0 : (k == 54321 ? -40.0 : k % 7));
    }
    return series;
}

}  // namespace

TEST_GROUP(PlotData){};

TEST(PlotData, a_long_line_is_bounded_and_keeps_its_peaks_in_place) {
    const Plot::Series kept = decimated(long_series(Plot::Series::Style::line));
    CHECK(kept.x.size() <= plot_point_count);
    LONGS_EQUAL(kept.x.size(), kept.y.size());
    CHECK(std::is_sorted(kept.x.begin(), kept.x.end()));
    const auto highest = std::max_element(kept.y.begin(), kept.y.end()) - kept.y.begin();
    DOUBLES_EQUAL(12345.0, kept.x[static_cast<std::size_t>(highest)], 0.0);
    DOUBLES_EQUAL(-40.0, *std::min_element(kept.y.begin(), kept.y.end()), 0.0);
}

TEST(PlotData, a_band_keeps_its_outermost_values) {
    const Plot::Series low = decimated(long_series(Plot::Series::Style::band_low));
    const Plot::Series high = decimated(long_series(Plot::Series::Style::band_high));
    DOUBLES_EQUAL(-40.0, *std::min_element(low.y.begin(), low.y.end()), 0.0);
    DOUBLES_EQUAL(0.0, *std::max_element(low.y.begin(), low.y.end()), 0.0);
    DOUBLES_EQUAL(6.0, *std::min_element(high.y.begin(), high.y.end()), 0.0);
}

TEST(PlotData, a_gap_stays_one) {
    Plot::Series series = long_series(Plot::Series::Style::line);
    std::fill(series.y.begin() + 20000, series.y.begin() + 30000, std::numeric_limits<double>::quiet_NaN());
    const Plot::Series kept = decimated(series);
    const auto is_gap = [](double value) { return value != value; };
    CHECK(std::count_if(kept.y.begin(), kept.y.end(), is_gap) >= 25);
}
