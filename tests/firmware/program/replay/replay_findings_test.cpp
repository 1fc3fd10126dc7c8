// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cstdint>
#include <string>
#include <vector>

#include "replay/replay_findings.hpp"

using namespace millforce;
using host::ReplayFindings;

namespace {

constexpr std::uint32_t counts_per_rev = 4096;
constexpr int samples = 1000;

/// What a replay of a sound cut says, of which a law leaves the misfit `refuted_misfit` in one sample of `every`.
std::vector<std::string> notes_of(float refuted_misfit, int every) {
    ReplayFindings findings(counts_per_rev);
    for (int k = 0; k < samples; ++k) {
        hal::DriveSample sample{};
        sample.time_us = static_cast<std::uint32_t>(500 * k);
        sample.spindle_count = static_cast<std::uint32_t>(100 * k);
        hal::set_present(sample, hal::Present::spindle_current);
        firmware::TickRecord record;
        record.tangential_force_N = 200.0F;
        record.law_misfit = k % every == 0 ? refuted_misfit : 0.5F;
        findings.follow(sample, record);
    }
    return findings.notes();
}

}  // namespace

TEST_GROUP(ReplayFindings){};

TEST(ReplayFindings, are_none_in_a_sound_cut) {
    UNSIGNED_LONGS_EQUAL(0, notes_of(0.5F, 1).size());
    UNSIGNED_LONGS_EQUAL(0, notes_of(15.9F, 1).size());
}

TEST(ReplayFindings, say_that_the_law_does_not_explain_the_forces) {
    const std::vector<std::string> notes = notes_of(17.0F, 10);
    UNSIGNED_LONGS_EQUAL(1, notes.size());
    STRNCMP_EQUAL("the tool's law does not explain the forces (law_misfit above 16) in 100 of 1000 samples",
                  notes[0].c_str(), 87);
}

TEST(ReplayFindings, do_not_complain_of_single_samples) {
    UNSIGNED_LONGS_EQUAL(0, notes_of(40.0F, 25).size());
}
