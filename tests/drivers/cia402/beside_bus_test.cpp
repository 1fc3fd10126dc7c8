// SPDX-License-Identifier: Apache-2.0
#include "bus_settings.hpp"
#include "cia402/drive_bus.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::cia402;

namespace {

constexpr std::uint8_t of_spindle = hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::spindle_current);
constexpr std::uint8_t whole = of_spindle | hal::axis_mask(0);

/// A drive of the bus that gives the velocity of x and no current; all of the spindle comes by another source.
BusSettings velocity_of_x() {
    BusSettings settings = test::a_bus();
    settings.beside_bus = whole;
    DriveSettings& x = settings.drives[1];
    x.node_id = 2;
    x.gives_current = false;
    x.velocity_mm_s_per_unit = 0.001F;
    x.pdos[0].id = 0x182;
    x.pdos[0].transmission_type = 1;
    x.pdos[0].objects[0] = {object::velocity_actual, 0, 32};
    x.pdos[0].object_count = 1;
    return settings;
}

hal::DriveSample currents_and_count(float x_current_A) {
    hal::DriveSample sample;
    sample.present = of_spindle;
    sample.spindle_current_A = 3.0F;
    sample.spindle_count = 1234;
    sample.axis_current_A[0] = x_current_A;
    hal::set_known(sample, 0, true, false);
    return sample;
}

void sync(DriveBus& bus, std::uint64_t time_us) {
    hal::CanFrame frame;
    frame.id = 0x080;
    bus.poll(time_us);
    bus.on_frame(frame, time_us);
}

void velocity_frame(DriveBus& bus, std::uint64_t time_us) {
    hal::CanFrame frame;
    frame.id = 0x182;
    frame.length = 4;
    frame.data = {0x10, 0x27};  // 10 000 µm/s
    bus.on_frame(frame, time_us);
}

}  // namespace

TEST_GROUP(BesideBus){};

TEST(BesideBus, a_current_from_elsewhere_and_a_velocity_by_the_bus_are_one_axis_of_one_sample) {
    DriveBus bus(velocity_of_x());
    UNSIGNED_LONGS_EQUAL(whole, bus.complete());
    hal::DriveSample sample;
    sync(bus, 1'000);
    velocity_frame(bus, 1'200);  // the drive's first sign of being operational
    bus.add(currents_and_count(0.1F));
    CHECK(bus.take_sample(sample));
    sync(bus, 2'000);
    bus.add(currents_and_count(0.5F));
    CHECK_FALSE(bus.take_sample(sample));  // the drive has not answered yet
    velocity_frame(bus, 2'200);
    CHECK(bus.take_sample(sample));
    UNSIGNED_LONGS_EQUAL(whole, sample.present);
    UNSIGNED_LONGS_EQUAL(0, sample.part);
    UNSIGNED_LONGS_EQUAL(2'000, sample.time_us);
    UNSIGNED_LONGS_EQUAL(1234, sample.spindle_count);
    DOUBLES_EQUAL(3.0, sample.spindle_current_A, 0.0);
    DOUBLES_EQUAL(0.5, sample.axis_current_A[0], 0.0);
    DOUBLES_EQUAL(10.0, sample.axis_velocity_mm_s[0], 1e-5);
}

TEST(BesideBus, what_does_not_come_is_waited_for_and_missing_in_this_sample_alone) {
    DriveBus bus(velocity_of_x());
    hal::DriveSample sample;
    sync(bus, 1'000);
    velocity_frame(bus, 1'100);
    CHECK_FALSE(bus.take_sample(sample));
    bus.poll(1'800);
    CHECK(bus.take_sample(sample));
    UNSIGNED_LONGS_EQUAL(0, sample.present);
    CHECK(hal::knows_velocity(sample, 0));
    CHECK_FALSE(hal::knows_current(sample, 0));
    sync(bus, 2'000);
    velocity_frame(bus, 2'100);
    bus.add(currents_and_count(0.5F));
    CHECK(bus.take_sample(sample));
    UNSIGNED_LONGS_EQUAL(whole, sample.present);
    UNSIGNED_LONGS_EQUAL(1, bus.health().samples_incomplete);
}

TEST(BesideBus, what_comes_after_its_sample_was_handed_over_is_not_the_next_ones) {
    DriveBus bus(velocity_of_x());
    hal::DriveSample sample;
    sync(bus, 1'000);
    bus.poll(1'800);
    CHECK(bus.take_sample(sample));
    bus.add(currents_and_count(0.5F));
    sync(bus, 2'000);
    velocity_frame(bus, 2'100);
    bus.poll(2'800);
    CHECK(bus.take_sample(sample));
    UNSIGNED_LONGS_EQUAL(0, sample.present);
}

TEST(BesideBus, without_a_drive_on_the_bus_the_sample_is_all_from_elsewhere_and_waits_for_nobody) {
    BusSettings settings = test::a_bus();
    settings.beside_bus = of_spindle;
    DriveBus bus(settings);
    CHECK(bus.state() == hal::SourceState::waiting);
    hal::DriveSample sample;
    sync(bus, 1'000);
    bus.add(currents_and_count(0.5F));
    CHECK(bus.take_sample(sample));
    UNSIGNED_LONGS_EQUAL(of_spindle, sample.present & bus.complete());
    CHECK(bus.state() == hal::SourceState::running);
    bus.poll(9'000);
    CHECK(bus.state() == hal::SourceState::silent);
}

TEST(BesideBus, a_drive_without_the_current_it_is_to_give_is_refused) {
    BusSettings settings = velocity_of_x();
    CHECK(check(settings) == SettingsError::none);
    settings.drives[1].gives_current = true;
    CHECK(check(settings) == SettingsError::object_missing);
}
