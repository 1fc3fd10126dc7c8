// SPDX-License-Identifier: Apache-2.0
#include "inputs.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

namespace {

const std::string examples = MILLFORCE_SOURCE_DIR "/firmware/program/import/examples/";

void check_refused(const Ended& ended, const std::vector<std::string>& parts) {
    STRCMP_EQUAL("", not_refused(ended, parts).c_str());
}

}  // namespace

TEST_GROUP(ImportCommand) {
    Inputs inputs;

    Ended import(const std::string& source, const std::string& map, std::vector<std::string> more = {}) {
        std::vector<std::string> words{"import", examples + source, "--map", examples + map};
        words.insert(words.end(), more.begin(), more.end());
        return run_millforce(words);
    }
};

TEST(ImportCommand, makes_a_recording_that_a_replay_takes) {
    const Ended imported = import("table.csv", "table.toml", {"-o", inputs.name("log.csv")});
    STRCMP_EQUAL("", imported.error.c_str());
    LONGS_EQUAL(0, imported.exit_code);
    CHECK(contains(imported.out, "log.csv: 60 rows\n"));
    const Ended replayed = inputs.replay({"--interval", "0"});
    STRCMP_EQUAL("", replayed.error.c_str());
    CHECK(contains(replayed.out, "out.csv: 60 rows"));
}

TEST(ImportCommand, of_a_dry_run_writes_nothing_and_says_what_it_understood) {
    const Ended dry =
        import("candump.log", "candump.toml", {"--rate", "1000", "--dry-run", "-o", inputs.name("log.csv")});
    LONGS_EQUAL(0, dry.exit_code);
    CHECK(!std::filesystem::exists(inputs.path("log.csv")));
    CHECK(contains(dry.out, "candump log of can0, 180 frames"));
    CHECK(contains(dry.out, "60 rows"));
    CHECK(contains(dry.out, "spindle_angle_rad  SpindleStatus.Count"));
    CHECK(contains(dry.out, "not used of the source: SpindleStatus.Speed"));
}

TEST(ImportCommand, takes_a_candump_log_with_this_projects_dbc_file) {
    const auto map = inputs.write("map.toml", "[source]\ndbc = \"" MILLFORCE_SOURCE_DIR
                                              "/drivers/millforce.dbc\"\n[x_current_A]\nsource = \"XCurrent\"\nunit = "
                                              "\"rated\"\nrated_A = 10\n");
    inputs.write("can.log", "(1.000) can0 182#00000000F4010000\n(1.001) can0 182#00000000E8030000\n");
    const Ended ended =
        run_millforce({"import", inputs.name("can.log"), "--map", map.string(), "-o", inputs.name("log.csv")});
    STRCMP_EQUAL("", ended.error.c_str());
    STRCMP_EQUAL("time_s,x_current_A\n0,5\n0.001,10\n", inputs.read("log.csv").c_str());
}

TEST(ImportCommand, refuses_in_one_line_and_writes_nothing) {
    const std::string out = inputs.name("log.csv");
    check_refused(import("table.csv", "table.toml"), {"--output: missing", "--dry-run"});
    check_refused(import("table.csv", "odrive.toml", {"-o", out}),
                  {"table.csv:5: no column 'axis1.encoder.pos_estimate'", "the line has: Zeit"});
    check_refused(import("candump.log", "candump.toml", {"-o", out}), {"expected --rate HZ"});
    check_refused(import("none.csv", "table.toml", {"-o", out}), {"none.csv: no such file"});
    check_refused(import("table.csv", "none.toml", {"-o", out}), {"none.toml: no such file"});
    check_refused(run_millforce({"import", examples + "sinumerik.xml", "--dry-run"}),
                  {"expected --map; there are /Nck/!SD/nckServoDataActCurr32 [u1, 1]"});
    check_refused(import("table.csv", "table.toml", {"-o", out, "--format", "xls"}), {"--format", "xls"});
    check_refused(import("table.csv", "table.toml", {"-o", out, "--rate", "nan"}), {"--rate"});
    check_refused(import("table.csv", "table.toml", {"-o", out, "--hold", "0.1"}), {"--hold", "--rate"});
    CHECK(!std::filesystem::exists(out));
}
