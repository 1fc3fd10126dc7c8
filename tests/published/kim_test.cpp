// SPDX-License-Identifier: Apache-2.0
#include "reproduce/reproduction.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <string>

namespace {

using millforce::sim::Figure;
using millforce::sim::Reproduction;

long judged_with(const Reproduction& kim, const std::string& part) {
    return std::count_if(kim.figures.begin(), kim.figures.end(), [&](const Figure& figure) {
        return figure.judged != Figure::Judged::shown && figure.name.find(part) != std::string::npos;
    });
}

void check_that_the_papers_figures_are_drawn(const Reproduction& kim) {
    for (const std::string figure : {"Fig. 3", "Fig. 5", "Fig. 6", "Fig. 7", "Fig. 8a", "Fig. 8b"}) {
        CHECK_TEXT(std::any_of(kim.plots.begin(), kim.plots.end(),
                               [&](const auto& plot) { return plot.title.find(figure) != std::string::npos; }),
                   figure.c_str());
    }
    for (const auto& plot : kim.plots) {
        CHECK(!plot.caption.empty());
        for (const auto& series : plot.series) {
            CHECK(!series.x.empty());
            CHECK_EQUAL(series.x.size(), series.y.size());
        }
    }
}

}  // namespace

TEST_GROUP(Kim){};

// One test: the three steps on a dozen machines take some ten seconds and are made once.
TEST(Kim, rapid_calibration_holds_every_published_and_promised_figure) {
    const Reproduction kim = millforce::sim::reproduce_kim();
    for (const Figure& figure : kim.figures) {
        CHECK_TEXT(figure.holds(),
                   (figure.name + ": " + std::to_string(figure.ours) + " " + figure.bound_text()).c_str());
    }
    LONGS_EQUAL(3, judged_with(kim, "Table 1"));
    LONGS_EQUAL(4, judged_with(kim, "Table 2, carbide"));
    LONGS_EQUAL(4, judged_with(kim, "Table 4, HSS"));
    LONGS_EQUAL(8, judged_with(kim, "Table 5"));
    check_that_the_papers_figures_are_drawn(kim);
}
