// SPDX-License-Identifier: Apache-2.0
#include "bench_control/bench_control.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "bench_control/load_control.hpp"
#include "bench_control/tuning.hpp"
#include "temporary_folder.hpp"

using namespace millforce;
using namespace millforce::sim;

TEST_GROUP(BenchControl) {
    test::TemporaryFolder folder;
    BenchSettings settings;

    void setup() override {
        settings.out = folder.path(".");
        settings.parts = {bench_parts()[4]};  // a slot
        settings.contenders = {contender_named("constant"), contender_named("haas")};
        settings.seeds = 2;
        settings.threads = 1;  // the leak detector of the tests knows one thread
        settings.rules = built_in_settings();
    }
};

/// Cut off after its first run, it gives the same file as in one go, and does not run again what it knows.
TEST(BenchControl, goes_on_where_it_stood) {
    const std::vector<BenchRun> whole = run_bench(settings, [](const std::string&, double) {});
    LONGS_EQUAL(4, whole.size());
    const std::string journal = folder.read("runs.csv");
    const std::size_t first_end = journal.find('\n', journal.find("slot_10,"));
    folder.write("runs.csv", journal.substr(0, first_end + 10));
    std::set<std::string> work;
    CHECK_TRUE(run_bench(settings, [&](const std::string& what, double) { work.insert(what); }) == whole);
    STRCMP_EQUAL(journal.c_str(), folder.read("runs.csv").c_str());
    work.clear();
    CHECK_TRUE(run_bench(settings, [&](const std::string& what, double) { work.insert(what); }) == whole);
    CHECK_TRUE(work.empty());
}

TEST(BenchControl, the_load_of_a_taught_cut_grows_with_its_feed) {
    const PreparedPart part = prepare(folder.path("."), bench_parts()[4]);
    const TaughtCut slow = taught_cut(part.on_machine[0], 0.5 * part.safe_ratio);
    const TaughtCut fast = taught_cut(part.on_machine[0], part.safe_ratio);
    CHECK_COMPARE(fast.load, >, 1.2 * slow.load);
    CHECK_COMPARE(fast.time_s, <, slow.time_s);
}

TEST(BenchControl, each_rule_is_taught_at_its_own_feed) {
    PreparedPart part = prepare(folder.path("."), bench_parts()[4]);
    teach(part, {{"constant", {1.0}}, {"haas", {0.5, 1.2, 1.1}}});
    LONGS_EQUAL(2, part.taught.size());
    DOUBLES_EQUAL(part.safe_ratio, part.taught["constant"].feed_ratio, 1e-12);
    DOUBLES_EQUAL(0.5 * part.safe_ratio, part.taught["haas"].feed_ratio, 1e-12);
    CHECK_COMPARE(part.taught["constant"].load, >, 1.2 * part.taught["haas"].load);
}

/// Where the depth steps up, what may come without warning holds the feed: at the safe feed it may go on.
TEST(BenchControl, ours_that_is_told_a_faster_safe_feed_is_faster) {
    const BenchPart& stairs = *std::ranges::find(bench_parts(), "stairs_8", &BenchPart::name);
    const PreparedPart part = prepare(folder.path("."), stairs);
    const auto time_s = [&](double feed_share) {
        return run_contender(*contender_named("ours_told"), part, 1, {{"ours_told", {feed_share, 1.3}}}).time_s;
    };
    CHECK_COMPARE(time_s(0.9), <, 0.9 * time_s(0.5));
}

/// Its mean forces over a hole are those of a wide and shallow cut, and then of none that fits.
TEST(BenchControl, no_tooth_breaks_over_holes_though_the_override_rises_as_fast_as_may_be_set) {
    const BenchPart& holes = *std::ranges::find(bench_parts(), "face_16_holes", &BenchPart::name);
    PreparedPart part = prepare(folder.path("."), holes);
    auto& control = part.on_machine[0].parameters.tool.control;
    control.recovery_per_rev = 1.0F;
    control.slew_up_per_s = 20.0F;
    for (const std::uint64_t plant : {101U, 103U}) {
        const BenchRun run = run_contender(*contender_named("ours"), part, plant, {});
        DOUBLES_EQUAL(0.0, run.teeth_broken, 0.0);
        CHECK_COMPARE(run.peak_over_limit, <, 1.3);
    }
}

/// The constant feed is at its fastest where its peaks just keep to 105 %: slower than that, the search goes up.
TEST(BenchControl, the_search_raises_a_constant_feed_that_is_slower_than_need_be) {
    std::vector<PreparedPart> parts{prepare(folder.path("."), bench_parts()[4])};
    const auto found = tuned_settings(rule_named("constant"), parts, {1, 1, 1}, 6, [](double) {});
    LONGS_EQUAL(1, found.size());
    CHECK_COMPARE(found[0], >, rule_named("constant").parameters[0].start);
    CHECK_COMPARE(found[0], <, 1.3);
}
