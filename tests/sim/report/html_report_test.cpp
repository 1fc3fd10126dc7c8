// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <span>
#include <string>
#include <vector>

#include "control/cut_state.hpp"
#include "firmware/program/report/json_check.hpp"
#include "report/html_report.hpp"
#include "report/report_data.hpp"
#include "report/summary.hpp"
#include "synthetic_run.hpp"

using namespace millforce::sim;

namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

std::string embedded_data(const std::string& html) {
    const std::string mark = "<script id=\"report-data\" type=\"application/json\">";
    const std::size_t start = html.find(mark) + mark.size();
    return html.substr(start, html.find("</script>", start) - start);
}

std::vector<RunResult> both_runs() {
    return {synthetic::pocket_run("millforce"), synthetic::pocket_run("constant")};
}

}  // namespace

TEST_GROUP(HtmlReport) {
    ScenarioInfo info = synthetic::pocket_scenario();
};

TEST(HtmlReport, EmbedsValidDataAndLeavesNoPlaceholder) {
    info.origin = {{"Command", "millforce simulate <part>"}};
    const std::string html = report_html(info, both_runs());
    const std::string data = embedded_data(html);
    CHECK(millforce::host::JsonCheck::valid(data));
    STRCMP_EQUAL(report_data_json(info, both_runs()).c_str(), data.c_str());
    for (const char* placeholder : {"{{title}}", "{{data}}", "{{report_script}}", "{{figures}}"}) {
        LONGS_EQUAL(0, count_of(html, placeholder));
    }
    CHECK(html.find("Dygraph") != std::string::npos);
    CHECK(html.find("<dt>Command</dt><dd>millforce simulate &lt;part&gt;</dd>") != std::string::npos);
}

TEST(HtmlReport, ShowsEachLimitByItsOwnDigitAndName) {
    RunResult run = synthetic::pocket_run("millforce");
    for (TracePoint& point : run.trace) {
        point.limit = static_cast<std::uint8_t>(millforce::control::Limit::load_unanswered);
    }
    const std::string data = report_data_json(info, std::span(&run, 1));
    CHECK(data.find("\"limits\":\"ffff") != std::string::npos);
    CHECK(data.find("\"way_ahead\",\"feed_mismatch\",\"depth_step\",\"load_unanswered\",\"spindle_torque\","
                    "\"current_in_doubt\",\"force_at_minimum\"]") != std::string::npos);
}

TEST(HtmlReport, AsksTheNetworkForNothing) {
    const std::string html = report_html(info, both_runs());
    CHECK(html.find("default-src 'none'") != std::string::npos);
    for (const char* request : {" src=", "<link", "@import", "url(http", "sourceMappingURL", "fetch("}) {
        CHECK_TEXT(html.find(request) == std::string::npos, request);
    }
}

TEST(HtmlReport, AHostileScenarioNameStaysText) {
    const std::string calm = report_html(info, both_runs());
    std::vector<RunResult> runs = both_runs();
    info.name = info.title = "</script><script>alert('x')</script>{{data}}";
    info.description = "<img onerror=\"x\">";
    runs[0].controller = "</title>&\"";
    const std::string html = report_html(info, runs);
    LONGS_EQUAL(count_of(calm, "</script"), count_of(html, "</script"));
    LONGS_EQUAL(count_of(calm, "<script"), count_of(html, "<script"));
    LONGS_EQUAL(0, count_of(html, "<img"));
    LONGS_EQUAL(1, count_of(html, "</title>"));
    CHECK(millforce::host::JsonCheck::valid(embedded_data(html)));
}

TEST(HtmlReport, TheHeadlineIsTheTimeSavedAndThePeakOverTheLimit) {
    std::vector<RunResult> runs = both_runs();
    runs[0].figures.time_s = 60.0;
    runs[1].figures.time_s = 150.0;
    runs[0].figures.peak_over_limit = 0.984;
    const std::string html = report_html(info, runs);
    CHECK(html.find("<strong>60.0 %</strong><span>less machining time") != std::string::npos);
    CHECK(html.find("<strong>1 min 0 s</strong><span>instead of 2 min 30 s") != std::string::npos);
    CHECK(html.find("<div class=\"stat held\"><strong>98 %</strong>") != std::string::npos);
    CHECK(html.find("No tooth went over its limit; none broke.") != std::string::npos);
}

TEST(HtmlReport, TheHeadlineSaysAgainstWhichFeedsTheTimeCounts) {
    std::vector<RunResult> runs = both_runs();
    runs.push_back(synthetic::pocket_run("constant"));
    runs[2].controller = constant_feed_in_hindsight;
    runs[0].figures.time_s = 60.0;
    runs[1].figures.time_s = 150.0;
    runs[2].figures.time_s = 75.0;
    info.constant_feed_mm_s = 10.0;
    info.hindsight_feed_mm_s = 20.0;
    info.hardest_material = 1.3;
    const std::string html = report_html(info, runs);
    CHECK(html.find("<strong>60.0 %</strong><span>less machining time than the fastest constant feed that is safe "
                    "everywhere for material up to 30 % harder: 600 mm/min") != std::string::npos);
    CHECK(html.find("<strong>20.0 %</strong><span>less machining time than the best constant feed for exactly this "
                    "material, which is known only in hindsight: 1200 mm/min") != std::string::npos);
}

TEST(HtmlReport, ASlowerPartSaysHowManyTimesAndWhichCeilingCostTheTime) {
    std::vector<RunResult> runs = both_runs();
    runs[0].figures.time_s = 180.0;
    runs[1].figures.time_s = 10.0;
    for (TracePoint& point : runs[0].trace) {
        point.feed_mm_s = point.time_s < 20.0 ? 0.5 : 2.0;
        point.limit = static_cast<std::uint8_t>(point.time_s < 20.0 ? millforce::control::Limit::force
                                                                    : millforce::control::Limit::air_feed);
    }
    const std::string html = report_html(info, runs);
    CHECK(html.find("<strong>18.0 times</strong><span>the machining time of the fastest constant feed") !=
          std::string::npos);
    CHECK(html.find("Why it took longer:") != std::string::npos);
    CHECK(html.find("the ceiling on the feed was “feed in air”") != std::string::npos);
}

TEST(HtmlReport, AnExceededLimitIsSaid) {
    std::vector<RunResult> runs = both_runs();
    runs[0].figures.peak_over_limit = 1.002;
    runs[0].figures.time_over_limit_s = 0.5;
    runs[0].figures.longest_over_limit_s = 0.2;
    runs[0].figures.reaction_time_s = 0.1;
    runs[0].figures.teeth_broken = 2;
    const std::string html = report_html(info, runs);
    CHECK(html.find("<div class=\"stat over\">") != std::string::npos);
    CHECK(
        html.find("exceeded for 0.50 s in total, 0.200 s at a stretch: only while the engagement grew, and within the "
                  "0.100 s") != std::string::npos);
    runs[0].figures.late_over_limit_s = 0.05;
    CHECK(report_html(info, runs).find("0.050 s of it when the engagement had not grown for the 0.100 s") !=
          std::string::npos);
    CHECK(html.find("Teeth broken: 2.") != std::string::npos);
}

TEST(HtmlReport, ARunThatStoppedClaimsNoTimeSaved) {
    std::vector<RunResult> runs = both_runs();
    runs[0].figures.finished = false;
    runs[0].figures.fault = "overload";
    const std::string html = report_html(info, runs);
    LONGS_EQUAL(0, count_of(html, "less machining time"));
    CHECK(html.find("did not come to its end (fault: overload)") != std::string::npos);
}

TEST(HtmlReport, AFiveMinuteRunStaysBelowThreeMegabytes) {
    std::vector<RunResult> runs = both_runs();
    for (RunResult& run : runs) {
        const std::vector<TracePoint> once = run.trace;
        while (run.trace.size() < 15000) {
            const TracePoint end = run.trace.back();
            for (TracePoint point : once) {
                point.time_s += end.time_s;
                point.path_mm += end.path_mm;
                run.trace.push_back(point);
            }
        }
    }
    CHECK(report_html(info, runs).size() < 3'000'000);
}

TEST(HtmlReport, DrawsWithoutTopViewBaselineOrTrace) {
    info.has_top_view = false;
    RunResult empty;
    empty.controller = "millforce";
    const std::string html = report_html(info, {&empty, 1});
    CHECK(millforce::host::JsonCheck::valid(embedded_data(html)));
    CHECK(html.find("\"stock_mm\":null") != std::string::npos);
}

TEST_GROUP(ReportData){};

TEST(ReportData, KeepsThePeakOfTheToothForce) {
    RunResult run = synthetic::pocket_run("millforce");
    run.trace[run.trace.size() / 2].true_tooth_force_N = 987.6;
    ScenarioInfo info = synthetic::pocket_scenario();
    const std::string data = report_data_json(info, {&run, 1});
    LONGS_EQUAL(2, count_of(data, "987.6"));  // over time and over path
}

TEST(ReportData, AShortHoldIsNotLostAmongOtherStates) {
    RunResult run;
    run.controller = "millforce";
    run.trace.resize(20000);
    for (std::size_t k = 0; k < run.trace.size(); ++k) {
        run.trace[k].time_s = 0.02 * static_cast<double>(k + 1);
        run.trace[k].path_mm = run.trace[k].time_s;
        run.trace[k].state = 2;
    }
    run.trace[7777].state = 4;
    run.trace[7777].limit = 8;
    const std::string data = report_data_json(ScenarioInfo{}, {&run, 1});
    LONGS_EQUAL(2, count_of(data, "242"));
    LONGS_EQUAL(2, count_of(data, "080"));
}

TEST(ReportData, AnEstimateWithoutAStandardDeviationHasNoBand) {
    RunResult run;
    run.trace.resize(1);
    run.trace[0].time_s = run.trace[0].path_mm = 1.0;
    run.trace[0].radial_immersion = 0.5;
    std::string data = report_data_json(ScenarioInfo{}, {&run, 1});
    CHECK(data.find("\"radial_immersion\":[0.5,0.5]") != std::string::npos);
    CHECK(data.find("\"radial_immersion_low\":[null]") != std::string::npos);
    run.trace[0].radial_immersion_sd = 0.1;
    data = report_data_json(ScenarioInfo{}, {&run, 1});
    CHECK(data.find("\"radial_immersion_low\":[0.304]") != std::string::npos);
    CHECK(data.find("\"radial_immersion_high\":[0.696]") != std::string::npos);
}

TEST(ReportData, JustOverTheLimitCountsAsOver) {
    RunResult run;
    run.trace.resize(2);
    run.trace[0].true_tooth_force_N = 400.0;
    run.trace[1].true_tooth_force_N = 400.01;
    const std::string data = report_data_json(synthetic::pocket_scenario(), {&run, 1});
    CHECK(data.find("\"share\":[1000,1]") != std::string::npos);
}

TEST(ReportData, ARapidMoveWithForceIsShown) {
    RunResult run;
    run.trace.resize(2);
    run.trace[0].rapid = run.trace[1].rapid = true;
    run.trace[1].true_tooth_force_N = 200.0;
    const std::string data = report_data_json(synthetic::pocket_scenario(), {&run, 1});
    CHECK(data.find("\"share\":[-1,501]") != std::string::npos);
}
