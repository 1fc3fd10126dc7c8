// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "firmware_can/bus_settings.hpp"
#include "firmware_can/can_controller.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using firmware::CanController;

namespace {

constexpr std::uint64_t start_us = 1'700'000'000'000'000;

firmware::CanControllerSettings nothing_on_the_bus() {
    firmware::CanControllerSettings settings = firmware::can_controller_settings({}, {});
    settings.drives.beside_bus =
        hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::spindle_current) | hal::axis_mask(0);
    settings.begins_at_once = true;
    return settings;
}

firmware::Parameters<float> a_mill() {
    firmware::Parameters<float> parameters;
    parameters.tool.tooth_force_limit_N = 700.0F;
    return parameters;
}

class TickTimes final : public firmware::TickListener {
  public:
    void on_tick(const CanController& controller) override { records.push_back(controller.record()); }
    std::vector<firmware::TickRecord> records{};
};

hal::DriveSample sample_of(int cycle, bool has_x_current) {
    hal::DriveSample sample;
    sample.present = hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::spindle_current);
    sample.spindle_count = static_cast<std::uint32_t>(273 * cycle);
    sample.spindle_current_A = 5.0F + 0.1F * static_cast<float>(cycle % 7);
    sample.axis_current_A[0] = 1.0F;
    sample.axis_velocity_mm_s[0] = 10.0F;
    hal::set_known(sample, 0, has_x_current, true);
    return sample;
}

/// SYNC every millisecond, and what is beside the bus right after it.
void sync_and_add(CanController& controller, int first, int cycles, bool has_x_current, bool polls_late = false) {
    for (int cycle = first; cycle < first + cycles; ++cycle) {
        const std::uint64_t time_us = start_us + 1000 * static_cast<std::uint64_t>(cycle);
        hal::CanFrame sync;
        sync.id = 0x080;
        if (polls_late) {
            controller.poll(time_us + 300'000);
        }
        controller.on_frame(sync, time_us, false);
        controller.add(sample_of(cycle, has_x_current));
        controller.poll(polls_late ? time_us + 300'000 : time_us);
    }
}

}  // namespace

TEST_GROUP(SamplesBesideBus){};

TEST(SamplesBesideBus, a_machine_without_a_drive_on_its_bus_ticks_once_per_sync) {
    TickTimes ticks;
    CanController controller(nothing_on_the_bus(), a_mill(), &ticks);
    sync_and_add(controller, 0, 200, true);
    UNSIGNED_LONGS_EQUAL(200, ticks.records.size());
    CHECK_FALSE(controller.conditions().has(firmware::Condition::input_incomplete));
    DOUBLES_EQUAL(5.3, controller.sample().spindle_current_A, 1e-5);
}

TEST(SamplesBesideBus, frames_and_samples_in_their_order_give_the_same_ticks_however_late_they_are_fetched) {
    TickTimes in_time;
    TickTimes late;
    CanController one(nothing_on_the_bus(), a_mill(), &in_time);
    CanController other(nothing_on_the_bus(), a_mill(), &late);
    sync_and_add(one, 0, 500, true);
    sync_and_add(other, 0, 500, true, true);
    UNSIGNED_LONGS_EQUAL(in_time.records.size(), late.records.size());
    for (std::size_t k = 0; k < late.records.size(); ++k) {
        CHECK(in_time.records[k].time_us == late.records[k].time_us);
        DOUBLES_EQUAL(in_time.records[k].feed_override.ratio, late.records[k].feed_override.ratio, 0.0);
    }
}

TEST(SamplesBesideBus, a_current_that_stays_away_is_incomplete_input_and_then_the_fault_stale_input) {
    CanController controller(nothing_on_the_bus(), a_mill());
    sync_and_add(controller, 0, 100, true);
    CHECK_FALSE(controller.output().fault != 0);
    sync_and_add(controller, 100, 300, false);
    CHECK(controller.conditions().has(firmware::Condition::input_incomplete));
    UNSIGNED_LONGS_EQUAL(static_cast<unsigned>(control::Fault::stale_input), controller.output().fault);
    CHECK(controller.output().hold);
}
