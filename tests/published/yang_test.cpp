// SPDX-License-Identifier: Apache-2.0
#include "reproduce/reproduction.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <string>

using namespace millforce::sim;

namespace {

double yang_figure(const Reproduction& reproduction, const std::string& name) {
    for (const Figure& figure : reproduction.figures) {
        if (figure.name == name) {
            return figure.ours;
        }
    }
    FAIL(("no figure of this name: " + name).c_str());
    return std::nan("");
}

void check_every_figure_holds(const Reproduction& reproduction) {
    int rows = 0;
    for (const Figure& figure : reproduction.figures) {
        CHECK_TRUE_TEXT(figure.holds(), (figure.name + ": " + std::to_string(figure.ours)).c_str());
        rows += figure.name.find(": error of") != std::string::npos ? 1 : 0;
    }
    CHECK_EQUAL(60, rows);  // thirty tests, both depths
}

/// Far below this the figures would have stopped measuring: corners under noise, runout and a low-pass.
void check_figures_still_measure(const Reproduction& reproduction) {
    const std::string published = "Tables 5–7: mean error, Table 1 on the resultant, angles against the nominal cut";
    CHECK(yang_figure(reproduction, published) > 0.8);
    CHECK(yang_figure(reproduction, "Tables 5–7: mean error, profile fit") > 0.02);
}

void check_hardness_deceives_the_published_method_only(const Reproduction& reproduction) {
    CHECK(yang_figure(reproduction, "Hardness +20 %: shift of δRDOC by the published method") > 15.0);
    CHECK(yang_figure(reproduction, "Hardness +20 %: shift of δRDOC by the profile fit") < 0.1);
}

void check_plots_are_drawable(const Reproduction& reproduction) {
    CHECK(reproduction.plots.size() >= 8);
    for (const Plot& plot : reproduction.plots) {
        CHECK(!plot.series.empty());
        for (const Plot::Series& series : plot.series) {
            CHECK(!series.x.empty());
            CHECK_EQUAL(series.x.size(), series.y.size());
        }
    }
}

}  // namespace

TEST_GROUP(Yang){};

// One test: the reproduction takes some 12 s, and must not outlive its test.
TEST(Yang, every_published_figure_holds_and_is_measured) {
    const Reproduction reproduction = reproduce_yang();
    check_every_figure_holds(reproduction);
    check_figures_still_measure(reproduction);
    check_hardness_deceives_the_published_method_only(reproduction);
    check_plots_are_drawable(reproduction);
}
