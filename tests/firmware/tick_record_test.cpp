// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "firmware/tick.hpp"
#include "firmware/tick_record.hpp"
#include "instructions/synthetic_cut.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using firmware::TickRecord;

namespace {

/// The tick after so many samples of a cut.
struct Run {
    explicit Run(int samples) {
        for (int k = 0; k < samples; ++k) {
            output = firmware::step_and_work(tick, instructions::sample_of(k, parameters, cut),
                                             instructions::program_at(k, cut));
        }
    }
    [[nodiscard]] TickRecord record() const { return firmware::tick_record(tick, output, 12'345); }

    static constexpr const instructions::Cut& cut = instructions::fast_widening_cut;
    firmware::Parameters<float> parameters = instructions::machine_and_tool();
    firmware::ForceControlTick<float> tick{parameters};
    hal::FeedOverride output{};
};

}  // namespace

TEST_GROUP(TickRecord){};

TEST(TickRecord, holds_what_the_tick_knows_in_a_cut) {
    const Run run(Run::cut.samples());
    const TickRecord record = run.record();
    UNSIGNED_LONGS_EQUAL(12'345, record.time_us);
    UNSIGNED_LONGS_EQUAL(run.output.heartbeat, record.feed_override.heartbeat);
    CHECK(record.feed_override.state == static_cast<std::uint8_t>(control::CutState::in_cut));
    DOUBLES_EQUAL(run.output.ratio, record.feed_override.ratio, 0.0);
    DOUBLES_EQUAL(run.tick.estimate().tangential_N.value, record.tangential_force_N, 0.0);
    DOUBLES_EQUAL(run.tick.engagement().radial_immersion, record.radial_immersion, 0.0);
    DOUBLES_EQUAL(run.tick.engagement().axial_depth_sd_mm, record.axial_depth_sd_mm, 0.0);
    CHECK(record.has_tooth_force());
    CHECK(record.has_side());
    CHECK(record.side == run.tick.engagement().side);
    DOUBLES_EQUAL(run.tick.engagement().misfit, record.law_misfit, 0.0);
    DOUBLES_EQUAL(1000.0F * run.tick.estimate().runout_mm, record.runout_um, 0.0);
}

TEST(TickRecord, is_enough_for_whoever_shows_the_total_force_and_its_threshold) {
    const Run run(Run::cut.samples());
    const TickRecord record = run.record();
    const auto shown = firmware::shown_forces(firmware::total_force(run.parameters), record);
    // Several teeth together show no less than one of them; peak and threshold have the same factor.
    CHECK(shown.peak_N >= record.total_force.tooth_force_N);
    CHECK(shown.limit_N >= run.parameters.tool.tooth_force_limit_N);
    DOUBLES_EQUAL(record.total_force.tooth_force_N / run.parameters.tool.tooth_force_limit_N,
                  shown.peak_N / shown.limit_N, 1e-5);
}

TEST(TickRecord, says_no_estimate_in_air) {
    const Run run(Run::cut.air_samples);
    const TickRecord record = run.record();
    CHECK_FALSE(std::isnan(record.tangential_force_N));
    CHECK(std::isnan(record.radial_immersion));
    CHECK(std::isnan(record.axial_depth_mm));
    CHECK_FALSE(record.has_tooth_force());
    CHECK_FALSE(record.has_side());
    CHECK_FALSE(std::isnan(record.runout_um));  // that of the tool stays
    CHECK(std::isnan(firmware::shown_forces(firmware::total_force(run.parameters), record).peak_N));
}
