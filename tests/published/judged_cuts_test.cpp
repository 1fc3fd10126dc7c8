// SPDX-License-Identifier: Apache-2.0
#include "judging/judge.hpp"
#include "judging/recording.hpp"
#include "judging/twin.hpp"
#include "parameters/parameter_files.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

/// Cuts by an integration that shares nothing with the estimator; seeds that no figure was tuned on.

using namespace millforce;
using namespace millforce::judging;

namespace {

DrawnCut cut_number(int i, Wrong wrong) {
    constexpr std::uint64_t first_seed = 90'001;
    const std::string scenarios = std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/";
    static const auto files =
        host::read_parameters(scenarios + "machines/vmc.toml", scenarios + "tools/endmill_10mm.toml");
    return draw_cut(files, wrong, first_seed + static_cast<std::uint64_t>(i));
}

Tally tally_of(Wrong wrong, int cuts) {
    Tally tally;
    for (int i = 0; i < cuts; ++i) {
        tally.add(judge(cut_number(i, wrong)));
    }
    return tally;
}

std::vector<Twin> twins_of(const DrawnCut& drawn) {
    const Recording recording = record(drawn);
    return TwinSearch(drawn, recording).twins_at(recording.samples.size());
}

/// Of the cut itself: it cuts as wide and, but for K_s, as deep.
bool is_the_same(const Twin& twin, const DrawnCut& drawn) {
    constexpr double immersion = 0.1;
    constexpr double depth_share = 0.5;
    const double off_mm = twin.cut.axial_depth_mm - drawn.cut.axial_depth_mm;
    return twin.cut.is_up == drawn.cut.is_up &&
           std::abs(twin.cut.radial_immersion - drawn.cut.radial_immersion) < immersion &&
           std::abs(off_mm) < depth_share * drawn.cut.axial_depth_mm;
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

/// Its twins show the same means, so it is one of them.
TEST(JudgedCuts, are_among_their_own_twins_where_nothing_is_wrong) {
    constexpr int cuts = 40;
    int found = 0;
    for (int i = 0; i < cuts; ++i) {
        const DrawnCut drawn = cut_number(i, Wrong::nothing);
        found += std::ranges::any_of(twins_of(drawn), [&](const Twin& twin) { return is_the_same(twin, drawn); });
    }
    CHECK(100 * found >= 93 * cuts);
}

TEST(JudgedCuts, have_no_twin_where_the_air_already_shows_that_an_axis_is_reversed) {
    int with_twin = 0;
    int moves_x = 0;
    for (int i = 0; i < 20; ++i) {
        const DrawnCut drawn = cut_number(i, Wrong::x_reversed);
        const bool x_moves = std::abs(std::cos(drawn.direction_rad)) > 0.1;
        moves_x += x_moves ? 1 : 0;
        with_twin += x_moves && !twins_of(drawn).empty() ? 1 : 0;
    }
    CHECK(moves_x > 10);
    LONGS_EQUAL(0, with_twin);
}

/// No estimator of averages can tell them apart: the table of sim/README.md.
TEST(JudgedCuts, of_a_saturated_spindle_are_too_fast_only_where_they_have_a_twin_that_is_not) {
    const Tally t = tally_of(Wrong::spindle_saturated, 40);
    CHECK(t.cuts_too_fast > 0);
    LONGS_EQUAL(t.cuts_too_fast, t.too_fast_with_twin);
    LONGS_EQUAL(t.immersions_beyond, t.beyond_with_twin);
}
