// SPDX-License-Identifier: Apache-2.0
#include "bus_bench.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <random>

#include "hal/finite.hpp"

using namespace millforce;
using namespace millforce::cia402;
using namespace millforce::cia402::bench;

namespace {

hal::CanFrame any_frame(std::mt19937& random) {
    hal::CanFrame f;
    f.id = static_cast<std::uint32_t>(random() % 4 == 0 ? random() : random() & 0x7FFU);
    f.extended = random() % 16 == 0;
    f.remote = random() % 16 == 0;
    f.length = static_cast<std::uint8_t>(random() % 8 == 0 ? random() % 256 : random() % 9);
    for (std::uint8_t& byte : f.data) {
        byte = static_cast<std::uint8_t>(random());
    }
    return f;
}

/// Frames that belong to a drive, with content that may not.
hal::CanFrame nearly_right(std::mt19937& random) {
    static constexpr std::array<std::uint32_t, 10> ids{0x080, 0x081, 0x082, 0x181, 0x182,
                                                       0x581, 0x582, 0x701, 0x702, 0x000};
    hal::CanFrame f = any_frame(random);
    f.id = ids[random() % ids.size()];
    f.extended = f.remote = false;
    f.length = static_cast<std::uint8_t>(random() % 3 == 0 ? random() % 9 : (f.id >= 0x700 ? 1 : 8));
    if (f.id >= 0x700) {
        f.data[0] = static_cast<std::uint8_t>(random() % 2 == 0 ? 5 : random());
    }
    return f;
}

}  // namespace

TEST_GROUP(HostileFrames){};

TEST(HostileFrames, every_id_and_every_length_is_used_or_counted) {
    DriveBus bus(two_drives());
    std::uint64_t now_us = 0;
    bus.poll(now_us);
    for (std::uint32_t id = 0; id <= 0x7FF; ++id) {
        for (unsigned length = 0; length <= 255; length += length < 9 ? 1 : 41) {
            hal::CanFrame f;
            f.id = id;
            f.length = static_cast<std::uint8_t>(length);
            bus.on_frame(f, now_us);
            bus.poll(now_us += 10);
        }
    }
    CHECK(bus.rejects()[Reject::frame_length] > 0x7FF);
    CHECK(bus.rejects()[Reject::foreign_id] > 0x700 * 8);
    CHECK(bus.rejects()[Reject::sdo_malformed] + bus.rejects()[Reject::sdo_unexpected] > 0);
}

TEST(HostileFrames, fuzz_never_gives_a_value_that_is_not_finite_or_beyond_its_limit) {
    std::mt19937 random(20240711);
    DriveBus bus(two_drives());
    OwnSync sync(two_drives());
    std::uint64_t now_us = 0;
    hal::DriveSample sample;
    int samples = 0;
    for (int k = 0; k < 1'000'000; ++k) {
        bus.on_frame(random() % 4 == 0 ? any_frame(random) : nearly_right(random), now_us);
        now_us += random() % 100;
        bus.poll(now_us);
        hal::CanFrame sent;
        sync.poll(bus, now_us, sent);
        while (bus.take_frame(sent)) {
            CHECK(sent.length <= 8 && sent.id <= 0x7FF);
        }
        while (bus.take_sample(sample)) {
            ++samples;
            CHECK(hal::is_finite(sample.spindle_current_A) && hal::is_finite(sample.axis_current_A[0]));
            CHECK(hal::is_finite(sample.axis_velocity_mm_s[0]));
            CHECK(sample.axis_velocity_mm_s[0] <= 2000.0F && sample.axis_velocity_mm_s[0] >= -2000.0F);
        }
    }
    CHECK(samples > 10'000);
}

TEST(HostileFrames, a_running_bus_keeps_its_drives_while_strangers_shout) {
    std::mt19937 random(7);
    TwoDrives machine;
    machine.run_ms(50);
    for (int k = 0; k < 500; ++k) {
        hal::CanFrame f = any_frame(random);
        const bool is_of_a_drive = f.id % 128 <= 2 && !f.extended;  // a stranger with a drive's own ids cannot be told
        f.length = static_cast<std::uint8_t>(f.length % 9);
        if (!is_of_a_drive) {
            machine.inject(f);
        }
        machine.run_ms(1);
    }
    CHECK(machine.both_operational());
    CHECK(has(machine.samples.back(), hal::Present::spindle_count));
}

TEST(HostileFrames, times_that_run_backwards_or_leap_do_no_harm) {
    std::mt19937_64 random(11);
    DriveBus bus(two_drives());
    OwnSync sync(two_drives());
    for (int k = 0; k < 100'000; ++k) {
        const std::uint64_t time_us = random() >> (random() % 64U);
        bus.poll(time_us);
        std::mt19937 content(static_cast<unsigned>(random()));
        bus.on_frame(nearly_right(content), time_us);
        hal::CanFrame sent;
        sync.poll(bus, time_us, sent);
        int frames = 0;
        while (bus.take_frame(sent)) {
            ++frames;
        }
        CHECK(frames < 10);
    }
}
