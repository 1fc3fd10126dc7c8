// SPDX-License-Identifier: Apache-2.0
#include "reproduction_checks.hpp"

using namespace millforce::test;

TEST_GROUP(Kim){};

// One test: the three steps on a dozen machines take some ten seconds and are made once.
TEST(Kim, rapid_calibration_holds_every_published_and_promised_figure) {
    const Reproduction kim = millforce::sim::reproduce_kim();
    check_reproduction(kim);
    LONGS_EQUAL(3, count_beginning_with(kim.figures, "Table 1: "));
    LONGS_EQUAL(4, count_beginning_with(kim.figures, "Table 2, carbide: "));
    LONGS_EQUAL(4, count_beginning_with(kim.figures, "Table 4, HSS: "));
    LONGS_EQUAL(5, count_beginning_with(kim.figures, "Table 3: "));
    LONGS_EQUAL(2, count_beginning_with(kim.figures, "Table 5, carbide: "));
    LONGS_EQUAL(2, count_beginning_with(kim.figures, "Table 5, HSS: "));
    LONGS_EQUAL(4, count_beginning_with(kim.figures, "Table 5 against "));
    LONGS_EQUAL(3 + 8 + 4, count_judged(kim.figures));
    check_that_figures_are_drawn(kim, {"Fig. 3", "Fig. 5", "Fig. 6", "Fig. 7", "Fig. 8a", "Fig. 8b"});
}
