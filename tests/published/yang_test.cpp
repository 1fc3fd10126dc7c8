// SPDX-License-Identifier: Apache-2.0
#include "reproduction_checks.hpp"

#include <cmath>

using namespace millforce::test;

namespace {

double value_of(const std::vector<Figure>& figures, const std::string& name) {
    for (const Figure& figure : figures) {
        if (figure.name == name) {
            return figure.ours;
        }
    }
    FAIL(("no figure of this name: " + name).c_str());
    return std::nan("");
}

void check_that_no_test_is_missing(const Reproduction& yang) {
    const auto rows = std::count_if(yang.figures.begin(), yang.figures.end(), [](const Figure& figure) {
        return figure.name.find(": error of") != std::string::npos;
    });
    LONGS_EQUAL(60, rows);  // thirty tests, both depths
}

/// Far below this the figures would have stopped measuring: corners under noise, runout and a low-pass.
void check_that_figures_still_measure(const Reproduction& yang) {
    CHECK(value_of(yang.figures, "Tables 5–7: mean error, the published method") > 0.8);
    CHECK(value_of(yang.figures, "Tables 5–7: mean error, profile fit (ours)") > 0.02);
}

void check_that_hardness_deceives_the_published_method_only(const Reproduction& yang) {
    CHECK(value_of(yang.checks, "Hardness +20 %: shift of δRDOC by the published method") > 15.0);
    CHECK(value_of(yang.checks, "Hardness +20 %: shift of δRDOC by the profile fit") < 0.1);
}

}  // namespace

TEST_GROUP(Yang){};

// One test: the reproduction takes some 12 s, and must not outlive its test.
TEST(Yang, every_published_figure_holds_and_is_measured) {
    const Reproduction yang = millforce::sim::reproduce_yang();
    check_reproduction(yang);
    check_that_no_test_is_missing(yang);
    check_that_figures_still_measure(yang);
    check_that_hardness_deceives_the_published_method_only(yang);
    check_that_figures_are_drawn(yang, {"Fig. 5", "Fig. 6", "Fig. 7", "Fig. 8", "Fig. 10", "Fig. 11", "Fig. 13",
                                        "Fig. 14", "Fig. 15", "Fig. 16a", "Fig. 16b", "Fig. 16c"});
}
