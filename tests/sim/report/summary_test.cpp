// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <string>
#include <vector>

#include "firmware/program/report/json_check.hpp"
#include "report/summary.hpp"

using namespace millforce::sim;

namespace {

RunResult run_of(const char* controller, double time_s) {
    RunResult run;
    run.controller = controller;
    run.figures.time_s = time_s;
    run.figures.finished = true;
    return run;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = text.find('\n', start);
        lines.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    return lines;
}

std::string line_with(const std::string& text, const std::string& label) {
    for (const std::string& line : lines_of(text)) {
        if (line.starts_with(label)) {
            return line;
        }
    }
    return {};
}

}  // namespace

TEST_GROUP(Summary) {
    ScenarioInfo info;
    std::vector<RunResult> runs{run_of("millforce", 61.2), run_of("constant", 98.4), run_of("socket", 70.0)};

    void setup() override {
        info.name = "pocket";
        info.title = "A pocket";
        info.tool = "4 flutes, Ø10 mm";
        info.material = "SM45C";
        info.tooth_force_limit_N = 400.0;
        info.spindle_speed_rad_s = 314.159265;
        runs[0].figures.peak_over_limit = 0.983;
        runs[0].figures.teeth_broken = 3;
        runs[0].figures.immersion_rms = 0.0312;
        runs[0].figures.immersion_coverage = 0.941;
        runs[0].figures.depth_rms_mm = 0.042;
        runs[0].figures.time_over_limit_s = 0.12;
        runs[0].figures.real_time_factor = 184.3;
    }
};

TEST(Summary, TimeSavedIsMeasuredAgainstTheConstantFeed) {
    DOUBLES_EQUAL(100.0 * (98.4 - 61.2) / 98.4, *time_saved_percent(runs[0], runs), 1e-12);
    DOUBLES_EQUAL(100.0 * (98.4 - 70.0) / 98.4, *time_saved_percent(runs[2], runs), 1e-12);
    CHECK_FALSE(time_saved_percent(runs[1], runs).has_value());
}

TEST(Summary, ARunThatStopsEarlyHasSavedNothing) {
    runs[0].figures.finished = false;
    CHECK_FALSE(time_saved_percent(runs[0], runs).has_value());
    CHECK(time_saved_percent(runs[2], runs).has_value());
    runs[1].figures.finished = false;
    CHECK_FALSE(time_saved_percent(runs[2], runs).has_value());
}

TEST(Summary, WithoutAConstantRunThereIsNoTimeSaved) {
    runs.erase(runs.begin() + 1);
    CHECK_FALSE(time_saved_percent(runs[0], runs).has_value());
    CHECK(run_named(constant_feed, runs) == nullptr);
}

TEST(Summary, TheTableHoldsTheFiguresOfEveryController) {
    const std::string table = summary_table(info, runs);
    CHECK(contains(line_with(table, "time  "), "61.2 s"));
    CHECK(contains(line_with(table, "time  "), "98.4 s"));
    CHECK(contains(line_with(table, "time saved"), "37.8 %"));
    CHECK(contains(line_with(table, "peak / limit"), "98.3 %"));
    CHECK(contains(line_with(table, "time over limit"), "0.12 s"));
    CHECK(contains(line_with(table, "teeth broken"), " 3"));
    CHECK(contains(line_with(table, "immersion rms error"), "0.031"));
    CHECK(contains(line_with(table, "  within 95 % band"), "94.1 %"));
    CHECK(contains(line_with(table, "depth rms error"), "0.042 mm"));
    CHECK(contains(line_with(table, "x real time"), "184"));
    CHECK(contains(table, "3000 rpm"));
    CHECK(contains(table, "tooth force limit 400 N"));
}

TEST(Summary, ASpindleSpeedThatNobodyGaveIsNotShownAsZero) {
    info.spindle_speed_rad_s = 0.0;
    CHECK_FALSE(contains(summary_table(info, runs), "rpm"));
}

TEST(Summary, WithoutAnEstimateTheTableShowsADash) {
    const std::string line = line_with(summary_table(info, runs), "depth rms error");
    CHECK(line.ends_with(" -"));
    CHECK_FALSE(contains(line, "nan"));
}

TEST(Summary, AFaultStandsWhereTheRunEnded) {
    runs[0].figures.fault = "overload";
    runs[0].figures.finished = false;
    CHECK(contains(line_with(summary_table(info, runs), "ended"), "overload"));
}

TEST(Summary, TheTableIsAlignedAndAtMost100ColumnsWide) {
    for (const char* more : {"clairvoyant", "fixed_gain", "another", "one_more"}) {
        runs.push_back(run_of(more, 80.0));
    }
    const std::string table = summary_table(info, runs);
    std::size_t longest = 0;
    std::size_t rows = 0;
    for (const std::string& line : lines_of(table)) {
        longest = std::max(longest, line.size());
        rows += line.starts_with("time saved") ? 1U : 0U;
    }
    CHECK(longest <= 100);
    LONGS_EQUAL(2, rows);  // two blocks
    const std::vector<std::string> lines = lines_of(table);
    for (std::size_t k = 4; k < 4 + figure_rows(runs).size() + 1; ++k) {
        LONGS_EQUAL(lines[3].size(), lines[k].size());
    }
}

TEST(Summary, JsonIsValidAndNamesEveryFigure) {
    const std::string json = summary_json(info, runs);
    CHECK(millforce::host::JsonCheck::valid(json));
    for (const char* key :
         {"\"time_s\": 61.2", "\"time_saved_percent\": 37.8049", "\"peak_over_limit\": 0.983", "\"teeth_broken\": 3",
          "\"tooth_force_limit_N\": 400", "\"controller\": \"constant\"", "\"finished\": true", "\"stock\": null"}) {
        CHECK_TEXT(contains(json, key), key);
    }
}

TEST(Summary, JsonHasNullWhereThereIsNoValue) {
    const std::string json = summary_json(info, {&runs[1], 1});
    for (const char* key : {"\"immersion_rms\": null", "\"depth_coverage\": null", "\"time_saved_percent\": null"}) {
        CHECK_TEXT(contains(json, key), key);
    }
    CHECK_FALSE(contains(json, "nan"));
}

TEST(Summary, JsonStandsHostileNames) {
    info.title = "</script>\"\\\n\xff";
    runs[0].controller = "a\"b";
    info.has_top_view = true;
    CHECK(millforce::host::JsonCheck::valid(summary_json(info, runs)));
    CHECK(millforce::host::JsonCheck::valid(summary_json(info, {})));
}
