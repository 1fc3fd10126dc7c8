// SPDX-License-Identifier: Apache-2.0
#include "commission/step_recorder.hpp"
#include "commission/idle_watch.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <cstdint>
#include <random>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

TEST_GROUP(StepRecorder) {
    static constexpr std::uint32_t counts = 8192;
    TemporaryFolder folder;
    Session session{folder.path("session")};
    IdleWatch watch{counts, 3, 1.0};
    StepRecorder recorder{session, "idle", counts, watch, true};
    std::mt19937 random{3};
    std::normal_distribution<double> noise{0.0, 0.1};
    std::uint32_t time_us = 4'294'000'000U;  // wraps within the test
    double turns = 400'000.3;

    /// Samples every 4 ms; returns whether the step is over.
    bool idle(double rpm, double duration_s, bool is_complete = true) {
        for (int k = 0; k < static_cast<int>(std::lround(duration_s / 0.004)); ++k) {
            time_us += 4000;
            turns += rpm / 60.0 * 0.004;
            hal::DriveSample sample;
            sample.time_us = time_us;
            sample.spindle_count = static_cast<std::uint32_t>(static_cast<std::int64_t>(turns * counts));
            sample.spindle_current_A = static_cast<float>(1.0 + 1e-4 * rpm + noise(random));
            sample.present = is_complete ? hal::all_present : hal::mask(hal::Present::spindle_count);
            if (recorder.add(sample)) {
                return true;
            }
        }
        return false;
    }
};

TEST(StepRecorder, what_it_has_seen_is_read_back_from_its_files_in_the_same_way) {
    idle(1200.0, 6.0);
    idle(1200.0, 0.2, false);
    time_us += 900'000;  // the machine was off
    turns = -3.0;
    idle(1200.0, 6.0);
    idle(2400.0, 3.0);
    CHECK_FALSE(recorder.is_enough());
    CHECK(idle(4800.0, 5.0));
    recorder.finish();
    CHECK(recorder.is_enough());
    CHECK(session.recordings("idle").size() > 1);
    IdleWatch again(counts, 3, 1.0);
    feed_recordings(session.recordings("idle"), counts, again);
    CHECK(again.is_enough());
    const auto seen = watch.plateaus();
    const auto read = again.plateaus();
    UNSIGNED_LONGS_EQUAL(seen.size(), read.size());
    for (std::size_t k = 0; k < seen.size(); ++k) {
        DOUBLES_EQUAL(seen[k].current_A, read[k].current_A, 1e-6);
        DOUBLES_EQUAL(seen[k].duration_s, read[k].duration_s, 1e-6);
    }
}

TEST(StepRecorder, recordings_that_are_set_aside_are_done_again) {
    idle(1200.0, 12.0);
    recorder.finish();
    const std::size_t files = session.recordings("idle").size();
    CHECK(files > 0);
    session.set_aside("idle");
    CHECK(session.recordings("idle").empty());
    CHECK(session.has("idle.1.csv.refused"));
}
