// SPDX-License-Identifier: Apache-2.0
#include "daemon/local_drives.hpp"

#include "bus_settings.hpp"
#include "cia402/drive_bus.hpp"
#include "daemon/local_outputs.hpp"
#include "drivers/iio/fake_iio.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;

namespace {

/// Spindle: current and count by this computer; x: current by this computer, velocity by its drive.
class Bench {
  public:
    Bench() {
        tree.write("adc/in_voltage0_raw", "1500\n");
        tree.write("adc/in_voltage3_raw", "-200\n");
        tree.write("adc/in_voltage_scale", "2.0\n");  // mV
        tree.write("count", "4000\n");
        bus.local.device = tree.name("adc");
        bus.local.mode = ConverterMode::polled;
        bus.local.drives[0] = {
            .current_channel = "voltage0", .count_file = tree.name("count"), .A_per_V = 10.0, .zero_V = 1.0};
        bus.local.drives[1] = {.current_channel = "voltage3", .count_file = "", .A_per_V = -2.0};
        cia402::DriveSettings& x = bus.drives.drives[1];
        x.node_id = 6;
        x.gives_current = false;
        x.pdos[0].id = 0x186;
        x.pdos[0].objects[0] = {0x606C, 0, 32};
        x.pdos[0].object_count = 1;
        x.pdos[0].transmission_type = 1;
        x.velocity_mm_s_per_unit = 0.001F;
        bus.drives.beside_bus = all_of_bench;
    }

    static constexpr std::uint8_t all_of_bench =
        hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::spindle_current) | hal::axis_mask(0);
    iio::test::FakeTree tree{};
    MachineBus bus{.drives = test::a_bus()};
};

/// One SYNC; what this computer reads, and the frame of x's drive; the sample that the controller makes of them.
hal::DriveSample cycle(LocalDrives& local, cia402::DriveBus& bus, std::uint64_t time_us, bool has_x_drive = true) {
    hal::CanFrame sync;
    sync.id = 0x080;
    bus.on_frame(sync, time_us);
    local.poll(time_us);
    if (hal::DriveSample beside_bus; local.take_sample(beside_bus)) {
        bus.add(beside_bus);
    }
    if (has_x_drive) {
        hal::CanFrame velocity;
        velocity.id = 0x186;
        velocity.length = 4;
        velocity.data = {0x10, 0x27};  // 10 000 µm/s
        bus.on_frame(velocity, time_us + 100);
    }
    bus.poll(time_us + 900);
    hal::DriveSample sample;
    CHECK(bus.take_sample(sample));
    return sample;
}

}  // namespace

TEST_GROUP(LocalDrives){};

TEST(LocalDrives, give_the_controller_their_currents_and_counts_beside_what_a_drive_tells) {
    Bench bench;
    LocalDrives local(bench.bus);
    cia402::DriveBus bus(bench.bus.drives);
    bus.poll(1'000);
    (void)cycle(local, bus, 10'000);
    bench.tree.write("count", "4546\n");
    const hal::DriveSample first = cycle(local, bus, 11'000);
    bench.tree.write("count", "5092\n");
    const hal::DriveSample sample = cycle(local, bus, 12'000);
    DOUBLES_EQUAL(20.0, sample.spindle_current_A, 1e-3);  // (1500 · 2 mV − 1 V) · 10 A/V
    DOUBLES_EQUAL(0.8, sample.axis_current_A[0], 1e-3);   // −200 · 2 mV · −2 A/V
    DOUBLES_EQUAL(10.0, sample.axis_velocity_mm_s[0], 1e-4);
    UNSIGNED_LONGS_EQUAL(546, sample.spindle_count - first.spindle_count);
    UNSIGNED_LONGS_EQUAL(Bench::all_of_bench, sample.present);
    UNSIGNED_LONGS_EQUAL(Bench::all_of_bench, bus.complete());
    CHECK(local.state() == hal::SourceState::running);
    CHECK_FALSE(local.health().is_failed);
}

TEST(LocalDrives, that_cannot_be_read_are_absent_from_the_sample_and_told) {
    Bench bench;
    LocalDrives local(bench.bus);
    cia402::DriveBus bus(bench.bus.drives);
    bus.poll(1'000);
    (void)cycle(local, bus, 10'000);
    (void)cycle(local, bus, 11'000);
    bench.tree.write("adc/in_voltage0_raw", "broken\n");
    const hal::DriveSample sample = cycle(local, bus, 12'000);
    const unsigned left = hal::mask(hal::Present::spindle_count) | hal::axis_mask(0);
    UNSIGNED_LONGS_EQUAL(left, sample.present);
    bench.tree.write("adc/in_voltage3_raw", "broken\n");
    UNSIGNED_LONGS_EQUAL(0, cycle(local, bus, 40'000).present);
    CHECK(local.state() == hal::SourceState::silent);
    CHECK(local.health().is_failed);
    STRCMP_EQUAL("silent", local.health().what);
    bench.tree.write("adc/in_voltage0_raw", "1500\n");
    bench.tree.write("adc/in_voltage3_raw", "-200\n");
    UNSIGNED_LONGS_EQUAL(hal::axis_mask(0), cycle(local, bus, 41'000).present & hal::axis_mask(0));
    CHECK_FALSE(local.health().is_failed);
    bench.tree.write("count", "no number\n");
    CHECK((cycle(local, bus, 42'000).present & hal::mask(hal::Present::spindle_count)) == 0);
    CHECK(local.health().is_failed);
    STRCMP_EQUAL(bench.tree.name("count").c_str(), local.health().fault.file.c_str());
}

TEST(LocalDrives, without_their_device_say_which_file_is_missing) {
    Bench bench;
    bench.bus.local.device = bench.tree.name("none");
    LocalDrives local(bench.bus);
    local.poll(10'000);
    hal::DriveSample sample;
    CHECK_FALSE(local.take_sample(sample));
    CHECK(local.state() == hal::SourceState::waiting);
    CHECK(local.health().is_failed);
    STRCMP_EQUAL("absent", local.health().what);
    CHECK(local.health().fault.error == iio::IioError::file_missing);
}

TEST_GROUP(LocalOutputs){};

TEST(LocalOutputs, follow_the_tick_as_a_voltage_and_are_safe_without_it) {
    iio::test::FakeTree tree;
    tree.write("dac/out_voltage0_raw", "7\n");
    tree.write("dac/out_voltage0_scale", "2.5\n");
    LocalIoKeys keys;
    keys.voltage_device = tree.name("dac");
    keys.voltage_channel = "voltage0";
    LocalOutputs outputs(keys);
    outputs.poll(1'000);
    STRCMP_EQUAL("0", tree.read("dac/out_voltage0_raw").c_str());
    outputs.update({0.8F, false, 3, 0, 1}, 2'000);
    STRCMP_EQUAL("1600", tree.read("dac/out_voltage0_raw").c_str());  // 4 V at 2.5 mV
    CHECK_FALSE(outputs.health().is_failed);
    outputs.poll(30'000);
    STRCMP_EQUAL("0", tree.read("dac/out_voltage0_raw").c_str());
}

TEST(LocalOutputs, that_do_not_reach_their_device_are_told_by_name) {
    LocalIoKeys keys;
    keys.chip = "/dev/no_gpiochip";
    LocalOutputs outputs(keys);
    outputs.update({0.8F, false, 3, 0, 1}, 2'000);
    CHECK(outputs.health().is_failed);
    STRCMP_EQUAL("feed_hold_line", outputs.health().what);
    CHECK(outputs.health().error != 0);
}
