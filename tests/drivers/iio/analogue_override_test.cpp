// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "fake_iio.hpp"
#include "iio/analogue_override.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::iio;
using namespace millforce::iio::test;

TEST_GROUP(AnalogueOverride) {
    FakeTree dac{};
    std::uint64_t now_us = 1'000'000;
    std::uint32_t heartbeat = 0;

    void setup() override {
        dac.write("out_voltage0_raw", "3000\n");
        dac.write("out_voltage_scale", "2.5\n");  // 12 bits over 10.24 V
    }
    AnalogueOverrideSettings settings() const {
        AnalogueOverrideSettings settings;
        settings.device = dac.path("");
        set(settings.channel, "voltage0");
        settings.V_per_ratio = 5.0F;
        settings.highest_raw = 4095;
        settings.lowest_V = 0.5F;
        settings.highest_V = 7.5F;
        settings.safe_V = 0.25F;
        return settings;
    }
    void tick(hal::OverrideOutput & output, float ratio, bool hold = false, std::uint8_t fault = 0) {
        output.update({ratio, hold, 3, fault, ++heartbeat}, now_us += 1000);
    }
    int raw() const {
        return std::stoi(dac.read("out_voltage0_raw"));
    }
};

TEST(AnalogueOverride, is_the_ratio_in_volts_within_its_limits) {
    AnalogueOverride output(settings());
    tick(output, 1.0F);
    LONGS_EQUAL(2000, raw());
    tick(output, 0.73F);
    LONGS_EQUAL(1460, raw());
    tick(output, 0.01F);
    LONGS_EQUAL(200, raw());
    tick(output, 9.0F);
    LONGS_EQUAL(3000, raw());
    CHECK(output.health().is_ready && output.health().ticks);
}

TEST(AnalogueOverride, goes_by_the_offset_of_the_converter_and_never_beyond_its_range) {
    dac.write("out_voltage0_offset", "-2048\n");
    AnalogueOverrideSettings bipolar = settings();
    bipolar.highest_V = 100.0F;
    AnalogueOverride output(bipolar);
    tick(output, 0.4F);
    LONGS_EQUAL(800 + 2048, raw());
    tick(output, 9.0F);
    LONGS_EQUAL(4095, raw());
}

TEST(AnalogueOverride, is_the_safe_value_from_the_start_at_hold_fault_and_where_the_ratio_is_no_number) {
    AnalogueOverride output(settings());
    output.poll(now_us);
    LONGS_EQUAL(100, raw());
    const auto is_safe_after = [&](float ratio, bool hold, std::uint8_t fault) {
        tick(output, 1.0F);
        LONGS_EQUAL(2000, raw());
        tick(output, ratio, hold, fault);
        return raw() == 100;
    };
    CHECK(is_safe_after(1.0F, true, 0));
    CHECK(is_safe_after(1.0F, false, 2));
    CHECK(is_safe_after(0.0F, false, 0));
    CHECK(is_safe_after(-1.0F, false, 0));
    CHECK(is_safe_after(std::numeric_limits<float>::quiet_NaN(), false, 0));
    CHECK(is_safe_after(std::numeric_limits<float>::infinity(), false, 0));
}

TEST(AnalogueOverride, is_the_safe_value_where_ticks_stay_away_though_it_is_called) {
    AnalogueOverride output(settings());
    tick(output, 1.0F);
    const std::uint64_t last_us = now_us;
    output.poll(last_us + 20'000);
    LONGS_EQUAL(2000, raw());
    output.update({1.0F, false, 3, 0, heartbeat}, last_us + 20'001);
    LONGS_EQUAL(100, raw());
    CHECK_FALSE(output.health().ticks);
    tick(output, 1.0F);
    LONGS_EQUAL(2000, raw());
}

TEST(AnalogueOverride, leaves_the_safe_value_at_its_end) {
    {
        AnalogueOverride output(settings());
        tick(output, 1.0F);
    }
    LONGS_EQUAL(100, raw());
}

TEST(AnalogueOverride, that_cannot_be_written_says_so_and_recovers) {
    dac.remove("out_voltage_scale");
    AnalogueOverride output(settings());
    tick(output, 1.0F);
    CHECK_FALSE(output.health().is_ready);
    LONGS_EQUAL(ENOENT, output.health().last_error);
    STRCMP_EQUAL(dac.path("").file("out_voltage_scale").c_str(), output.fault().file.c_str());
    dac.write("out_voltage_scale", "none\n");
    now_us += 100'000;
    tick(output, 1.0F);
    CHECK(output.fault().error == IioError::not_a_number);
    LONGS_EQUAL(3000, raw());
    setup();
    now_us += 100'000;
    tick(output, 1.0F);
    CHECK(output.health().is_ready);
    LONGS_EQUAL(2000, raw());
    dac.remove("out_voltage0_raw");
    tick(output, 0.5F);
    CHECK_FALSE(output.health().is_ready);
    UNSIGNED_LONGS_EQUAL(3, output.health().failures);
    setup();
    tick(output, 0.5F);
    LONGS_EQUAL(1000, raw());
}
