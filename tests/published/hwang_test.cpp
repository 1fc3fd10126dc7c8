// SPDX-License-Identifier: Apache-2.0
#include "reproduction_checks.hpp"

using namespace millforce::test;

namespace {

void check_that_no_row_of_Table_1_is_missing(const Reproduction& hwang) {
    for (int row = 1; row <= 16; ++row) {
        const std::string start = "Table 1 and section 3.2.2, row " + std::to_string(row) + " (";
        LONGS_EQUAL(8, count_beginning_with(hwang.figures, start));  // seven immersions and the largest error
    }
    LONGS_EQUAL(3, count_beginning_with(hwang.checks, "Table 1, row 17"));
}

}  // namespace

TEST_GROUP(Hwang){};

// One test: the reproduction takes some ten seconds and is made once.
TEST(Hwang, immersion_from_force_drops_holds_every_published_and_promised_figure) {
    const Reproduction hwang = millforce::sim::reproduce_hwang();
    check_reproduction(hwang);
    check_that_no_row_of_Table_1_is_missing(hwang);
    check_that_figures_are_drawn(hwang, {"Fig. 1", "Fig. 2", "Fig. 3", "Fig. 4", "Fig. 5", "Fig. 7", "Fig. 9",
                                         "Fig. 10", "Fig. 11", "Fig. 12", "Fig. 13", "Fig. 14", "Fig. 15"});
}
