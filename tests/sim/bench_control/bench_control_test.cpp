// SPDX-License-Identifier: Apache-2.0
#include "bench_control/bench_control.hpp"

#include <CppUTest/TestHarness.h>

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
