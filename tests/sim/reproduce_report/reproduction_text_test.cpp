// SPDX-License-Identifier: Apache-2.0
#include "made_up_papers.hpp"

#include "reproduce_report/figure_tables.hpp"
#include "reproduce_report/reproduction_text.hpp"

#include <algorithm>
#include <sstream>

#include <CppUTest/TestHarness.h>

using namespace millforce::sim;

namespace {

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_GROUP(ReproductionText){};

TEST(ReproductionText, of_a_long_table_that_holds_shows_the_row_nearest_to_its_bound) {
    const std::string text = reproduction_text(paper_with_a_long_table(false), false);
    CHECK(has(text, "Table 1: 20 figures, 20 within their bound; the nearest to its bound:\n  row 20: error "));
    CHECK(!has(text, "row 19"));
    CHECK(has(text, "\nlong: 22 figures, 21 within their bound, 1 shown without one\n"));
}

TEST(ReproductionText, of_a_long_table_that_is_broken_shows_the_broken_rows) {
    const std::string text = reproduction_text(paper_with_a_long_table(true), false);
    CHECK(has(text, "  row 10: error "));
    CHECK(has(text, "BROKEN\n"));
    CHECK(!has(text, "row 20"));
    CHECK(has(text, "20 within their bound, 1 BROKEN"));
}

TEST(ReproductionText, shows_every_row_where_asked_for) {
    const std::string text = reproduction_text(paper_with_a_long_table(false), true);
    for (int row = 1; row <= 20; ++row) {
        CHECK(has(text, "Table 1, row " + std::to_string(row) + ": error"));
    }
}

TEST(ReproductionText, goes_on_in_the_next_line_with_a_long_name_and_keeps_its_columns) {
    Reproduction paper = paper_with_everything();
    paper.figures[0].name = "Eq. 1: a name that is far too long for its column, with ü and α_en in it, and goes on";
    std::istringstream text(reproduction_text(paper, false));
    for (std::string line; std::getline(text, line);) {
        const auto columns = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
        CHECK(columns <= 100);
        CHECK(line.empty() || line.back() != ' ');
    }
}

TEST(ReproductionText, a_figure_uses_all_of_its_bound_where_it_is_about_to_break) {
    for (const Figure& figure : paper_with_everything().figures) {
        const double use = use_of_bound(figure);
        CHECK(figure.judged == Figure::Judged::shown ? use < 0.0 : use > 0.0 && use < 1.0);
    }
    Figure figure{"", "", 10.0, 11.0, Figure::Judged::difference, 1.0};
    DOUBLES_EQUAL(1.0, use_of_bound(figure), 1e-9);
    figure.ours = std::numeric_limits<double>::quiet_NaN();
    CHECK(use_of_bound(figure) > 1.0);
}
