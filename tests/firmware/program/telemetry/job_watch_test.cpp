// SPDX-License-Identifier: Apache-2.0
#include "telemetry/job_watch.hpp"

#include <optional>
#include <string>

#include "control/cut_state.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;

TEST_GROUP(JobWatch) {
    JobWatch jobs;
    Telemetry telemetry;

    /// Ticks of 10 ms.
    std::optional<JobReport> ticks(control::CutState state, int count) {
        std::optional<JobReport> ended;
        for (int k = 0; k < count; ++k) {
            telemetry.time_s += 0.01;
            telemetry.unix_us += 10'000;
            telemetry.sample.monotonic_us += 10'000;
            ++telemetry.sample.tick.feed_override.heartbeat;
            telemetry.sample.tick.feed_override.state = static_cast<std::uint8_t>(state);
            if (const auto report = jobs.follow(telemetry)) {
                CHECK(!ended);
                ended = report;
            }
        }
        return ended;
    }
};

TEST(JobWatch, reports_from_the_first_cut_to_the_last_one_thirty_seconds_after_it) {
    telemetry.sample.is_held = false;
    telemetry.sample.tick.feed_override.ratio = 0.5F;
    CHECK(!ticks(control::CutState::air, 5000));
    const std::uint64_t begin_us = telemetry.unix_us + 10'000;
    telemetry.sample.tick.axial_depth_mm = 3.0F;
    telemetry.sample.tick.tooth_force_N = 300.0F;
    telemetry.shown = {600.0F, 800.0F};
    telemetry.sample.tool = 7;
    CHECK(!ticks(control::CutState::in_cut, 500));
    CHECK(!ticks(control::CutState::air, 1000));
    telemetry.sample.tick.feed_override.ratio = 1.0F;
    CHECK(!ticks(control::CutState::in_cut, 500));
    const std::uint64_t end_us = telemetry.unix_us;
    const auto report = ticks(control::CutState::air, 3100);
    CHECK(report.has_value());
    UNSIGNED_LONGS_EQUAL(begin_us, report->begin_unix_us);
    UNSIGNED_LONGS_EQUAL(end_us, report->end_unix_us);
    DOUBLES_EQUAL(10.0, report->cutting_s, 0.02);
    DOUBLES_EQUAL(0.75, report->override_sum_s / report->cutting_s, 0.001);
    DOUBLES_EQUAL(0.75, static_cast<double>(report->largest_load), 1e-6);
    DOUBLES_EQUAL(3.0, static_cast<double>(report->largest_depth_mm), 1e-6);
    CHECK(report->tools == std::set<std::uint32_t>{7});
    CHECK(!jobs.end());
}

TEST(JobWatch, reports_a_job_that_ends_with_its_run_with_its_faults) {
    ticks(control::CutState::in_cut, 100);
    telemetry.sample.tick.feed_override.fault = static_cast<std::uint8_t>(control::Fault::overload);
    ticks(control::CutState::fault, 100);
    telemetry.sample.tick.feed_override = {};
    const auto report = ticks(control::CutState::air, 1);
    CHECK(report.has_value());
    DOUBLES_EQUAL(1.0, report->held_s + 1e-9 - 1.0, 0.02);
    const std::string text = job_json(*report);
    CHECK(text.find(R"("fault":"overload")") != std::string::npos);
    CHECK(text.find("largest_depth_mm") == std::string::npos);
    CHECK(text.find(R"("id":"job-)" + std::to_string(report->begin_unix_us)) != std::string::npos);
}

TEST(JobWatch, ends_a_job_though_no_tick_comes_any_more) {
    ticks(control::CutState::in_cut, 100);
    CHECK(!jobs.look(telemetry.sample.monotonic_us + 29'000'000));
    CHECK(jobs.look(telemetry.sample.monotonic_us + 31'000'000).has_value());
    CHECK(!jobs.look(telemetry.sample.monotonic_us + 99'000'000));
}
