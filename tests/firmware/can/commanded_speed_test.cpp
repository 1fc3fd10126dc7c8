// SPDX-License-Identifier: Apache-2.0
#include "firmware/can/controller_on_loopback.hpp"

#include <string>

#include <CppUTest/TestHarness.h>

#include "control/cut_state.hpp"
#include "loop/scenario.hpp"

using namespace millforce;
using namespace millforce::test;

namespace {

constexpr float turns_at_rad_s = 418.9F;  // of turning_in_air()

/// A feed move in air, with a spindle that runs evenly.
control::Fault fault_after_3_s(float commanded_rad_s) {
    ControllerOnLoopback bus(sim::read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/slot_entry.toml"));
    hal::ProgramStatus status{25.0F};
    status.commanded_speed_rad_s = commanded_rad_s;
    for (std::uint32_t n = 1; n <= 3000; ++n) {
        hal::DriveSample sample = turning_in_air(n);
        sample.axis_velocity_mm_s = {n < 300 ? 0.0F : 20.0F, 0.0F, 0.0F};
        (void)bus.step(sample, status);
    }
    return bus.controller.controller().control().fault;
}

}  // namespace

TEST_GROUP(CommandedSpeedOnCan){};

TEST(CommandedSpeedOnCan, holds_the_feed_where_the_encoder_says_another) {
    CHECK(fault_after_3_s(0.25F * turns_at_rad_s) == control::Fault::encoder_mismatch);
    CHECK(fault_after_3_s(2.0F * turns_at_rad_s) == control::Fault::encoder_mismatch);
}

TEST(CommandedSpeedOnCan, is_no_fault_where_it_is_the_spindles_or_is_not_told) {
    CHECK(fault_after_3_s(turns_at_rad_s) != control::Fault::encoder_mismatch);
    CHECK(fault_after_3_s(0.0F) != control::Fault::encoder_mismatch);
}
