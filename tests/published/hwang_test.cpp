// SPDX-License-Identifier: Apache-2.0
#include "reproduce/reproduction.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <string>

namespace {

void check_that_every_figure_holds(const millforce::sim::Reproduction& hwang) {
    for (const auto& figure : hwang.figures) {
        const std::string text = figure.name + ": " + std::to_string(figure.ours) + " " + figure.bound_text();
        CHECK_TEXT(figure.holds(), text.c_str());
    }
}

void check_that_no_row_of_Table_1_is_missing(const millforce::sim::Reproduction& hwang) {
    const auto count = [&](const std::string& part) {
        return std::count_if(hwang.figures.begin(), hwang.figures.end(),
                             [&](const auto& figure) { return figure.name.find(part) != std::string::npos; });
    };
    for (int row = 1; row <= 16; ++row) {
        CHECK_EQUAL(8, count("Table 1, row " + std::to_string(row) + " ("));  // seven immersions and the largest error
    }
    CHECK_EQUAL(3, count("Table 1, row 17"));
}

void check_that_the_papers_result_figures_are_drawn(const millforce::sim::Reproduction& hwang) {
    for (int paper_figure = 9; paper_figure <= 15; ++paper_figure) {
        const std::string name = "(Fig. " + std::to_string(paper_figure) + ")";
        CHECK(std::any_of(hwang.plots.begin(), hwang.plots.end(),
                          [&](const auto& plot) { return plot.title.find(name) != std::string::npos; }));
    }
    for (const auto& plot : hwang.plots) {
        CHECK(!plot.caption.empty());
        for (const auto& series : plot.series) {
            CHECK(!series.x.empty());
            CHECK_EQUAL(series.x.size(), series.y.size());
        }
    }
}

}  // namespace

TEST_GROUP(Hwang){};

// One test: the reproduction takes some ten seconds and is made once.
TEST(Hwang, immersion_from_force_drops_holds_every_published_and_promised_figure) {
    const millforce::sim::Reproduction hwang = millforce::sim::reproduce_hwang();
    check_that_every_figure_holds(hwang);
    check_that_no_row_of_Table_1_is_missing(hwang);
    check_that_the_papers_result_figures_are_drawn(hwang);
}
