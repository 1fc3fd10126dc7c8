// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/student_t.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace millforce::estimation;

TEST_GROUP(StudentT){};

TEST(StudentT, gives_the_printed_quantiles) {
    const double published[][2] = {{1, 12.7062},  {2, 4.30265},  {3, 3.18245},  {4, 2.77645},
                                   {5, 2.57058},  {7, 2.36462},  {10, 2.22814}, {15, 2.13145},
                                   {20, 2.08596}, {30, 2.04227}, {60, 2.00030}, {120, 1.97993}};
    for (const auto& [freedom, t] : published) {
        DOUBLES_EQUAL(t, student_t_975(freedom), 1.3e-3 * t);
        DOUBLES_EQUAL(t, student_t_975(freedom), freedom >= 10 ? 2e-5 * t : 1.0);
    }
    CHECK(std::isnan(student_t_975(0.5)));
}
