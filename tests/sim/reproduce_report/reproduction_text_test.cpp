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

TEST(ReproductionText, keeps_checks_of_our_own_apart_from_the_papers_figures) {
    const std::string text = reproduction_text(paper_with_everything(), false);
    const std::size_t checks = text.find("\nchecks of our own ");
    CHECK(checks != std::string::npos);
    CHECK(text.find("Eq. 5: ") < checks);
    CHECK(text.find("Eq. 6: a promise ") > checks && text.find("Eq. 6: a promise ") != std::string::npos);
    CHECK(has(text, "\neverything: 6 figures, 5 within their bound, 1 shown without one\n"));
    CHECK(has(text, "\neverything: 2 checks of our own, 1 within their bound, 1 shown without one\n"));
}

TEST(ReproductionText, a_broken_check_of_our_own_breaks_the_reproduction) {
    Reproduction paper = paper_with_everything();
    CHECK(paper.holds());
    paper.checks[0].ours = 2.0;
    CHECK(!paper.holds());
    CHECK(has(reproduction_text(paper, false), "2 checks of our own, 0 within their bound, 1 BROKEN"));
}

TEST(ReproductionText, gives_a_figures_reason_and_why_something_is_not_reproduced) {
    const std::string text = reproduction_text(paper_with_everything(), false);
    CHECK(has(text, "\n  reason: not <measured> here.\n"));
    CHECK(has(text, "\nnot reproduced\n  Fig. 7: <points>: they are not printed.\n"));
}

TEST(ReproductionText, goes_on_in_the_next_line_with_a_long_name_and_keeps_its_columns) {
    Reproduction paper = paper_with_everything();
    paper.figures[0].name = "Eq. 1: a name that is far too long for its column, with ü and α_en in it, and goes on";
    paper.figures[0].reason =
        "one that is far longer than a line of the terminal, so that it has to go on in the next one";
    paper.not_reproduced[0].why =
        "a text that is far longer than one line of the terminal, so that it must be broken, once";
    std::istringstream text(reproduction_text(paper, false));
    for (std::string line; std::getline(text, line);) {
        const auto columns = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
        CHECK(columns <= 100);
        CHECK(line.empty() || line.back() != ' ');
    }
}

TEST(ReproductionText, a_figure_uses_all_of_its_bound_where_it_is_about_to_break) {
    const Reproduction paper = paper_with_everything();
    for (const Figure& figure : paper.figures) {
        const double use = use_of_bound(figure);
        CHECK(figure.judged == Figure::Judged::shown ? use < 0.0 : use > 0.0 && use < 1.0);
    }
    Figure figure{"", "", 10.0, 11.0, Figure::Judged::difference, 1.0};
    DOUBLES_EQUAL(1.0, use_of_bound(figure), 1e-9);
    figure.ours = std::numeric_limits<double>::quiet_NaN();
    CHECK(use_of_bound(figure) > 1.0);
}
