// SPDX-License-Identifier: Apache-2.0
#include "bus_bench.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>

using namespace millforce;
using namespace millforce::cia402;
using namespace millforce::cia402::bench;

TEST_GROUP(DriveBus){};

TEST(DriveBus, reads_the_rated_currents_starts_the_drives_and_samples_at_every_sync) {
    TwoDrives machine;
    machine.run_ms(100);
    CHECK(machine.both_operational());
    DOUBLES_EQUAL(12.0, machine.bus.node(DriveRole::spindle).rated_current_A(), 1e-6);
    DOUBLES_EQUAL(10.0, machine.bus.node(DriveRole::x_axis).rated_current_A(), 1e-6);
    machine.samples.clear();
    machine.run_ms(100);
    UNSIGNED_LONGS_EQUAL(100, machine.samples.size());
    for (const hal::DriveSample& sample : machine.samples) {
        UNSIGNED_LONGS_EQUAL(hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::spindle_current) |
                                 hal::mask(hal::Present::x_axis),
                             sample.present);
    }
    CHECK(machine.spindle_health().power == PowerState::operation_enabled);
}

TEST(DriveBus, samples_carry_amperes_counts_and_millimetres_per_second) {
    TwoDrives machine;
    machine.run_ms(50);
    machine.spindle().set_current_A(7.2);
    machine.x().set_current_A(-3.0);
    for (int k = 0; k < 40; ++k) {
        machine.spindle().set_position(1000 + 137 * k);
        machine.x().set_position(-25 * k);  // 25 µm per ms
        machine.run_ms(1);
    }
    const hal::DriveSample& last = machine.samples.back();
    const hal::DriveSample& before = machine.samples[machine.samples.size() - 2];
    DOUBLES_EQUAL(7.2, last.spindle_current_A, 1e-5);
    DOUBLES_EQUAL(-3.0, last.axis_current_A[0], 1e-5);
    DOUBLES_EQUAL(-25.0, last.axis_velocity_mm_s[0], 1e-3);
    UNSIGNED_LONGS_EQUAL(137, last.spindle_count - before.spindle_count);
    UNSIGNED_LONGS_EQUAL(1000, last.time_us - before.time_us);
}

TEST(DriveBus, a_sample_is_handed_over_as_soon_as_the_last_drive_answered) {
    TwoDrives machine;
    machine.run_ms(50);
    machine.samples.clear();
    while (machine.samples.empty()) {
        machine.run_us(20);
    }
    const std::uint64_t latency_us = machine.now_us - machine.samples.back().time_us;
    CHECK(latency_us < 400);  // SYNC and two PDOs at 1 Mbit/s
}

TEST(DriveBus, a_drive_without_power_is_waited_for_and_taken_in_when_it_boots) {
    TwoDrives machine;
    machine.x().set_power(false);
    machine.run_ms(1000);
    CHECK(machine.spindle_health().state == NodeState::operational);
    CHECK(machine.x_health().state == NodeState::preparing);
    CHECK(has(machine.samples.back(), hal::Present::spindle_current));
    CHECK_FALSE(has(machine.samples.back(), hal::Present::x_axis));
    machine.x().set_power(true);
    machine.run_ms(50);
    CHECK(machine.both_operational());
    CHECK(has(machine.samples.back(), hal::Present::x_axis));
}

TEST(DriveBus, a_drive_that_vanishes_is_lost_after_its_heartbeat_timeout_and_comes_back_by_itself) {
    BusSettings settings = two_drives();
    settings.drives[1].heartbeat_timeout_us = 50'000;
    settings.drives[1].heartbeat_period_ms = 10;
    TwoDrives machine(settings);
    machine.run_ms(100);
    UNSIGNED_LONGS_EQUAL(10, machine.x().object(object::producer_heartbeat_time_ms, 0));
    CHECK(machine.both_operational());
    machine.x().set_power(false);
    machine.run_ms(2);
    CHECK_FALSE(has(machine.samples.back(), hal::Present::x_axis));
    machine.run_ms(60);
    CHECK(machine.x_health().state == NodeState::lost);
    UNSIGNED_LONGS_EQUAL(1, machine.x_health().times_lost);
    machine.x().set_power(true);
    machine.run_ms(50);
    CHECK(machine.both_operational());
}

TEST(DriveBus, a_lost_pdo_is_a_missing_quantity_of_one_sample_and_nothing_else) {
    TwoDrives machine;
    machine.run_ms(50);
    int to_lose = 1;
    machine.wire.set_fault([&](const hal::CanFrame& f) {
        const bool lose = f.id == 0x182 && to_lose-- > 0;
        return sim::LoopbackBus::Fate{lose ? 0 : 1, 0, f};
    });
    machine.samples.clear();
    machine.run_ms(20);
    int missing = 0;
    for (const hal::DriveSample& sample : machine.samples) {
        missing += has(sample, hal::Present::x_axis) ? 0 : 1;
        CHECK(has(sample, hal::Present::spindle_count));
    }
    LONGS_EQUAL(1, missing);
}

TEST(DriveBus, a_pdo_that_comes_after_its_sample_is_late_and_not_used_and_the_next_sample_waits_for_its_own) {
    TwoDrives machine;
    machine.run_ms(50);
    machine.wire.set_fault([&](const hal::CanFrame& f) {
        return sim::LoopbackBus::Fate{1, f.id == 0x182 ? 730ULL : 0ULL, f};
    });
    machine.run_us(20);
    machine.samples.clear();
    const std::uint32_t before = machine.bus.rejects()[Reject::pdo_late];
    machine.run_ms(20);
    LONGS_EQUAL(10, machine.bus.rejects()[Reject::pdo_late] - before);
    const auto has_x = [](const hal::DriveSample& sample) { return has(sample, hal::Present::x_axis); };
    LONGS_EQUAL(10, std::count_if(machine.samples.begin(), machine.samples.end(), has_x));
    LONGS_EQUAL(20, machine.samples.size());
    CHECK(has(machine.samples.back(), hal::Present::spindle_count));
}

TEST(DriveBus, answers_that_come_after_the_next_sync_are_not_taken_for_its_own) {
    constexpr std::uint32_t counts_per_ms = 137;
    TwoDrives machine;
    machine.run_ms(50);
    int spindle_answers = 0;
    int x_answers = 0;
    machine.wire.set_fault([&](const hal::CanFrame& f) {
        const bool delay = (f.id == 0x181 && ++spindle_answers == 10) || (f.id == 0x182 && ++x_answers == 10);
        return sim::LoopbackBus::Fate{1, delay ? 900ULL : 0ULL, f};
    });
    machine.samples.clear();
    for (int k = 0; k < 40; ++k) {
        machine.spindle().set_position(1000 + static_cast<std::int32_t>(counts_per_ms) * k);
        machine.run_ms(1);
    }
    const auto lacks_the_count = [](const hal::DriveSample& sample) {
        return !has(sample, hal::Present::spindle_count);
    };
    LONGS_EQUAL(1, std::erase_if(machine.samples, lacks_the_count));
    for (std::size_t k = 2; k < machine.samples.size(); ++k) {
        const std::uint32_t counts = machine.samples[k].spindle_count - machine.samples[k - 1].spindle_count;
        const std::uint32_t elapsed_us = machine.samples[k].time_us - machine.samples[k - 1].time_us;
        DOUBLES_EQUAL(counts_per_ms, counts * 1000.0 / elapsed_us, 1.0);
    }
}

TEST(DriveBus, duplicated_pdos_are_counted_and_change_nothing) {
    TwoDrives machine;
    machine.run_ms(50);
    machine.wire.set_fault([](const hal::CanFrame& f) {
        return sim::LoopbackBus::Fate{f.id == 0x181 || f.id == 0x182 ? 2 : 1, 0, f};
    });
    machine.samples.clear();
    machine.run_ms(20);
    for (const hal::DriveSample& sample : machine.samples) {
        CHECK(has(sample, hal::Present::spindle_count));
        CHECK(has(sample, hal::Present::x_axis));
    }
    const RejectCounters& rejects = machine.bus.rejects();
    CHECK(rejects[Reject::pdo_repeated] + rejects[Reject::pdo_late] >= 38);
}

TEST(DriveBus, a_pdo_of_another_length_is_rejected_longer_or_shorter) {
    for (const unsigned length : {0U, 1U, 7U}) {
        TwoDrives machine;
        machine.run_ms(50);
        machine.wire.set_fault([&](const hal::CanFrame& f) {
            sim::LoopbackBus::Fate fate{1, 0, f};
            fate.frame.length = f.id == 0x182 ? static_cast<std::uint8_t>(length) : f.length;
            return fate;
        });
        machine.run_ms(5);
        machine.samples.clear();
        machine.run_ms(20);
        CHECK(machine.bus.rejects()[Reject::pdo_length] >= 19);
        CHECK_FALSE(has(machine.samples.back(), hal::Present::x_axis));
    }
}

TEST(DriveBus, a_current_in_milliamperes_instead_of_per_mille_is_out_of_range) {
    TwoDrives machine;
    machine.run_ms(50);
    machine.x().set_current_A(10.0 * 5.0);  // 5000 where 500 is meant: 5 A in mA
    machine.run_ms(5);
    CHECK_FALSE(has(machine.samples.back(), hal::Present::x_axis));
    CHECK(machine.bus.rejects()[Reject::current_range] >= 4);
}

TEST(DriveBus, a_drive_at_its_torque_limit_tells_no_current_where_the_largest_share_is_just_below_it) {
    BusSettings settings = two_drives();
    settings.drives[0].largest_share_of_rated = 1.45F;
    TwoDrives machine(settings);
    machine.run_ms(50);
    const double limit_A = 1.5 * 1e-3 * machine.spindle().object(object::rated_current_mA, 0);
    for (const double noise : {-0.02, 0.0, 0.02}) {
        machine.spindle().set_current_A((1.0 + noise) * limit_A);
        machine.run_ms(5);
        CHECK_FALSE(has(machine.samples.back(), hal::Present::spindle_current));
    }
    machine.spindle().set_current_A(0.9 * limit_A);
    machine.run_ms(5);
    CHECK_TRUE(has(machine.samples.back(), hal::Present::spindle_current));
}

TEST(DriveBus, a_spindle_count_that_jumps_is_withheld_once_and_followed_from_there) {
    BusSettings settings = two_drives();
    settings.drives[0].largest_count_step = 500;
    TwoDrives machine(settings);
    machine.run_ms(50);
    machine.spindle().set_position(100'000);
    machine.samples.clear();
    machine.run_ms(10);
    int missing = 0;
    for (const hal::DriveSample& sample : machine.samples) {
        missing += has(sample, hal::Present::spindle_count) ? 0 : 1;
    }
    LONGS_EQUAL(1, missing);
    UNSIGNED_LONGS_EQUAL(1, machine.bus.rejects()[Reject::position_step]);
}

TEST(DriveBus, emergencies_are_decoded_and_end_with_the_error_reset) {
    TwoDrives machine;
    machine.run_ms(50);
    machine.x().raise_emergency(0x4310, 0x09);
    machine.x().set_statusword(0x0238);
    machine.run_ms(5);
    CHECK(machine.x_health().emergency_active);
    UNSIGNED_LONGS_EQUAL(0x4310, machine.x_health().emergency.error_code);
    CHECK(emergency_class(machine.x_health().emergency.error_code) == EmergencyClass::temperature);
    CHECK(machine.x_health().power == PowerState::fault);
    CHECK(is_faulted(machine.x_health().power));
    machine.x().raise_emergency(0, 0);
    machine.run_ms(5);
    CHECK_FALSE(machine.x_health().emergency_active);
}

TEST(DriveBus, writes_any_mapping_to_the_drive_and_decodes_it) {
    BusSettings settings = two_drives();
    DriveSettings& x = settings.drives[1];
    x.write_mapping = true;
    x.velocity_source = VelocitySource::velocity;
    x.velocity_mm_s_per_unit = 0.01F;
    x.pdos[0].object_count = 2;
    x.pdos[0].objects = {mapped(object::current_actual, 16), mapped(object::position_actual, 32)};
    x.pdos[2].id = 0x382;
    x.pdos[2].object_count = 3;
    x.pdos[2].objects = {mapped(object::statusword, 16), mapped(object::torque_actual, 16),
                         mapped(object::velocity_actual, 32)};
    TwoDrives machine(settings);
    machine.run_ms(200);
    CHECK(machine.both_operational());
    UNSIGNED_LONGS_EQUAL(0, machine.x().aborts());
    machine.x().set_current_A(2.0);
    for (int k = 0; k < 300; ++k) {
        machine.x().set_velocity(-1250);
        machine.x().set_position(static_cast<int>(-12.5 * k));
        machine.run_ms(1);
    }
    DOUBLES_EQUAL(2.0, machine.samples.back().axis_current_A[0], 1e-5);
    DOUBLES_EQUAL(-12.5, machine.samples.back().axis_velocity_mm_s[0], 1e-4);
    CHECK_FALSE(machine.x_health().units_disagree);
}

TEST(DriveBus, a_velocity_in_another_unit_than_configured_is_found_by_the_position) {
    BusSettings settings = two_drives();
    DriveSettings& x = settings.drives[1];
    x.write_mapping = true;
    x.velocity_source = VelocitySource::velocity;
    x.velocity_mm_s_per_unit = 0.01F;
    x.pdos[0].object_count = 2;
    x.pdos[0].objects = {mapped(object::current_actual, 16), mapped(object::position_actual, 32)};
    x.pdos[1].id = 0x282;
    x.pdos[1].object_count = 1;
    x.pdos[1].objects = {mapped(object::velocity_actual, 32)};
    TwoDrives machine(settings);
    machine.run_ms(200);
    for (int k = 0; k < 300; ++k) {
        machine.x().set_velocity(1250 * 60);  // mm/min where mm/s is configured
        machine.x().set_position(static_cast<int>(12.5 * k));
        machine.run_ms(1);
    }
    CHECK(machine.x_health().units_disagree);
    CHECK_FALSE(has(machine.samples.back(), hal::Present::x_axis));
}

TEST(DriveBus, an_aborted_write_is_a_refusal_with_its_code_and_is_tried_again) {
    BusSettings settings = two_drives();
    settings.drives[1].write_mapping = true;
    settings.drives[1].pdos[0].objects[1].bits = 8;  // the object has 16
    TwoDrives machine(settings);
    machine.run_ms(300);
    CHECK(machine.x_health().state == NodeState::refused);
    UNSIGNED_LONGS_EQUAL(0x06040041, machine.x_health().sdo_abort_code);
    const std::uint64_t aborts = machine.x().aborts();
    machine.run_ms(1500);
    CHECK(machine.x().aborts() > aborts);
}

TEST(DriveBus, a_listener_sends_nothing_and_reads_what_the_cnc_started) {
    BusSettings settings = two_drives();
    settings.is_master = false;
    settings.drives[0].rated_current_A = 12.0F;
    settings.drives[1].rated_current_A = 10.0F;
    TwoDrives machine(settings, false);
    const int cnc = machine.wire.attach([](const hal::CanFrame&, std::uint64_t) {});
    machine.spindle().set_current_A(6.0);
    machine.run_ms(5);
    machine.wire.send(cnc, frame_of(0x000, {0x01, 0x00}), machine.now_us);
    for (int k = 0; k < 20; ++k) {
        machine.wire.send(cnc, frame_of(0x080, {}), machine.now_us);
        machine.run_ms(1);
    }
    hal::CanFrame sent;
    CHECK_FALSE(machine.bus.take_frame(sent));
    CHECK(machine.both_operational());
    CHECK_FALSE(machine.bus.health().sync_lost);
    DOUBLES_EQUAL(6.0, machine.samples.back().spindle_current_A, 1e-5);
    machine.run_ms(10);
    CHECK(machine.bus.health().sync_lost);
}

TEST(DriveBus, currents_of_a_drive_rated_in_peak_amperes_become_rms) {
    BusSettings settings = two_drives();
    settings.drives[0].current_basis = CurrentBasis::peak;
    settings.drives[0].current_reversed = true;
    TwoDrives machine(settings);
    machine.run_ms(50);
    machine.spindle().set_current_A(6.0);
    machine.run_ms(5);
    DOUBLES_EQUAL(-6.0 / std::sqrt(2.0), machine.samples.back().spindle_current_A, 1e-4);
}

TEST(DriveBus, a_drive_that_tells_torque_alone_gives_its_current_by_the_torque_constant) {
    BusSettings settings = two_drives();
    DriveSettings& spindle = settings.drives[0];
    spindle.current_source = CurrentSource::torque;
    spindle.torque_constant_Nm_per_A = 0.8F;
    spindle.write_mapping = true;
    spindle.pdos[0].objects[1] = mapped(object::torque_actual, 16);
    TwoDrives machine(settings);
    machine.run_ms(100);
    CHECK(machine.both_operational());
    machine.spindle().set_torque_Nm(-4.0);
    machine.run_ms(5);
    DOUBLES_EQUAL(-5.0, machine.samples.back().spindle_current_A, 1e-4);
}

TEST(DriveBus, a_spindle_that_counts_backwards_with_a_modulus_and_an_index_is_unwrapped) {
    BusSettings settings = two_drives();
    DriveSettings& spindle = settings.drives[0];
    spindle.count_modulus = 4096;
    spindle.largest_count_step = 1000;
    spindle.count_reversed = true;
    spindle.index_count_object = {0x60BA, 0};
    spindle.index_number_object = {0x60D5, 0};
    spindle.write_mapping = true;
    spindle.pdos[1].id = 0x281;
    spindle.pdos[1].object_count = 2;
    spindle.pdos[1].objects = {mapped(0x60BA, 32), mapped(0x60D5, 16)};
    TwoDrives machine(settings);
    machine.spindle().set_position(4000);
    machine.run_ms(100);
    std::uint32_t first = machine.samples.back().spindle_count;
    for (int k = 1; k <= 50; ++k) {
        const int raw = ((4000 - 300 * k) % 4096 + 4096) % 4096;
        if (raw > 4096 - 300) {
            machine.spindle().latch_index(0);
        }
        machine.spindle().set_position(raw);
        machine.run_ms(1);
        const hal::DriveSample& sample = machine.samples.back();
        CHECK(has(sample, hal::Present::spindle_count));
        UNSIGNED_LONGS_EQUAL(static_cast<std::uint32_t>(300 * k), sample.spindle_count - first);
        if (sample.spindle_index_number > 0) {
            UNSIGNED_LONGS_EQUAL((4096 - raw) % 4096, sample.spindle_count - sample.spindle_index_count);
        }
    }
    CHECK(machine.samples.back().spindle_index_number >= 3);
}

TEST(DriveBus, after_a_count_that_jumped_the_index_is_unknown_until_its_next_pulse) {
    BusSettings settings = two_drives();
    settings.drives[0].largest_count_step = 500;
    settings.drives[0].index_count_object = {0x60BA, 0};
    settings.drives[0].index_number_object = {0x60D5, 0};
    settings.drives[0].write_mapping = true;
    settings.drives[0].pdos[1].id = 0x281;
    settings.drives[0].pdos[1].object_count = 2;
    settings.drives[0].pdos[1].objects = {mapped(0x60BA, 32), mapped(0x60D5, 16)};
    TwoDrives machine(settings);
    machine.spindle().latch_index(-100);
    machine.run_ms(100);
    UNSIGNED_LONGS_EQUAL(1, machine.samples.back().spindle_index_number);
    LONGS_EQUAL(100, machine.samples.back().spindle_count - machine.samples.back().spindle_index_count);
    machine.spindle().set_position(100'000);
    machine.run_ms(5);
    UNSIGNED_LONGS_EQUAL(0, machine.samples.back().spindle_index_number);
    machine.spindle().latch_index(99'990);
    machine.run_ms(5);
    UNSIGNED_LONGS_EQUAL(1, machine.samples.back().spindle_index_number);
    LONGS_EQUAL(10, machine.samples.back().spindle_count - machine.samples.back().spindle_index_count);
}

TEST(DriveBus, by_event_pdos_are_used_until_they_are_stale) {
    BusSettings settings = two_drives();
    settings.is_master = false;
    settings.drives[0].rated_current_A = 12.0F;
    settings.drives[0].pdos[0].transmission_type = 255;
    settings.drives[0].stale_us = 5000;
    settings.drives[1].node_id = 0;
    BusBench machine(settings);
    machine.run_ms(5);
    machine.inject(frame_of(0x181, {0, 1, 0, 0, 0xF4, 0x01, 0x37, 0x02}));
    machine.run_ms(3);
    CHECK(has(machine.samples.back(), hal::Present::spindle_current));
    DOUBLES_EQUAL(6.0, machine.samples.back().spindle_current_A, 1e-5);
    machine.run_ms(5);
    CHECK_FALSE(has(machine.samples.back(), hal::Present::spindle_current));
}
