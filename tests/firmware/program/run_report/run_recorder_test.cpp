// SPDX-License-Identifier: Apache-2.0
#include "run_report/run_recorder.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;

namespace {

ToolSet endmill() {
    const std::filesystem::path tools = std::filesystem::path(MILLFORCE_SOURCE_DIR) / "sim/scenarios/tools";
    return ToolSet({}, {(tools / "endmill_10mm.toml").string(), ""});
}

}  // namespace

TEST_GROUP(RunRecorder) {
    const ToolSet tools = endmill();
    RunHistory history{tools};
    RunNotes notes;

    TelemetryHub hub_with_recorder(RunClock clock) {
        std::vector<std::unique_ptr<TelemetrySink>> sinks;
        sinks.push_back(std::make_unique<RunRecorder>(history, notes, clock));
        return {tools, std::move(sinks)};
    }
};

TEST(RunRecorder, takes_every_tick_or_counts_it) {
    constexpr std::uint64_t ticks = 20'000;  // at once: more than fit
    TelemetryHub hub = hub_with_recorder(RunClock::samples);
    for (std::uint64_t k = 0; k < ticks; ++k) {
        hub.feed()->put({.tick = {.time_us = 1000 * k}});
    }
    hub.finish();
    UNSIGNED_LONGS_EQUAL(ticks, history.totals().ticks + history.lost());
    CHECK(history.totals().ticks > 1000);
}

TEST(RunRecorder, keeps_notes_with_their_times_and_cuts_off_what_is_too_long) {
    TelemetryHub hub = hub_with_recorder(RunClock::samples);
    hub.feed()->put({.tick = {.time_us = 1'000'000}});
    hub.feed()->put({.tick = {.time_us = 1'400'000}});
    notes.add(1'300'000, std::string(1000, 'x'));
    hub.finish();
    const auto events = history.events();
    UNSIGNED_LONGS_EQUAL(1, events.size());
    DOUBLES_EQUAL(0.3, events[0].time_s, 1e-9);
    UNSIGNED_LONGS_EQUAL(RunNotes::longest_note, events[0].text.size());
}

TEST(RunRecorder, on_the_clock_of_this_computer_takes_no_notice_of_the_samples_clock) {
    TelemetryHub hub = hub_with_recorder(RunClock::monotonic);
    hub.feed()->put({.monotonic_us = 5'000'000, .tick = {.time_us = 700}});
    hub.feed()->put({.monotonic_us = 5'250'000, .tick = {.time_us = 100}});
    hub.finish();
    DOUBLES_EQUAL(0.25, history.totals().length_s, 1e-9);
}
