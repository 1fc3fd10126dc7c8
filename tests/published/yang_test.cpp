#include "reproduce/reproduction.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <string>

using namespace millforce::sim;

namespace {

const Reproduction& yang_reproduction() {
    static const Reproduction reproduction = reproduce_yang();
    return reproduction;
}

double yang_figure(const std::string& name) {
    for (const Figure& figure : yang_reproduction().figures) {
        if (figure.name == name) {
            return figure.ours;
        }
    }
    FAIL(("no figure of this name: " + name).c_str());
    return std::nan("");
}

}  // namespace

TEST_GROUP(Yang){};

TEST(Yang, every_figure_holds) {
    for (const Figure& figure : yang_reproduction().figures) {
        CHECK_TRUE_TEXT(figure.holds(), (figure.name + ": " + std::to_string(figure.ours)).c_str());
    }
}

TEST(Yang, all_thirty_tests_are_there_with_both_depths) {
    int rows = 0;
    for (const Figure& figure : yang_reproduction().figures) {
        rows += figure.name.find(": error of") != std::string::npos ? 1 : 0;
    }
    CHECK_EQUAL(60, rows);
}

TEST(Yang, the_published_method_is_no_better_than_its_formulas_can_be) {
    // Far below this the figures would have stopped measuring: corners under noise, runout and a low-pass.
    CHECK(yang_figure("Tables 5–7: mean error, Table 1 on the resultant, angles against the nominal cut") > 0.8);
    CHECK(yang_figure("Tables 5–7: mean error, profile fit") > 0.02);
}

TEST(Yang, a_harder_piece_deceives_the_published_method_and_not_the_fit) {
    CHECK(yang_figure("Hardness +20 %: shift of δRDOC by the published method") > 15.0);
    CHECK(yang_figure("Hardness +20 %: shift of δRDOC by the profile fit") < 0.1);
}

TEST(Yang, plots_are_drawable) {
    CHECK(yang_reproduction().plots.size() >= 8);
    for (const Plot& plot : yang_reproduction().plots) {
        CHECK(!plot.series.empty());
        for (const Plot::Series& series : plot.series) {
            CHECK(!series.x.empty());
            CHECK_EQUAL(series.x.size(), series.y.size());
        }
    }
}
