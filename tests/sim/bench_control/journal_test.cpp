// SPDX-License-Identifier: Apache-2.0
#include "bench_control/journal.hpp"

#include <CppUTest/TestHarness.h>

#include "files/input_error.hpp"
#include "temporary_folder.hpp"

using namespace millforce;
using namespace millforce::sim;

namespace {

BenchRun run_of(const std::string& part, const std::string& controller, std::uint64_t seed, double time_s) {
    return {part, controller, seed, time_s, 0.8 * time_s, 0.93, 1.5, 0.0, 0.25, 1.0};
}

}  // namespace

TEST_GROUP(Journal) {
    test::TemporaryFolder folder;
};

TEST(Journal, knows_after_a_restart_what_has_been_run) {
    {
        Journal journal(folder.path("runs.csv"), 7);
        journal.add(run_of("slot", "ours", 2, 10.0));
        journal.add(run_of("slot", "ours", 1, 9.123456789));
    }
    const Journal journal(folder.path("runs.csv"), 7);
    CHECK_TRUE(journal.has("slot", "ours", 1));
    CHECK_TRUE(journal.has("slot", "ours", 2));
    CHECK_FALSE(journal.has("slot", "ours", 3));
    CHECK_FALSE(journal.has("slot", "haas", 1));
    CHECK_TRUE(journal.runs() ==
               (std::vector{run_of("slot", "ours", 1, 9.123456789), run_of("slot", "ours", 2, 10.0)}));
}

TEST(Journal, forgets_a_line_that_an_interrupt_left_unfinished) {
    { Journal(folder.path("runs.csv"), 7).add(run_of("slot", "ours", 1, 9.0)); }
    folder.write("runs.csv", folder.read("runs.csv") + "slot,ours,2,1");
    {
        Journal journal(folder.path("runs.csv"), 7);
        CHECK_FALSE(journal.has("slot", "ours", 2));
        journal.add(run_of("slot", "ours", 2, 10.0));
    }
    LONGS_EQUAL(2, Journal(folder.path("runs.csv"), 7).runs().size());
}

TEST(Journal, refuses_runs_of_other_settings_and_other_files) {
    { Journal(folder.path("runs.csv"), 7).add(run_of("slot", "ours", 1, 9.0)); }
    CHECK_TRUE(test::contains(test::message_of<host::InputError>([&] { Journal(folder.path("runs.csv"), 8); }),
                              "another program or other settings"));
    folder.write("other.csv", "part,controller\n1,2\n");
    CHECK_TRUE(test::contains(test::message_of<host::InputError>([&] { Journal(folder.path("other.csv"), 7); }),
                              "expected a journal"));
}

TEST(Journal, sorted_it_is_the_same_file_whatever_the_order_was) {
    for (const bool is_reversed : {false, true}) {
        Journal journal(folder.path(is_reversed ? "b.csv" : "a.csv"), 7);
        journal.add(run_of("slot", "ours", is_reversed ? 2 : 1, is_reversed ? 10.0 : 9.0));
        journal.add(run_of("slot", "ours", is_reversed ? 1 : 2, is_reversed ? 9.0 : 10.0));
        journal.sort_file();
    }
    STRCMP_EQUAL(folder.read("a.csv").c_str(), folder.read("b.csv").c_str());
}
