// SPDX-License-Identifier: Apache-2.0
#include "bus_bench.hpp"

#include "bus/machine_on_bus.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace millforce;
using namespace millforce::cia402;
using namespace millforce::cia402::bench;

namespace {

/// Four drives; axes send velocity beside TPDO 1, the spindle its index pulse.
BusSettings whole_machine() {
    BusSettings settings = two_drives();
    settings.drives[0].write_mapping = true;
    settings.drives[0].index_count_object = {0x60BA, 0};
    settings.drives[0].index_number_object = {0x60D5, 0};
    settings.drives[0].pdos[1].id = 0x281;
    settings.drives[0].pdos[1].object_count = 2;
    settings.drives[0].pdos[1].objects = {mapped(0x60BA, 32), mapped(0x60D5, 16)};
    for (std::uint8_t node = 2; node <= 4; ++node) {
        DriveSettings axis = axis_drive(node);
        axis.write_mapping = true;
        axis.velocity_source = VelocitySource::velocity;
        axis.velocity_mm_s_per_unit = 0.001F;
        axis.position_mm_per_unit = 0.0001F;
        axis.pdos[0].object_count = 2;
        axis.pdos[0].objects = {mapped(object::velocity_actual, 32), mapped(object::position_actual, 32)};
        axis.pdos[1].id = 0x280U + node;
        axis.pdos[1].object_count = 2;
        axis.pdos[1].objects = {mapped(object::current_actual, 16), mapped(object::statusword, 16)};
        settings.drives[node - 1U] = axis;
    }
    settings.sync_period_us = 2000;
    settings.collect_us = 1800;
    return settings;
}

hal::DriveSample machine_at(int k) {
    hal::DriveSample sample;
    sample.time_us = static_cast<std::uint32_t>(2000 * k);
    sample.present = hal::all_present;
    sample.spindle_count = static_cast<std::uint32_t>(1365 * k);
    sample.spindle_index_number = static_cast<std::uint8_t>(sample.spindle_count / 8192);
    sample.spindle_index_count = 8192U * (sample.spindle_count / 8192U);
    sample.spindle_current_A = 5.0F + 3.0F * std::sin(0.1F * static_cast<float>(k));
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        const float phase = 0.01F * static_cast<float>(k) + static_cast<float>(axis);
        sample.axis_current_A[axis] = 4.0F * std::cos(phase);
        sample.axis_velocity_mm_s[axis] = 40.0F * std::sin(phase);
    }
    return sample;
}

}  // namespace

TEST_GROUP(RoundTrip){};

TEST(RoundTrip, what_a_machine_s_sensors_tell_comes_over_the_bus_to_half_a_unit) {
    sim::MachineOnBus machine{sim::MachineOnBusSettings{}};
    BusBench bench(whole_machine());
    const int place = bench.wire.attach([&](const hal::CanFrame& f, std::uint64_t t) { machine.on_frame(f, t); });
    const auto run_period = [&] {
        for (int k = 0; k < 100; ++k) {
            machine.poll(bench.now_us);
            for (const hal::CanFrame& sent : machine.take_frames()) {
                bench.wire.send(place, sent, bench.now_us);
            }
            bench.run_us(20);
        }
    };
    for (int k = 0; k < 100; ++k) {
        run_period();
    }
    bench.samples.clear();
    for (int k = 0; k < 500; ++k) {
        const hal::DriveSample truth = machine_at(k);
        machine.set(truth);
        run_period();
        const hal::DriveSample& got = bench.samples.back();
        UNSIGNED_LONGS_EQUAL(hal::all_present, got.present);
        UNSIGNED_LONGS_EQUAL(truth.spindle_count, got.spindle_count);
        UNSIGNED_LONGS_EQUAL(truth.spindle_index_number, got.spindle_index_number);
        if (truth.spindle_index_number > 0) {
            UNSIGNED_LONGS_EQUAL(truth.spindle_index_count, got.spindle_index_count);
        }
        DOUBLES_EQUAL(truth.spindle_current_A, got.spindle_current_A, 0.006 + 1e-5);
        for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
            DOUBLES_EQUAL(truth.axis_current_A[axis], got.axis_current_A[axis], 0.006 + 1e-5);
            DOUBLES_EQUAL(truth.axis_velocity_mm_s[axis], got.axis_velocity_mm_s[axis], 0.0005 + 1e-5);
        }
    }
    UNSIGNED_LONGS_EQUAL(500, bench.samples.size());
    UNSIGNED_LONGS_EQUAL(0, bench.bus.rejects().total());
}
