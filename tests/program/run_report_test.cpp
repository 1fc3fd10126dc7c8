// SPDX-License-Identifier: Apache-2.0
#include "bridge.hpp"
#include "csv_rows.hpp"
#include "firmware/program/report/json_check.hpp"
#include "inputs.hpp"

#include <sys/stat.h>

#include <csignal>
#include <memory>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;

/// The page of a run: `--report DIR` of replay and serve.

namespace {

std::string data_of(const std::string& html) {
    const std::string mark = "<script id=\"run-data\" type=\"application/json\">";
    const std::size_t start = html.find(mark);
    return start == std::string::npos
               ? std::string()
               : html.substr(start + mark.size(), html.find("</script>", start) - start - mark.size());
}

bool is_whole(const std::string& html) {
    return html.ends_with("</html>\n") && host::JsonCheck::valid(data_of(html));
}

}  // namespace

TEST_GROUP(RunReport) {
    Inputs inputs;
    std::unique_ptr<Program> serve{};
    std::unique_ptr<Bridge> cnc{};

    [[nodiscard]] std::string page() const {
        return text_of(inputs.path("page") / "report.html");
    }
    void record() {
        const Ended ended =
            run_millforce({"simulate", inputs.name("scenario.toml"), "--record", "--out", inputs.name("results")});
        LONGS_EQUAL(0, ended.exit_code);
        std::filesystem::rename(inputs.path("results") / "recording.csv", inputs.path("log.csv"));
    }
    void start_serving() {
        serve = std::make_unique<Program>(
            std::vector<std::string>{"serve", inputs.name("a.sock"), "--machine", inputs.name("machine.toml"), "--tool",
                                     inputs.name("tool.toml"), "--report", inputs.name("page")});
        cnc = std::make_unique<Bridge>(inputs.name("a.sock"));
        cnc->sample.spindle_current_A = 1.4F;
        cnc->sample.axis_current_A[0] = 2.3F;
        cnc->sample.axis_velocity_mm_s[0] = 20.0F;
        for (int k = 0; k < 300; ++k) {
            cnc->ask();
        }
    }
    int ended_by_sigterm() {
        serve->interrupt(SIGTERM);
        serve->wait();
        return serve->exit_code();
    }
};

TEST(RunReport, of_a_replay_tells_what_the_cut_was_and_names_the_ceilings_by_their_keys) {
    inputs.write("tool.toml", with(tool_text, "[control]\n", "[control]\ndepth_step_ratio = 1.0\n"));
    record();
    const Ended ended = inputs.replay({"--report", inputs.name("page")});
    LONGS_EQUAL(0, ended.exit_code);
    CHECK(contains(ended.error, "report: "));
    const std::string html = page();
    CHECK(is_whole(html));
    for (const char* part : {"Replay of log.csv", "The tool was in the cut for ", "tooth_<wbr>force_<wbr>limit_<wbr>N",
                             "entry_<wbr>feed_<wbr>per_<wbr>tooth_<wbr>mm", "tool.toml: 4 teeth, Ø10 mm", "700 N",
                             "millforce replay ", "millforce 0."}) {
        CHECK_TEXT(contains(html, part), part);
    }
}

/// The file says 6 µm; with an axis 16 µm off the radii of neighbours differ by 16 √2 = 23 µm.
TEST(RunReport, and_the_table_of_a_replay_say_how_much_the_tool_runs_out) {
    inputs.write("scenario.toml", straight_cut(4000, 1200, 8, 90) + "[cutter]\nrunout_um = 16\n");
    record();
    LONGS_EQUAL(0, inputs.replay({"--report", inputs.name("page")}).exit_code);
    CHECK(contains(page(), "(runout_um)</dt><dd>0 µm by its file, and so not measured</dd>"));
    inputs.write("tool.toml", with(tool_text, "teeth = 4\n", "teeth = 4\nrunout_um = 6\n"));
    LONGS_EQUAL(0, inputs.replay({"--report", inputs.name("page")}).exit_code);
    CHECK(contains(page(), "<dt>Runout of the tool (runout_um)</dt><dd>2"));
    CHECK(contains(page(), " µm at most, as the cut showed; 6 µm by its file</dd>"));
    const std::string table = inputs.read("out.csv");
    const std::string header = table.substr(0, table.find('\n'));
    CHECK(header.ends_with(",runout_um,cut_side,law_misfit,limit,fault"));
    const std::vector<CsvRow> rows = csv_rows(table);
    DOUBLES_EQUAL(6.0, std::stod(rows[20].at("runout_um")), 0.01);
    DOUBLES_EQUAL(22.6, std::stod(rows.back().at("runout_um")), 3.0);
    const CsvRow& in_the_cut = rows[rows.size() / 2];
    STRCMP_EQUAL("down", in_the_cut.at("cut_side").c_str());
    CHECK(std::stod(in_the_cut.at("law_misfit")) < 16.0);
    STRCMP_EQUAL("none", in_the_cut.at("fault").c_str());
    STRCMP_EQUAL("", rows.back().at("cut_side").c_str());
}

TEST(RunReport, changes_neither_the_table_of_a_replay_nor_where_it_goes) {
    record();
    LONGS_EQUAL(0, inputs.replay().exit_code);
    const std::string table = inputs.read("out.csv");
    const Ended ended = run_millforce({"replay", inputs.name("log.csv"), "--machine", inputs.name("machine.toml"),
                                       "--tool", inputs.name("tool.toml"), "--report", inputs.name("page")});
    STRCMP_EQUAL(table.c_str(), ended.out.c_str());
}

TEST(RunReport, is_whole_after_sigterm_in_a_connection_and_has_its_samples) {
    start_serving();
    LONGS_EQUAL(0, ended_by_sigterm());
    const std::string html = page();
    CHECK(is_whole(html));
    CHECK(contains(html, "<dt>Samples</dt><dd>300</dd>"));
    CHECK(contains(html, "The CNC connected."));
}

TEST(RunReport, is_whole_without_a_single_sample) {
    Program idle({"serve", inputs.name("a.sock"), "--machine", inputs.name("machine.toml"), "--tool",
                  inputs.name("tool.toml"), "--report", inputs.name("page")});
    CHECK(idle.says("waiting"));
    idle.interrupt(SIGINT);
    idle.wait();
    LONGS_EQUAL(0, idle.exit_code());
    CHECK(is_whole(page()));
    CHECK(contains(page(), "No complete sample of the drives came"));
}

TEST(RunReport, in_a_folder_that_cannot_be_is_refused_at_the_start) {
    inputs.write("log.csv", "time_s\n");
    inputs.write("page", "a file");
    for (const Ended& ended :
         {run_millforce({"serve", inputs.name("a.sock"), "--machine", inputs.name("machine.toml"), "--tool",
                         inputs.name("tool.toml"), "--report", inputs.name("page")}),
          run_millforce({"run", "can0", "--machine", MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml", "--tool",
                         inputs.name("tool.toml"), "--report", inputs.name("page")})}) {
        LONGS_EQUAL(2, ended.exit_code);
        CHECK(contains(ended.error, inputs.name("page")));
        CHECK(contains(ended.error, "cannot create the folder"));
    }
    CHECK_FALSE(std::filesystem::exists(inputs.path("a.sock")));
}

TEST(RunReport, whose_folder_goes_away_stops_no_run_and_is_missed_at_its_end) {
    start_serving();
    std::filesystem::remove_all(inputs.path("page"));
    UNSIGNED_LONGS_EQUAL(301, cnc->ask().heartbeat);
    LONGS_EQUAL(1, ended_by_sigterm());
    CHECK(serve->says(inputs.name("page")));
}
