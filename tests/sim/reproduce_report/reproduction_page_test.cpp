// SPDX-License-Identifier: Apache-2.0
#include "made_up_papers.hpp"

#include "firmware/program/report/json_check.hpp"
#include "reproduce_report/reproduction_json.hpp"
#include "reproduce_report/reproduction_page.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::sim;

namespace {

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// The JSON that the page's script reads.
std::string page_data(const std::string& page) {
    const std::string open = "<script id=\"plots-data\" type=\"application/json\">";
    const std::size_t start = page.find(open) + open.size();
    return page.substr(start, page.find("</script>", start) - start);
}

}  // namespace

TEST_GROUP(ReproductionPage) {
    std::vector<Reproduction> papers{paper_with_everything(), paper_with_a_long_table(false)};
    std::string page = reproduction_page(papers);
};

TEST(ReproductionPage, shows_every_figure_plot_and_deviation) {
    for (const char* part : {"A made-up paper", "What it does.", "Eq. 1: difference", "Eq. 2: an error",
                             "Force over angle", "What to see.", "Printed with a slip."}) {
        CHECK_TEXT(holds(page, part), part);
    }
    for (int row = 1; row <= 20; ++row) {
        CHECK(holds(page, "row " + std::to_string(row) + ": error"));
    }
    CHECK(holds(page, "<div id=\"everything-1\">"));
    CHECK(holds(page_data(page), "\"everything-1\""));
    CHECK(holds(page_data(page), "\"band_low\""));
}

TEST(ReproductionPage, keeps_checks_of_our_own_apart_and_gives_reasons) {
    const std::size_t checks = page.find("<h3>Checks of our own</h3>");
    CHECK(checks != std::string::npos);
    CHECK(page.find("Eq. 6: a promise") > checks && page.find("Eq. 6: a promise") != std::string::npos);
    CHECK(holds(page, "<span class=\"reason\">not &lt;measured&gt; here.</span>"));
    CHECK(holds(page, "<strong>Fig. 7: &lt;points&gt;</strong>: they are not printed."));
    CHECK(holds(page, "6 figures, 5 within their bound, 1 shown without one; 2 checks of our own, 1 within"));
}

TEST(ReproductionPage, cites_the_paper_in_full_with_the_doi_where_it_is_known) {
    CHECK(holds(page,
                "A. Nobody &amp; B. Else: On a tool. Journal 3 (2001) 4–5. "
                "<a href=\"https://doi.org/10.1000/182\">doi:10.1000/182</a>"));
    papers[0].source.doi.clear();
    CHECK(holds(reproduction_page(papers), "4–5. No DOI is known here."));
}

TEST(ReproductionPage, gives_a_unit_in_each_row_or_says_that_there_is_none) {
    CHECK(holds(page, "Eq. 1: difference <span class=\"unit\">in N</span>"));
    CHECK(holds(page, "Eq. 3: a share <span class=\"unit\">(no unit)</span>"));
}

TEST(ReproductionPage, folds_a_long_table_unless_a_bound_in_it_is_broken) {
    CHECK(holds(page, "<details><summary><strong>Table 1</strong>: 20 figures, 20 within their bound"));
    const std::vector<Reproduction> broken{paper_with_a_long_table(true)};
    CHECK(holds(reproduction_page(broken), "<details open><summary><strong>Table 1</strong>: 20 figures, 19 within"));
}

TEST(ReproductionPage, escapes_what_papers_are_called) {
    CHECK(holds(page, "force &lt;of&gt; &amp; on a tool"));
    CHECK(!holds(page, "<of>"));
}

TEST(ReproductionPage, loads_nothing_from_elsewhere) {
    CHECK(holds(page, "default-src 'none'"));
    CHECK(!holds(page, "src=\"http"));
}

TEST(ReproductionPage, its_data_and_the_json_file_are_json_without_nan) {
    for (const std::string& json : {page_data(page), reproduction_json(papers)}) {
        CHECK(millforce::host::JsonCheck::valid(json));
        CHECK(!holds(json, "nan"));
        CHECK(!holds(json, "inf"));
        CHECK(holds(json, "null"));
    }
}

TEST(ReproductionPage, the_json_file_holds_every_figure_and_says_whether_bounds_hold) {
    const std::string json = reproduction_json(papers);
    for (const Reproduction& paper : papers) {
        for (const Figure& figure : paper.figures) {
            CHECK_TEXT(holds(json, figure.name.substr(0, figure.name.find('<'))), figure.name.c_str());
        }
        for (const Figure& check : paper.checks) {
            CHECK_TEXT(holds(json, check.name), check.name.c_str());
        }
    }
    CHECK(holds(json, "\"holds\": true"));
    CHECK(holds(json, "they are not printed."));
    const std::vector<Reproduction> broken{paper_with_a_long_table(true)};
    CHECK(holds(reproduction_json(broken).substr(0, 30), "\"holds\": false"));
}
