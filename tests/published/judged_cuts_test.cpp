// SPDX-License-Identifier: Apache-2.0
#include "judging/judge.hpp"
#include "parameters/parameter_files.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

/// Cuts by an integration that shares nothing with the estimator; seeds that no figure was tuned on.

using namespace millforce;
using namespace millforce::judging;

namespace {

Tally tally_of(Wrong wrong, int cuts) {
    constexpr std::uint64_t first_seed = 90'001;
    const std::string scenarios = std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/";
    static const auto files =
        host::read_parameters(scenarios + "machines/vmc.toml", scenarios + "tools/endmill_10mm.toml");
    Tally tally;
    for (int i = 0; i < cuts; ++i) {
        tally.add(judge(draw_cut(files, wrong, first_seed + static_cast<std::uint64_t>(i))));
    }
    return tally;
}

}  // namespace

TEST_GROUP(JudgedCuts){};

TEST(JudgedCuts, hold_their_stated_intervals_whether_the_side_is_told_or_not) {
    for (const Wrong wrong : {Wrong::nothing, Wrong::nothing_stated}) {
        const Tally t = tally_of(wrong, 80);
        CHECK(t.cuts_with_immersion > 60);
        CHECK(100 * t.immersions_cover >= 93 * t.cuts_with_immersion);
        CHECK(100 * t.depths_cover >= 93 * t.cuts_with_depth);
        CHECK(1000 * t.immersions_beyond <= 3 * t.immersions);
        CHECK(1000 * t.depths_beyond <= 3 * t.depths);
        LONGS_EQUAL(0, t.depths_beyond_flute);
        LONGS_EQUAL(0, t.cuts_too_fast);
    }
}

TEST(JudgedCuts, let_no_tooth_meet_more_than_its_limit_where_the_side_is_wrong_or_an_axis_lies) {
    for (const Wrong wrong : {Wrong::side, Wrong::x_reversed, Wrong::x_dead, Wrong::x_tenfold, Wrong::axes_swapped}) {
        const Tally t = tally_of(wrong, 40);
        LONGS_EQUAL(0, t.depths_beyond_flute);
        LONGS_EQUAL(0, t.cuts_too_fast);
    }
}

TEST(JudgedCuts,
     let_no_tooth_meet_more_than_its_limit_where_the_spindle_is_weak_or_friction_or_edge_forces_are_others) {
    for (const Wrong wrong : {Wrong::spindle_weak, Wrong::x_friction, Wrong::edge_forces}) {
        const Tally t = tally_of(wrong, 40);
        LONGS_EQUAL(0, t.depths_beyond_flute);
        LONGS_EQUAL(0, t.cuts_too_fast);
    }
}
