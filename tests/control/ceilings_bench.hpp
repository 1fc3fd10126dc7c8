// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "feed_bench.hpp"

#include <CppUTest/TestHarness.h>

/// What the tests of the ceilings share.

namespace millforce::control::bench {

inline void check_ratio(float expected, const Output& output, double tolerance = 1e-5) {
    DOUBLES_EQUAL(static_cast<double>(expected), static_cast<double>(output.ratio), tolerance);
}

inline Input with_way(Input input, float feed_mm_s) {
    input.way.known = true;
    input.way.feed_mm_s = feed_mm_s;
    return input;
}

}  // namespace millforce::control::bench
