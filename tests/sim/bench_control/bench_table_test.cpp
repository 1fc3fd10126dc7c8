// SPDX-License-Identifier: Apache-2.0
#include "bench_control/bench_table.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <limits>

#include "bench_control/bench_plots.hpp"
#include "bench_control/tuning.hpp"
#include "temporary_folder.hpp"

using namespace millforce;
using namespace millforce::sim;

namespace {

BenchRun run_of(const std::string& part, const std::string& controller, std::uint64_t seed, double time_s,
                double peak) {
    return {part, controller, seed, time_s, time_s, peak, 0.0, 0.0, 0.0, 1.0};
}

/// Two plants on one part, one on another; ours takes 1.5, 2 and 3 times as long as the bound.
std::vector<BenchRun> known_runs() {
    std::vector<BenchRun> runs{
        run_of("slot_10", "plan", 1, 10.0, 1.0),   run_of("slot_10", "plan", 2, 20.0, 1.0),
        run_of("pocket_6", "plan", 1, 30.0, 1.02), run_of("slot_10", "ours", 1, 15.0, 0.8),
        run_of("slot_10", "ours", 2, 40.0, 0.9),   run_of("pocket_6", "ours", 1, 90.0, 1.1),
    };
    runs[5].teeth_broken = 2.0;
    runs[5].revolutions_over = 6.0;
    runs[5].rubbing_s = 14.5;
    return runs;
}

}  // namespace

TEST_GROUP(BenchTable){};

TEST(BenchTable, a_quantile_lies_between_two_values) {
    DOUBLES_EQUAL(2.5, quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 1e-12);
    DOUBLES_EQUAL(4.0, quantile({4.0, 1.0}, 1.0), 1e-12);
    constexpr double never = std::numeric_limits<double>::infinity();
    CHECK_TRUE(std::isinf(quantile({1.0, never, never}, 0.5)));
    CHECK_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(BenchTable, times_are_over_the_bound_of_the_same_part_and_plant) {
    const auto figures = figures_of_runs(known_runs());
    LONGS_EQUAL(2, figures.size());
    const ContenderFigures& ours = figures[0];
    STRCMP_EQUAL("ours", std::string(ours.contender->name).c_str());
    LONGS_EQUAL(3, ours.runs);
    DOUBLES_EQUAL(2.0, ours.time(0.5), 1e-12);
    DOUBLES_EQUAL(2.9, ours.time(0.95), 1e-12);
    DOUBLES_EQUAL(0.9, ours.peak(0.5), 1e-12);
    DOUBLES_EQUAL(1.1, ours.peak(1.0), 1e-12);
    LONGS_EQUAL(2, ours.teeth_broken);
    LONGS_EQUAL(1, ours.runs_with_a_broken_tooth);
    DOUBLES_EQUAL(2.0, ours.revolutions_over_mean, 1e-12);
    DOUBLES_EQUAL(0.1, ours.rubbing_share, 1e-12);
}

TEST(BenchTable, a_run_that_did_not_finish_counts_as_infinitely_long) {
    auto runs = known_runs();
    runs[3].finished = 0.0;
    runs[4].finished = 0.0;
    CHECK_TRUE(std::isinf(figures_of_runs(runs)[0].time(0.5)));
    LONGS_EQUAL(2, figures_of_runs(runs)[0].unfinished);
}

TEST(BenchTable, is_written_as_markdown) {
    const std::string text = markdown(table_of(figures_of_runs(known_runs())));
    CHECK_TRUE(test::contains(text,
                              "| millforce, without a map | 3 | 2.00 | 2.90 | 90 % | 108 % | 110 % | 2.0 | 2 in 1 run "
                              "| 10.0 % | 0 |\n"));
}

TEST(BenchTable, part_by_part_it_holds_medians) {
    const auto figures = figures_of_runs(known_runs());
    const auto parts = figures_of_parts(known_runs(), figures);
    LONGS_EQUAL(2, parts.size());
    STRCMP_EQUAL("pocket_6", parts[0].part.c_str());
    DOUBLES_EQUAL(3.0, parts[0].times_over_bound[0], 1e-12);
    DOUBLES_EQUAL(1.75, parts[1].times_over_bound[0], 1e-12);
}

TEST(BenchTable, the_plots_draw_what_it_holds) {
    const auto figures = figures_of_runs(known_runs());
    const auto plots = bench_plots(figures, figures_of_parts(known_runs(), figures));
    LONGS_EQUAL(3, plots.size());
    CHECK_TRUE(test::contains(plots[0].svg, ">millforce, without a map</text>"));
    CHECK_FALSE(test::contains(plots[0].svg, "clairvoyant bound</text>\n<text x=\"2"));
    CHECK_TRUE(test::contains(plots[2].svg, ">pocket_6</text>"));
}

TEST(BenchTable, a_time_beyond_the_scale_of_a_plot_is_told_beside_an_arrow) {
    auto runs = known_runs();
    runs[5].time_s = 6.3 * 30.0;
    const auto figures = figures_of_runs(runs);
    const auto plots = bench_plots(figures, figures_of_parts(runs, figures));
    CHECK_TRUE(test::contains(plots[2].svg, ">6.3</text>"));
    CHECK_TRUE(test::contains(plots[2].svg, "<path"));
    CHECK_FALSE(test::contains(plots[0].svg, "<path"));
}

TEST_GROUP(TuningCost){};

TEST(TuningCost, is_the_mean_logarithm_of_the_times_of_safe_runs) {
    DOUBLES_EQUAL(std::log(20.0), tuning_cost({run_of("a", "haas", 1, 10.0, 1.0), run_of("a", "haas", 2, 40.0, 1.05)}),
                  1e-9);
}

TEST(TuningCost, a_peak_beyond_105_percent_or_a_broken_tooth_outweighs_time) {
    const double safe = tuning_cost({run_of("a", "haas", 1, 20.0, 1.05)});
    CHECK_COMPARE(tuning_cost({run_of("a", "haas", 1, 10.0, 1.10)}), >, safe);
    BenchRun broken = run_of("a", "haas", 1, 10.0, 1.0);
    broken.teeth_broken = 1.0;
    CHECK_COMPARE(tuning_cost({broken}), >, safe);
}

TEST(TuningCost, the_settings_that_are_brought_along_are_whole) {
    const RuleSettings settings = built_in_settings();
    const test::TemporaryFolder folder;
    folder.write("tuned.toml", settings_text(settings, "a test"));
    CHECK_TRUE(read_settings(folder.path("tuned.toml").string()) == settings);
}
