#include "reproduce/reproduction.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <string>

namespace {

const millforce::sim::Reproduction& hwang() {
    static const millforce::sim::Reproduction reproduction = millforce::sim::reproduce_hwang();
    return reproduction;
}

}  // namespace

// The reproduction is made once, and stays until the program ends.
TEST_GROUP(Hwang) {
    void setup() override {
        UtestShell::getCurrent();
        MemoryLeakWarningPlugin::getFirstPlugin()->expectLeaksInTest(0);
    }
};

TEST(Hwang, every_figure_holds_its_bound) {
    for (const auto& figure : hwang().figures) {
        const std::string text = figure.name + ": " + std::to_string(figure.ours) + " " + figure.bound_text();
        CHECK_TEXT(figure.holds(), text.c_str());
    }
}

TEST(Hwang, has_every_row_of_Table_1_and_every_immersion) {
    const auto count = [](const char* part) {
        return std::count_if(hwang().figures.begin(), hwang().figures.end(), [&](const auto& figure) {
            return figure.name.find(part) != std::string::npos;
        });
    };
    for (int row = 1; row <= 17; ++row) {
        CHECK(count(("Table 1, row " + std::to_string(row) + " (").c_str()) >= 1);
    }
    CHECK_EQUAL(16, count(": immersion 0.2"));
    CHECK_EQUAL(16, count(": immersion 0.8"));
}

TEST(Hwang, draws_a_plot_for_each_of_the_papers_result_figures) {
    for (int paper_figure = 9; paper_figure <= 15; ++paper_figure) {
        const std::string name = "(Fig. " + std::to_string(paper_figure) + ")";
        CHECK(std::any_of(hwang().plots.begin(), hwang().plots.end(),
                          [&](const auto& plot) { return plot.title.find(name) != std::string::npos; }));
    }
}

TEST(Hwang, plots_are_whole) {
    for (const auto& plot : hwang().plots) {
        CHECK(!plot.caption.empty());
        for (const auto& series : plot.series) {
            CHECK(!series.x.empty());
            CHECK_EQUAL(series.x.size(), series.y.size());
        }
    }
}
