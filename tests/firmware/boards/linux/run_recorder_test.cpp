// SPDX-License-Identifier: Apache-2.0
#include "daemon/run_recorder.hpp"

#include <filesystem>
#include <string>

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
    RunHistory history{endmill()};
};

TEST(RunRecorder, takes_every_tick_or_counts_it_and_never_waits) {
    constexpr std::uint64_t ticks = 20'000;  // at once: more than fit
    RunRecorder recorder(history);
    for (std::uint64_t k = 0; k < ticks; ++k) {
        recorder.tick(1000 * k, {}, 0);
    }
    recorder.finish();
    UNSIGNED_LONGS_EQUAL(ticks, history.totals().ticks + history.lost());
    CHECK(history.totals().ticks > 1000);
}

TEST(RunRecorder, keeps_notes_with_their_times_and_cuts_off_what_is_too_long) {
    RunRecorder recorder(history);
    recorder.tick(1'000'000, {}, 0);
    recorder.tick(1'400'000, {}, 0);
    recorder.note(1'300'000, std::string(1000, 'x'));
    recorder.finish();
    const auto events = history.events();
    UNSIGNED_LONGS_EQUAL(1, events.size());
    DOUBLES_EQUAL(0.3, events[0].time_s, 1e-9);
    UNSIGNED_LONGS_EQUAL(RunRecorder::longest_note, events[0].text.size());
}
