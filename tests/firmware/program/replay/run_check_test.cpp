// SPDX-License-Identifier: Apache-2.0
#include "replay/run_check.hpp"
#include "files/input_error.hpp"
#include "parameters/tool_set.hpp"
#include "run_log/estimate_line.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

ToolForces forces() {
    const TemporaryFolder folder;
    const auto file = folder.write("mill.toml",
                                   "[tool]\nteeth = 4\ndiameter_mm = 10\nflute_length_mm = 22\n"
                                   "tooth_force_limit_N = 700\n[control]\nentry_feed_per_tooth_mm = 0.03\n"
                                   "air_feed_per_tooth_mm = 0.03\nmax_feed_per_tooth_mm = 0.2\n"
                                   "[cutting]\nk_s_N_per_mm2 = 1650\nk_1 = 0.376\n");
    return ToolForces(ToolSet({}, {file.string(), ""}));
}

EstimateEntry entry_at(std::uint64_t time_us) {
    EstimateEntry entry;
    entry.digest = 7;
    entry.tick.time_us = time_us;
    return entry;
}

}  // namespace

TEST_GROUP(RunCheck) {
    TemporaryFolder folder;

    /// A run's log of two estimates, with a status between them.
    std::string log() {
        const std::string text =
            json_line(entry_at(1000), forces()) + "{\"type\":\"status\"}\n" + json_line(entry_at(2000), forces());
        return folder.write("run.log", text).string();
    }
};

TEST(RunCheck, is_the_run_where_every_estimate_comes_again) {
    RunCheck check(log(), forces());
    CHECK_FALSE(check.is_same());
    check.add(entry_at(1000));
    check.add(entry_at(2000));
    CHECK(check.is_same());
    STRCMP_CONTAINS("all 2 estimates are the run's", check.summary().c_str());
    check.add(entry_at(3000));  // after the run's end
    CHECK(check.is_same());
}

TEST(RunCheck, shows_the_first_estimate_that_differs_and_none_after_it) {
    RunCheck check(log(), forces());
    check.add(entry_at(1000));
    EstimateEntry other = entry_at(2000);
    other.digest = 8;
    check.add(other);
    check.add(entry_at(2000));
    CHECK_FALSE(check.is_same());
    STRCMP_CONTAINS("after 1 equal estimates the replay differs", check.summary().c_str());
}

TEST(RunCheck, says_where_the_replay_ends_before_the_run) {
    RunCheck check(log(), forces());
    check.add(entry_at(1000));
    CHECK_FALSE(check.is_same());
    STRCMP_CONTAINS("after 1 equal estimates the replay ends, and the run does not", check.summary().c_str());
}

TEST(RunCheck, needs_a_log_with_estimates) {
    const auto file = folder.write("run.log", "{\"type\":\"status\"}\n").string();
    STRCMP_CONTAINS("run.log: no estimates, expected a log of 'millforce run --log'",
                    message_of<InputError>([&] { RunCheck check(file, forces()); }).c_str());
}
