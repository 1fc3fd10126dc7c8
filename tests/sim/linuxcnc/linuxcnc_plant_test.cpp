// SPDX-License-Identifier: Apache-2.0
#include "linuxcnc/linuxcnc_plant.hpp"

#include <cmath>
#include <numbers>

#include <CppUTest/TestHarness.h>

#include "firmware/tick.hpp"
#include "loop/scenario.hpp"

using namespace millforce::sim;
using millforce::control::CutState;

namespace {

constexpr double period_s = 1e-3;
constexpr double spindle_rev_s = 4000.0 / 60.0;

/// LinuxCNC with the axes at rest beside the part.
class CncAtRest {
  public:
    CncAtRest() : scenario(read_scenario(MILLFORCE_SOURCE_DIR "/sim/linuxcnc/pocket.toml")), plant(scenario) {}

    millforce_plant_reply cycle(bool spindle_on) {
        millforce_plant_command command{};
        command.cycle_number = ++cycles;
        command.period_s = period_s;
        command.spindle_is_on = spindle_on ? 1U : 0U;
        command.spindle_rev_s = spindle_on ? spindle_rev_s : 0.0;
        command.override_ratio = 1.0;
        command.position_mm[0] = -60.0;
        command.position_mm[1] = -50.0;
        command.position_mm[2] = 50.0;
        return plant.step(command);
    }

    Scenario scenario;
    LinuxCncPlant plant;
    std::uint32_t cycles = 0;
};

millforce::hal::DriveSample sample_of(const millforce_plant_reply& reply) {
    millforce::hal::DriveSample sample;
    sample.time_us = reply.cycle_number * 1000U;
    sample.present = millforce::hal::all_present;
    sample.spindle_count = reply.count;
    sample.spindle_index_count = reply.index_count;
    sample.spindle_index_number = static_cast<std::uint8_t>(reply.index_number);
    sample.spindle_current_A = static_cast<float>(reply.spindle_current_A);
    for (std::size_t axis = 0; axis < MILLFORCE_PLANT_AXES; ++axis) {
        sample.axis_current_A[axis] = static_cast<float>(reply.current_A[axis]);
        sample.axis_velocity_mm_s[axis] = static_cast<float>(reply.velocity_mm_s[axis]);
    }
    return sample;
}

}  // namespace

TEST_GROUP(LinuxCncPlant){};

TEST(LinuxCncPlant, runs_its_spindle_up_as_fast_as_its_current_allows) {
    CncAtRest cnc;
    const auto& spindle = cnc.scenario.machine.spindle;
    const double most_rad_s2 = 2.5 * spindle.rated_current_A * spindle.torque_constant_Nm_per_A / spindle.inertia_kg_m2;
    double last_rad_s = 0.0;
    for (int k = 0; k < 1000; ++k) {
        const double speed_rad_s = cnc.cycle(true).spindle_rev_s * 2.0 * std::numbers::pi;
        CHECK(speed_rad_s - last_rad_s <= most_rad_s2 * period_s);
        last_rad_s = speed_rad_s;
    }
    DOUBLES_EQUAL(spindle_rev_s * 2.0 * std::numbers::pi, last_rad_s, 1.0);
}

TEST(LinuxCncPlant, shows_the_controller_no_cut_while_the_spindle_starts) {
    CncAtRest cnc;
    millforce::firmware::ForceControlTick<float> tick(cnc.scenario.parameters);
    for (int k = 0; k < 1500; ++k) {
        millforce::firmware::step_and_work(tick, sample_of(cnc.cycle(k >= 500)), {});
        CHECK(tick.control().state == CutState::air);
    }
    DOUBLES_EQUAL(0.0, static_cast<double>(tick.estimate().tangential_N.value), 40.0);
    const double doubt_N = std::sqrt(static_cast<double>(tick.estimate().tangential_N.variance));
    CHECK(doubt_N < 15.0);  // the idle torque is known by then
}
