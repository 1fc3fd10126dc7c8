// SPDX-License-Identifier: Apache-2.0
#include "check/encoder_counts.hpp"
#include "firmware/program/check/made_recording.hpp"

#include <cmath>
#include <numbers>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

constexpr std::uint32_t counts_per_rev = 4096;

struct Turning {
    double rev_per_sample = 0.05;
    double recorded_scale = 1.0;  ///< of the angle
    int without_count_every = 0;
};

/// 400 samples of a spindle with an index pulse in each turn.
EncoderCounts counts_of(const Turning& turning) {
    EncoderCounts counts(counts_per_rev);
    const double scale = turning.recorded_scale * counts_per_rev;
    for (int k = 0; k < 400; ++k) {
        hal::DriveSample sample;
        const double turned_rev = turning.rev_per_sample * k;
        const bool is_missing = turning.without_count_every > 0 && k % turning.without_count_every == 0;
        sample.present = is_missing ? std::uint8_t{0} : hal::mask(hal::Present::spindle_count);
        sample.spindle_count = static_cast<std::uint32_t>(std::lround(turned_rev * scale));
        sample.spindle_index_count = static_cast<std::uint32_t>(std::lround(std::floor(turned_rev + 1e-9) * scale));
        sample.spindle_index_number = static_cast<std::uint8_t>(1 + static_cast<int>(turned_rev + 1e-9));
        counts.add(sample);
    }
    return counts;
}

}  // namespace

TEST_GROUP(EncoderCounts){};

TEST(EncoderCounts, of_a_spindle_that_turns_as_it_should_find_nothing) {
    STRCMP_EQUAL("", lines_of(counts_of({}).findings({.has_index = true})).c_str());
    CHECK(counts_of({}).is_proven(true));
    CHECK_FALSE(counts_of({}).is_proven(false));
}

TEST(EncoderCounts, of_a_spindle_that_stands_are_not_judged) {
    STRCMP_CONTAINS("it never turns",
                    lines_of(counts_of({.rev_per_sample = 0.0}).findings({.has_index = true})).c_str());
}

TEST(EncoderCounts, tell_degrees_from_another_number_of_counts) {
    const EncoderCounts in_degrees = counts_of({.recorded_scale = 180.0 / std::numbers::pi});
    STRCMP_CONTAINS("is it in degrees?", lines_of(in_degrees.findings({.has_index = true})).c_str());
    STRCMP_CONTAINS("8192 counts per revolution instead of 4096?",
                    lines_of(counts_of({.recorded_scale = 2.0}).findings({.has_index = true})).c_str());
    CHECK_FALSE(in_degrees.is_proven(true));
}

TEST(EncoderCounts, begin_anew_after_a_sample_without_a_count) {
    const EncoderCounts counts = counts_of({.without_count_every = 3});  // and a turn has 20 samples
    STRCMP_CONTAINS("no index pulses in the recording", lines_of(counts.findings({.has_index = true})).c_str());
    CHECK_FALSE(counts.is_proven(true));
}
