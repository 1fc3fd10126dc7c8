// SPDX-License-Identifier: Apache-2.0
#include "iio/counter_input.hpp"
#include "fake_iio.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::iio;
using namespace millforce::iio::test;

TEST_GROUP(CounterInput) {
    FakeTree tree{};
    std::uint64_t now_us = 1'000'000;

    CounterSettings settings() const {
        CounterSettings settings;
        settings.count_file = tree.path("count");
        settings.modulus = 8192;
        settings.largest_step = 2000;
        settings.mm_per_count = 0.001F;
        return settings;
    }
    bool read(CounterInput & counter, const std::string& text) {
        tree.write("count", text + "\n");
        return counter.read(now_us += 1000);
    }
};

TEST(CounterInput, follows_the_count_over_its_modulus_in_both_directions) {
    CounterInput counter(settings());
    CHECK(read(counter, "8000"));
    CHECK_FALSE(counter.has_velocity());
    CHECK(read(counter, "100"));
    LONGS_EQUAL(292, counter.count());
    DOUBLES_EQUAL(292.0, counter.velocity_mm_s(), 1e-3);
    CHECK(read(counter, "8100"));
    LONGS_EQUAL(100, counter.count());
    DOUBLES_EQUAL(-192.0, counter.velocity_mm_s(), 1e-3);
}

TEST(CounterInput, follows_32_bits_over_their_wrap) {
    CounterSettings wide = settings();
    wide.modulus = 0;
    wide.reversed = true;
    CounterInput counter(wide);
    CHECK(read(counter, "4294967290"));
    CHECK(read(counter, "10"));
    LONGS_EQUAL(-16, static_cast<std::int32_t>(counter.count()));
}

TEST(CounterInput, a_step_that_no_encoder_makes_is_not_used_and_followed_from) {
    CounterInput counter(settings());
    CHECK(read(counter, "100"));
    CHECK_FALSE(read(counter, "4000"));
    LONGS_EQUAL(1, counter.health().steps_too_large);
    CHECK(read(counter, "4010"));
    LONGS_EQUAL(10, counter.count());
}

TEST(CounterInput, a_file_that_is_missing_or_hostile_is_named_and_read_again) {
    CounterInput counter(settings());
    CHECK_FALSE(counter.read(now_us));
    CHECK(counter.health().fault.error == IioError::file_missing);
    STRCMP_EQUAL(tree.name("count").c_str(), counter.health().fault.file.c_str());
    for (const char* hostile : {"", "abc", "12x", "-1", "8192", "99999999999999999999999"}) {
        CHECK_FALSE_TEXT(read(counter, hostile), hostile);
        CHECK(counter.health().fault.error == IioError::not_a_number);
    }
    CHECK(read(counter, "17"));
    CHECK_FALSE(counter.has_velocity());
    CHECK(read(counter, "18"));
    CHECK(counter.has_velocity());
}

TEST_GROUP(SampleJoin){};

TEST(SampleJoin, has_an_axis_where_current_and_velocity_are_there) {
    CurrentReading currents;
    currents.time_us = 0x1'0000'0010;
    currents.has = {true, true, true, false};
    currents.current_A = {5.0F, 1.0F, 2.0F, 3.0F};
    MotionReading motion;
    motion.has_count = true;
    motion.spindle_count = 777;
    motion.has_velocity = {true, false, true};
    motion.velocity_mm_s = {10.0F, 20.0F, 30.0F};
    const hal::DriveSample sample = join(currents, motion);
    UNSIGNED_LONGS_EQUAL(hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::spindle_current) |
                             hal::mask(hal::Present::x_axis),
                         sample.present);
    UNSIGNED_LONGS_EQUAL(0x10, sample.time_us);
    UNSIGNED_LONGS_EQUAL(777, sample.spindle_count);
    DOUBLES_EQUAL(5.0, sample.spindle_current_A, 0.0);
    DOUBLES_EQUAL(1.0, sample.axis_current_A[0], 0.0);
    DOUBLES_EQUAL(10.0, sample.axis_velocity_mm_s[0], 0.0);
}

TEST(SampleJoin, of_files_alone_is_a_whole_sample) {
    FakeAdc device;
    AdcSettings settings = device.settings();
    settings.mode = AdcMode::polled;
    device.write("device/in_voltage0_raw", "2548\n");
    device.write("device/in_voltage3_raw", "250\n");
    AdcCurrents adc(settings);
    CounterInput spindle({device.path("spindle_count"), 0, 1000});
    CounterInput x({device.path("x_count"), 0, 1000, false, 0.01F});
    hal::DriveSample sample;
    for (int k = 0; k < 3; ++k) {
        const std::uint64_t now_us = 1'000'000 + 1000 * static_cast<unsigned>(k);
        device.write("spindle_count", std::to_string(100 * k));
        device.write("x_count", std::to_string(2 * k));
        adc.poll(now_us);
        CurrentReading currents;
        MotionReading motion;
        CHECK(adc.take(currents));
        read_spindle(spindle, now_us, motion);
        read_axis(x, now_us, 0, motion);
        sample = join(currents, motion);
    }
    UNSIGNED_LONGS_EQUAL(200, sample.spindle_count);
    DOUBLES_EQUAL(20.0, sample.axis_velocity_mm_s[0], 1e-4);
    DOUBLES_EQUAL(0.5, sample.axis_current_A[0], 1e-5);
    UNSIGNED_LONGS_EQUAL(7, sample.present);
}
