// SPDX-License-Identifier: Apache-2.0
#include "controller_on_loopback.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;
using firmware::Condition;

namespace {

sim::Scenario slot() {
    return sim::read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/slot_entry.toml");
}

/// A spindle that turns at 4000 rpm in air, x at 20 mm/s, and F1500 in the CNC.
class Machine : public ControllerOnLoopback {
  public:
    explicit Machine(const sim::Scenario& scenario = slot()) : ControllerOnLoopback(scenario) {
        program.programmed_feed_mm_s = 25.0F;
        run_ms(300);
    }
    void run_ms(int duration_ms) {
        for (int k = 0; k < duration_ms; ++k) {
            ++sample_count_;
            hal::DriveSample sample = turning_in_air(sample_count_);
            sample.axis_current_A = {2.0F, 0.0F, 0.0F};
            sample.axis_velocity_mm_s = {velocity_mm_s, 0.0F, 0.0F};
            newest = step(sample, program);
        }
    }
    [[nodiscard]] bool has(Condition condition) const { return controller.conditions().has(condition); }
    [[nodiscard]] std::uint8_t fault() const { return controller.output().fault; }

    hal::ProgramStatus program{};
    float velocity_mm_s = 20.0F;
    hal::FeedOverride newest{};

  private:
    std::uint32_t sample_count_ = 0;
};

constexpr auto stale_input = static_cast<std::uint8_t>(control::Fault::stale_input);

}  // namespace

TEST_GROUP(Supervision){};

TEST(Supervision, a_machine_that_is_well_has_no_condition_and_a_tick_per_sync) {
    Machine machine;
    const std::uint32_t before = machine.controller.ticks();
    machine.run_ms(200);
    UNSIGNED_LONGS_EQUAL(200, machine.controller.ticks() - before);
    CHECK(machine.controller.conditions().none());
    CHECK_FALSE(machine.newest.hold);
    CHECK(machine.newest.ratio > 0.0F);
}

TEST(Supervision, before_the_first_complete_sample_no_override_goes_out) {
    ControllerOnLoopback machine(slot());
    machine.machine.drive(3).set_power(false);
    machine.run_us(500'000);
    UNSIGNED_LONGS_EQUAL(0, machine.controller.ticks());
    CHECK(machine.controller.conditions().has(Condition::drive_preparing));
    for (const LoggedFrame& logged : machine.log) {
        CHECK(logged.frame.id != 0x1FE);
    }
    machine.machine.drive(3).set_power(true);
    machine.run_us(500'000);
    CHECK(machine.controller.ticks() > 100);
    UNSIGNED_LONGS_EQUAL(0, machine.controller.output().fault);
}

TEST(Supervision, a_pdo_that_is_lost_now_and_then_costs_its_sample_and_no_more) {
    Machine machine;
    int frames = 0;
    machine.wire.set_fault([&](const hal::CanFrame& f) {
        return sim::LoopbackBus::Fate{f.id == 0x182 && ++frames % 10 == 0 ? 0 : 1, 0, f};
    });
    const std::uint32_t before = machine.controller.ticks();
    machine.run_ms(1000);
    DOUBLES_EQUAL(900, machine.controller.ticks() - before, 5);
    UNSIGNED_LONGS_EQUAL(0, machine.fault());
    CHECK_FALSE(machine.newest.hold);
    CHECK(machine.controller.controller().estimate().tangential_N.valid);
}

TEST(Supervision, a_drive_that_vanishes_is_stale_input_within_its_time_and_lost_by_name) {
    Machine machine;
    machine.machine.drive(1).set_power(false);
    machine.run_ms(40);
    UNSIGNED_LONGS_EQUAL(0, machine.fault());
    CHECK(machine.has(Condition::input_incomplete));
    machine.run_ms(20);
    UNSIGNED_LONGS_EQUAL(stale_input, machine.fault());
    CHECK(machine.has(Condition::input_stale));
    CHECK(machine.newest.hold);
    machine.run_ms(600);
    CHECK(machine.has(Condition::drive_lost));
    machine.machine.drive(1).set_power(true);
    machine.run_ms(300);
    CHECK_FALSE(machine.has(Condition::drive_lost));
    CHECK_FALSE(machine.has(Condition::input_incomplete));
    UNSIGNED_LONGS_EQUAL(stale_input, machine.fault());  // latched
}

TEST(Supervision, a_latched_fault_is_reset_by_the_cnc_at_standstill_only) {
    Machine machine;
    machine.machine.drive(1).set_power(false);
    machine.run_ms(700);
    machine.machine.drive(1).set_power(true);
    machine.run_ms(300);
    UNSIGNED_LONGS_EQUAL(stale_input, machine.fault());
    machine.cnc.press_reset(true);
    machine.run_ms(30);
    UNSIGNED_LONGS_EQUAL(stale_input, machine.fault());
    machine.cnc.press_reset(false);
    machine.velocity_mm_s = 0.0F;
    machine.run_ms(30);
    machine.cnc.press_reset(true);
    machine.run_ms(30);
    UNSIGNED_LONGS_EQUAL(0, machine.fault());
    CHECK_FALSE(machine.newest.hold);
}

TEST(Supervision, a_drive_in_fault_holds_the_feed_as_long_as_it_is) {
    Machine machine;
    machine.machine.drive(2).set_statusword(0x0208);
    machine.run_ms(10);
    CHECK(machine.has(Condition::drive_not_enabled));
    CHECK(machine.newest.hold);
    machine.machine.drive(2).set_statusword(0x0237);
    machine.run_ms(10);
    CHECK_FALSE(machine.has(Condition::drive_not_enabled));
    CHECK_FALSE(machine.newest.hold);
}

TEST(Supervision, an_emergency_is_told_and_changes_nothing_else) {
    Machine machine;
    machine.machine.drive(2).raise_emergency(0x4210, 0x08);
    machine.run_ms(10);
    CHECK(machine.has(Condition::drive_emergency));
    CHECK_FALSE(machine.newest.hold);
    machine.machine.drive(2).raise_emergency(0x0000, 0x00);
    machine.run_ms(10);
    CHECK_FALSE(machine.has(Condition::drive_emergency));
}

TEST(Supervision, without_a_cnc_that_tells_F_the_override_stays_at_its_minimum) {
    const sim::Scenario scenario = slot();
    ControllerOnLoopback machine(scenario);
    machine.silence_cnc();
    for (std::uint32_t k = 1; k < 1000; ++k) {
        hal::DriveSample sample;
        sample.present = hal::all_present;
        sample.time_us = 1000U * k;
        sample.spindle_count = 546U * k;
        sample.spindle_current_A = 2.0F;
        machine.step(sample, {});
    }
    CHECK(machine.controller.conditions().has(Condition::program_unknown));
    DOUBLES_EQUAL(scenario.parameters.machine.cnc.override_min, machine.controller.output().ratio, 1e-6);
}

TEST(Supervision, a_cnc_that_falls_silent_has_the_feed_held_until_it_speaks_again) {
    Machine machine;
    machine.wire.set_fault([](const hal::CanFrame& f) { return sim::LoopbackBus::Fate{f.id == 0x1FD ? 0 : 1, 0, f}; });
    machine.run_ms(80);
    CHECK_FALSE(machine.newest.hold);
    machine.run_ms(40);
    CHECK(machine.has(Condition::program_silent));
    CHECK(machine.newest.hold);
    machine.wire.set_fault({});
    machine.run_ms(40);
    CHECK_FALSE(machine.newest.hold);
}

TEST(Supervision, a_sync_of_somebody_else_is_told_and_not_followed) {
    Machine machine;
    const std::uint32_t before = machine.controller.ticks();
    hal::CanFrame sync;
    sync.id = 0x080;
    sync.length = 1;  // marks it on the loopback as not the controller's own
    for (int k = 0; k < 20; ++k) {
        machine.controller.on_frame(sync, machine.now_us, false);
        machine.run_ms(1);
    }
    CHECK(machine.has(Condition::sync_foreign));
    UNSIGNED_LONGS_EQUAL(20, machine.controller.foreign_syncs());
    UNSIGNED_LONGS_EQUAL(20, machine.controller.ticks() - before);
}

TEST(Supervision, an_override_or_heartbeat_of_somebody_else_is_told_and_holds_the_feed_for_a_second) {
    for (const std::uint32_t id : {0x1FEU, 0x77EU}) {
        Machine machine;
        CHECK_FALSE(machine.newest.hold);
        hal::CanFrame foreign;
        foreign.id = id;
        foreign.length = 8;
        machine.controller.on_frame(foreign, machine.now_us, false);
        machine.run_ms(10);
        CHECK(machine.has(Condition::override_foreign));
        CHECK(machine.newest.hold);
        machine.run_ms(1000);
        CHECK_FALSE(machine.has(Condition::override_foreign));
        CHECK_FALSE(machine.newest.hold);
    }
}

TEST(Supervision, stop_says_hold_at_once_and_stopped_in_the_heartbeat) {
    Machine machine;
    machine.controller.stop(machine.now_us);
    const std::uint32_t ticks = machine.controller.ticks();
    machine.log.clear();
    machine.run_ms(50);
    UNSIGNED_LONGS_EQUAL(ticks, machine.controller.ticks());
    CHECK(machine.newest.hold);
    bool said_stopped = false;
    for (const LoggedFrame& logged : machine.log) {
        CHECK(logged.frame.id != 0x080);
        if (logged.frame.id == 0x1FE) {
            UNSIGNED_LONGS_EQUAL(1, logged.frame.data[2]);
        }
        said_stopped = said_stopped || (logged.frame.id == 0x77E && logged.frame.data[0] == 0x04);
    }
    CHECK(said_stopped);
}

TEST(Supervision, a_bus_on_which_nothing_passes_is_a_hold_by_the_clock_and_a_latched_fault_when_frames_come_again) {
    Machine machine;
    const std::uint32_t ticks = machine.controller.ticks();
    machine.wire.set_fault([](const hal::CanFrame& f) { return sim::LoopbackBus::Fate{0, 0, f}; });
    hal::CanFrame sent{};
    hal::CanFrame last_override{};
    for (const std::uint64_t end_us = machine.now_us + 60'000; machine.now_us < end_us; machine.now_us += 1000) {
        machine.controller.poll(machine.now_us);
        while (machine.controller.take_frame(sent)) {
            last_override = sent.id == 0x1FE ? sent : last_override;
        }
    }
    UNSIGNED_LONGS_EQUAL(ticks, machine.controller.ticks());
    UNSIGNED_LONGS_EQUAL(1, last_override.data[2]);  // hold
    CHECK(machine.has(Condition::input_stale));
    CHECK(machine.has(Condition::sync_lost));
    machine.wire.set_fault({});
    machine.run_ms(20);
    UNSIGNED_LONGS_EQUAL(stale_input, machine.fault());
    CHECK(machine.newest.hold);
}

TEST(Supervision, the_boot_up_is_repeated_until_it_comes_back) {
    ControllerOnLoopback machine(slot());
    int lost = 0;
    machine.wire.set_fault([&](const hal::CanFrame& f) {
        const bool is_boot_up = f.id == 0x77E && f.data[0] == 0;
        lost += is_boot_up && lost < 2 ? 1 : 0;
        return sim::LoopbackBus::Fate{is_boot_up && machine.now_us < 1'700'000'000'350'000 ? 0 : 1, 0, f};
    });
    machine.run_us(300'000);
    LONGS_EQUAL(2, lost);
    UNSIGNED_LONGS_EQUAL(0, machine.controller.drives().health().syncs);
    machine.run_us(1'000'000);
    CHECK(machine.controller.ticks() > 100);
}

TEST(Supervision, every_condition_has_a_name_of_its_own) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < firmware::condition_count; ++k) {
        names.emplace_back(firmware::name(static_cast<Condition>(k)));
        CHECK(std::count(names.begin(), names.end(), names.back()) == 1);
    }
}
