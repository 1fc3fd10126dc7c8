// SPDX-License-Identifier: Apache-2.0
#include "run_report/run_history.hpp"

#include <cmath>
#include <filesystem>
#include <string>

#include "history_bench.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::host::test;
using millforce::control::CutState;
using millforce::control::Limit;

namespace {

std::size_t place(Limit limit) {
    return static_cast<std::size_t>(limit);
}

}  // namespace

TEST_GROUP(RunHistory) {
    RunHistory history{endmill()};
};

TEST(RunHistory, keeps_the_one_peak_of_a_day_in_as_many_bins_as_of_a_second) {
    constexpr int ticks = 200'000;  // of 0.45 s each: 25 h
    for (int k = 0; k < ticks; ++k) {
        history.add(0.45 * k, in_cut(k == 123'457 ? 0.95F : 0.5F), 0);
    }
    CHECK(history.bins().size() <= RunHistory::bin_capacity);
    CHECK(history.bins().size() > RunHistory::bin_capacity / 2);
    float highest_N = 0.0F;
    std::size_t highest_bin = 0;
    for (std::size_t k = 0; k < history.bins().size(); ++k) {
        if (history.bins()[k].tooth_force_N.high > highest_N) {
            highest_N = history.bins()[k].tooth_force_N.high;
            highest_bin = k;
        }
    }
    DOUBLES_EQUAL(0.95F * tooth_force_limit_N, highest_N, 0.01);
    DOUBLES_EQUAL(0.45 * 123'457, history.bin_width_s() * (static_cast<double>(highest_bin) + 0.5),
                  0.51 * history.bin_width_s());
    DOUBLES_EQUAL(0.45 * 123'457, history.totals().peak.time_s, 1e-6);
}

TEST(RunHistory, gives_each_ceiling_the_time_for_which_it_held_and_all_of_it_to_one_of_them) {
    for (int k = 0; k <= 1000; ++k) {
        history.add(0.001 * k, k <= 400 ? in_air() : in_cut(0.9F, k <= 900 ? Limit::force : Limit::surge), 0);
    }
    const RunTotals& totals = history.totals();
    DOUBLES_EQUAL(0.4, totals.ceilings.of(Limit::air_feed), 1e-9);
    DOUBLES_EQUAL(0.0, totals.ceilings.in_cut(Limit::air_feed), 1e-9);
    DOUBLES_EQUAL(0.5, totals.ceilings.in_cut(Limit::force), 1e-9);
    DOUBLES_EQUAL(0.1, totals.ceilings.in_cut(Limit::surge), 1e-9);
    double all_s = 0.0;
    for (const double held_s : totals.ceilings.held_s) {
        all_s += held_s;
    }
    DOUBLES_EQUAL(totals.length_s, all_s, 1e-9);
    DOUBLES_EQUAL(0.6, totals.ceilings.cut_s, 1e-9);
    DOUBLES_EQUAL(0.5, totals.override_ratio.mean(), 1e-6);
    double binned_s = 0.0;
    for (const RunBin& bin : history.bins()) {
        binned_s += static_cast<double>(bin.held_s[place(Limit::force)]);
    }
    DOUBLES_EQUAL(0.5, binned_s, 1e-5);
}

TEST(RunHistory, blames_no_ceiling_for_time_without_ticks_and_shows_a_gap) {
    history.add(10.0, in_cut(0.5F), 0);
    history.add(10.1, in_cut(0.5F), 0);
    history.add(15.0, in_cut(0.5F), 0);
    DOUBLES_EQUAL(5.0, history.totals().length_s, 1e-9);
    DOUBLES_EQUAL(4.9, history.totals().missing_s, 1e-9);
    DOUBLES_EQUAL(0.1, history.totals().ceilings.cut_s, 1e-9);
    const auto middle = static_cast<std::size_t>(2.5 / history.bin_width_s());
    CHECK(history.bins()[middle].is_empty);
    CHECK(history.bins()[middle].radial_immersion.is_empty());
}

TEST(RunHistory, tells_a_load_from_the_most_that_it_can_have_been) {
    history.add(0.0, entering(1.3F), 0);
    history.add(0.1, entering(1.3F), 0);
    history.add(0.2, in_cut(0.8F), 0);
    const RunTotals& totals = history.totals();
    DOUBLES_EQUAL(0.8, totals.peak.share, 1e-6);
    DOUBLES_EQUAL(0.0, totals.peak.over_limit_s, 1e-9);
    DOUBLES_EQUAL(1.3, totals.bound.share, 1e-6);
    DOUBLES_EQUAL(0.1, totals.bound.over_limit_s, 1e-9);
    CHECK(history.bins().front().tooth_force_N.is_empty());
    CHECK_FALSE(history.bins().front().tooth_force_bound_N.is_empty());
}

TEST(RunHistory, compares_a_load_with_the_limit_of_the_tool_that_cut) {
    const millforce::test::TemporaryFolder folder;
    const std::filesystem::path tools = std::filesystem::path(MILLFORCE_SOURCE_DIR) / "sim/scenarios/tools";
    std::filesystem::copy(tools / "endmill_10mm.toml", folder.path("T5.toml"));   // 700 N
    std::filesystem::copy(tools / "facemill_40mm.toml", folder.path("T7.toml"));  // 600 N
    RunHistory of_tools(ToolSet({}, {"", folder.path("").string()}));
    for (const std::uint32_t number : {0U, 5U, 7U}) {
        of_tools.add(0.1 * number, in_cut(0.6F), number);  // 420 N
    }
    DOUBLES_EQUAL(420.0 / 600.0, of_tools.totals().peak.share, 1e-6);
    CHECK(of_tools.bins().front().tooth_force_limit_N.is_empty());  // the tool is not known
    const auto events = of_tools.events();
    UNSIGNED_LONGS_EQUAL(3, events.size());
    STRCMP_EQUAL("Tool 7.", events[2].text.c_str());
}

TEST(RunHistory, has_no_immersion_and_no_band_where_there_was_no_estimate) {
    history.add(0.0, in_cut(0.5F), 0);
    history.add(0.1, in_air(), 0);
    const RunBin& with = history.bins().front();
    DOUBLES_EQUAL(0.6 - 1.96 * 0.05, with.radial_immersion_band.low, 1e-3);
    DOUBLES_EQUAL(0.6 + 1.96 * 0.05, with.radial_immersion_band.high, 1e-3);
    const RunBin& without = history.bins().back();
    CHECK_FALSE(without.is_empty);
    CHECK(without.radial_immersion.is_empty());
    CHECK(without.radial_immersion_band.is_empty());
}

TEST(RunHistory, shows_a_short_hold_in_a_long_bin) {
    for (int k = 0; k < 100'000; ++k) {
        auto tick = in_cut(0.5F);
        if (k == 50'000) {
            tick.feed_override.state = static_cast<std::uint8_t>(CutState::hold);
        }
        history.add(0.1 * k, tick, 0);
    }
    bool is_shown = false;
    for (const RunBin& bin : history.bins()) {
        is_shown = is_shown || bin.state == static_cast<std::uint8_t>(CutState::hold);
    }
    CHECK(is_shown);
}

TEST(RunHistory, counts_on_where_a_log_holds_several_runs_and_the_clock_starts_again) {
    history.add(100.0, in_cut(0.5F), 0);
    history.add(100.2, in_cut(0.5F), 0);
    history.add(1.0, in_cut(0.5F), 0);
    history.add(1.3, in_cut(0.5F), 0);
    DOUBLES_EQUAL(0.5, history.totals().length_s, 1e-9);
    DOUBLES_EQUAL(0.0, history.totals().missing_s, 1e-9);
}

TEST(RunHistory, keeps_the_first_of_endless_events_and_the_last_and_says_how_many_are_left_out) {
    history.add(0.0, in_air(), 0);
    for (int k = 1; k <= 5000; ++k) {
        auto tick = in_air();
        tick.feed_override.fault = static_cast<std::uint8_t>(k % 2);
        history.add(0.01 * k, tick, 0);
    }
    const auto events = history.events();
    UNSIGNED_LONGS_EQUAL(RunHistory::event_capacity, events.size());
    CHECK(events.front().is_fault);
    STRCMP_CONTAINS("overload", events.front().text.c_str());
    DOUBLES_EQUAL(50.0, events.back().time_s, 1e-9);
    UNSIGNED_LONGS_EQUAL(5000 - RunHistory::event_capacity, history.events_left_out());
}

TEST(RunHistory, puts_what_happened_before_the_first_tick_at_its_begin) {
    history.note(3.0, "The CNC connected.");
    history.add(7.0, in_air(), 0);
    history.add(8.0, in_air(), 0);
    history.note(7.5, "Halfway.");
    const auto events = history.events();
    DOUBLES_EQUAL(0.0, events[0].time_s, 1e-9);
    DOUBLES_EQUAL(0.5, events[1].time_s, 1e-9);
}
