// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "report/trace_csv.hpp"
#include "synthetic_run.hpp"

using namespace millforce::sim;

namespace {

std::vector<std::string> cells_of(const std::string& csv, std::size_t line) {
    std::size_t start = 0;
    for (; line > 0; --line) {
        start = csv.find('\n', start) + 1;
    }
    std::vector<std::string> cells(1);
    for (; csv[start] != '\n'; ++start) {
        if (csv[start] == ',') {
            cells.emplace_back();
        } else {
            cells.back() += csv[start];
        }
    }
    return cells;
}

std::string cell_of(const std::string& csv, std::size_t line, const std::string& column) {
    const std::vector<std::string> names = cells_of(csv, 0);
    const auto found = std::find(names.begin(), names.end(), column);
    CHECK_TEXT(found != names.end(), column.c_str());
    return cells_of(csv, line)[static_cast<std::size_t>(found - names.begin())];
}

RunResult one_point() {
    RunResult run;
    run.controller = "millforce";
    TracePoint point;
    point.time_s = 3599.98;
    point.x_mm = -12.3456;
    point.override_ratio = 1.25;
    point.state = 2;
    point.limit = 6;
    point.fault = 1;
    point.rapid = true;
    point.true_tooth_force_N = 321.5;
    point.true_feed_force_N = -0.0;
    run.trace.push_back(point);
    return run;
}

}  // namespace

TEST_GROUP(TraceCsv){};

TEST(TraceCsv, TheFirstColumnsAreThoseOfTheEstimates) {
    const std::string expected =
        "time_s,state,tangential_force_N,feed_force_N,radial_immersion,radial_immersion_sd,axial_depth_mm,"
        "axial_depth_sd_mm,peak_force_N,force_limit_N,override,";
    CHECK(trace_csv(one_point()).starts_with(expected));
}

TEST(TraceCsv, ValuesAndNamesStandUnderTheirColumns) {
    const std::string csv = trace_csv(one_point());
    STRCMP_EQUAL("3599.98", cell_of(csv, 1, "time_s").c_str());
    STRCMP_EQUAL("-12.3456", cell_of(csv, 1, "x_mm").c_str());
    STRCMP_EQUAL("1.25", cell_of(csv, 1, "override").c_str());
    STRCMP_EQUAL("in_cut", cell_of(csv, 1, "state").c_str());
    STRCMP_EQUAL("surge", cell_of(csv, 1, "limit").c_str());
    STRCMP_EQUAL("overload", cell_of(csv, 1, "fault").c_str());
    STRCMP_EQUAL("1", cell_of(csv, 1, "rapid").c_str());
    STRCMP_EQUAL("millforce", cell_of(csv, 1, "controller").c_str());
    STRCMP_EQUAL("321.5", cell_of(csv, 1, "true_tooth_force_N").c_str());
    STRCMP_EQUAL("0", cell_of(csv, 1, "true_feed_force_N").c_str());
}

TEST(TraceCsv, AnEmptyCellIsNoEstimate) {
    const std::string csv = trace_csv(one_point());
    for (const char* column : {"tangential_force_N", "radial_immersion", "axial_depth_sd_mm", "force_limit_N",
                               "tooth_force_N", "true_radial_immersion"}) {
        STRCMP_EQUAL("", cell_of(csv, 1, column).c_str());
    }
}

TEST(TraceCsv, EveryLineHasEveryColumn) {
    const RunResult run = synthetic::pocket_run("millforce");
    const std::string csv = trace_csv(run);
    const auto columns = static_cast<std::ptrdiff_t>(cells_of(csv, 0).size());
    const auto lines = static_cast<std::ptrdiff_t>(run.trace.size()) + 1;
    LONGS_EQUAL(lines, std::count(csv.begin(), csv.end(), '\n'));
    LONGS_EQUAL(lines * (columns - 1), std::count(csv.begin(), csv.end(), ','));
    CHECK(csv.find("nan") == std::string::npos);
}

TEST(TraceCsv, AControllerNameWithACommaIsQuoted) {
    RunResult run = one_point();
    run.controller = "a,\"b\"";
    CHECK(trace_csv(run).find(",\"a,\"\"b\"\"\",") != std::string::npos);
}

TEST(TraceCsv, TheControlledRunIsTraceCsvAndABaselineNamesItself) {
    std::vector<RunResult> runs(3);
    runs[0].controller = "millforce";
    runs[1].controller = "constant_hindsight";
    runs[2].controller = "../x y";
    STRCMP_EQUAL("trace.csv", trace_file_name(runs[0], runs).c_str());
    STRCMP_EQUAL("trace_constant_hindsight.csv", trace_file_name(runs[1], runs).c_str());
    STRCMP_EQUAL("trace____x_y.csv", trace_file_name(runs[2], runs).c_str());
}
