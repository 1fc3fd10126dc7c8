// SPDX-License-Identifier: Apache-2.0
#include "fake_iio.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::iio;
using namespace millforce::iio::test;

namespace {

constexpr std::uint64_t start_us = 5'000'000;

void check_named(const AdcCurrents& adc, AdcState state, IioError error, const std::string& file) {
    CHECK_TRUE_TEXT(adc.health().state == state, file.c_str());
    STRCMP_EQUAL(std::string(name_of(error)).c_str(), std::string(name_of(adc.health().fault.error)).c_str());
    STRCMP_EQUAL(file.c_str(), adc.health().fault.file.c_str());
}

}  // namespace

TEST_GROUP(AdcBuffered) {
    FakeAdc device{};
    CurrentReading reading{};
};

TEST(AdcBuffered, switches_its_channels_and_the_timestamp_on_all_others_off_and_starts_the_buffer) {
    device.element("voltage1", 1, "le:u12/16>>0", "1");
    {
        AdcCurrents adc(device.settings());
        adc.poll(start_us);
        CHECK(adc.health().state == AdcState::silent);
        STRCMP_EQUAL("1", device.read("device/scan_elements/in_voltage0_en").c_str());
        STRCMP_EQUAL("0", device.read("device/scan_elements/in_voltage1_en").c_str());
        STRCMP_EQUAL("1", device.read("device/scan_elements/in_voltage3_en").c_str());
        STRCMP_EQUAL("1", device.read("device/scan_elements/in_timestamp_en").c_str());
        STRCMP_EQUAL("1024", device.read("device/buffer/length").c_str());
        STRCMP_EQUAL("1", device.read("device/buffer/enable").c_str());
    }
    STRCMP_EQUAL("0", device.read("device/buffer/enable").c_str());
}

TEST(AdcBuffered, gives_amperes_by_scale_offset_zero_and_sign) {
    AdcCurrents adc(device.settings());
    adc.poll(start_us);
    CHECK_FALSE(adc.take(reading));
    device.put(FakeAdc::scan(2048 + 500, -750, 0));
    adc.poll(start_us + 1000);
    CHECK(adc.take(reading));
    DOUBLES_EQUAL(500 * 0.000805664062 * 10.0, reading.current_A[0], 1e-5);
    DOUBLES_EQUAL((-0.75 - 0.5) * -2.0, reading.current_A[1], 1e-5);
    CHECK(reading.has[0] && reading.has[1] && !reading.has[2] && !reading.has[3]);
    CHECK(adc.health().state == AdcState::running);
    CHECK_FALSE(adc.take(reading));
}

TEST(AdcBuffered, gives_the_mean_over_what_came_since_the_last_time) {
    AdcCurrents adc(device.settings());
    adc.poll(start_us);
    for (const unsigned raw : {2148U, 2248U, 2348U, 2448U}) {
        device.put(FakeAdc::scan(raw, 0, 0));
    }
    adc.poll(start_us + 1000);
    CHECK(adc.take(reading));
    DOUBLES_EQUAL(250 * 0.000805664062 * 10.0, reading.current_A[0], 1e-5);
    UNSIGNED_LONGS_EQUAL(4, adc.health().scans);
}

TEST(AdcBuffered, joins_a_scan_that_comes_in_two_parts) {
    AdcCurrents adc(device.settings());
    adc.poll(start_us);
    const auto scan = FakeAdc::scan(3048, 100, 0);
    device.put({scan.begin(), scan.begin() + 5});
    adc.poll(start_us + 1000);
    CHECK_FALSE(adc.take(reading));
    device.put({scan.begin() + 5, scan.end()});
    adc.poll(start_us + 2000);
    CHECK(adc.take(reading));
    DOUBLES_EQUAL(1000 * 0.000805664062 * 10.0, reading.current_A[0], 1e-5);
}

TEST(AdcBuffered, takes_the_time_of_the_device_where_it_can_be_true) {
    AdcCurrents adc(device.settings());
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    const std::int64_t now_ns = now.tv_sec * 1'000'000'000LL + now.tv_nsec;
    adc.poll(start_us);
    device.put(FakeAdc::scan(2100, 0, now_ns - 300'000'000));
    adc.poll(start_us);
    CHECK(adc.take(reading));
    CHECK(reading.time_us <= start_us - 300'000 && reading.time_us > start_us - 1'000'000);
    for (const std::int64_t absurd_ns : {std::int64_t{0}, INT64_MIN, INT64_MAX, now_ns / 2}) {
        device.put(FakeAdc::scan(2100, 0, absurd_ns));
        adc.poll(start_us);
        CHECK(adc.take(reading));
        UNSIGNED_LONGS_EQUAL(start_us, reading.time_us);
    }
}

TEST(AdcBuffered, counts_the_scans_that_are_missing_between_two_times) {
    AdcCurrents adc(device.settings());
    adc.poll(start_us);
    for (const int k : {10, 11, 12, 15, 16, 26}) {  // 13, 14 and nine more are missing
        device.put(FakeAdc::scan(2100, 0, k * 100'000LL + k * 900));
    }
    adc.poll(start_us);
    UNSIGNED_LONGS_EQUAL(11, adc.health().overruns);
}

TEST(AdcBuffered, does_not_use_values_at_the_rail_or_beyond_the_largest_current) {
    AdcCurrents adc(device.settings());
    adc.poll(start_us);
    device.put(FakeAdc::scan(4095, 2046, 0));  // 2.046 V: -3.1 A; the spindle's converter at its end
    device.put(FakeAdc::scan(0, -2000, 0));    // -2 V: 5 A
    adc.poll(start_us);
    CHECK(adc.take(reading));
    CHECK_FALSE(reading.has[0]);
    CHECK(reading.has[1]);
    DOUBLES_EQUAL(-3.092, reading.current_A[1], 1e-4);
    UNSIGNED_LONGS_EQUAL(2, adc.rejected(AdcReject::at_rail));
    UNSIGNED_LONGS_EQUAL(1, adc.rejected(AdcReject::current_range));
}

TEST(AdcBuffered, that_says_nothing_is_silent_and_runs_again) {
    AdcCurrents adc(device.settings());
    adc.poll(start_us);
    device.put(FakeAdc::scan(2100, 0, 0));
    adc.poll(start_us);
    adc.poll(start_us + 20'000);
    CHECK(adc.health().state == AdcState::running);
    adc.poll(start_us + 20'001);
    CHECK(adc.health().state == AdcState::silent);
    device.put(FakeAdc::scan(2100, 0, 0));
    adc.poll(start_us + 30'000);
    CHECK(adc.health().state == AdcState::running);
}

TEST(AdcBuffered, a_device_that_is_not_there_yet_is_waited_for) {
    std::filesystem::rename(device.name("device"), device.name("away"));
    AdcCurrents adc(device.settings());
    adc.poll(start_us);
    check_named(adc, AdcState::absent, IioError::file_missing, device.name("device/in_voltage_scale"));
    std::filesystem::rename(device.name("away"), device.name("device"));
    adc.poll(start_us + 1000);
    CHECK(adc.health().state == AdcState::absent);
    adc.poll(start_us + 100'000);
    CHECK(adc.health().state == AdcState::silent);
}

TEST(AdcBuffered, each_file_that_is_missing_or_hostile_is_a_named_error) {
    struct Case {
        const char* file;
        const char* text;  // nullptr: removed
        AdcState state;
        IioError error;
    };
    const std::string long_text(200, '1');
    for (const Case& wrong : std::initializer_list<Case>{
             {"scan_elements/in_voltage0_type", "le:s99/16>>4", AdcState::refused, IioError::scan_format},
             {"scan_elements/in_voltage0_type", "", AdcState::refused, IioError::scan_format},
             {"scan_elements/in_voltage0_type", nullptr, AdcState::absent, IioError::file_missing},
             {"scan_elements/in_voltage0_index", "zero", AdcState::refused, IioError::not_a_number},
             {"scan_elements/in_voltage0_index", "-1", AdcState::refused, IioError::scan_layout},
             {"scan_elements/in_voltage0_index", "99999999999999999999", AdcState::refused, IioError::not_a_number},
             {"scan_elements/in_voltage0_index", long_text.c_str(), AdcState::refused, IioError::not_a_number},
             {"in_voltage3_scale", "nan", AdcState::refused, IioError::not_a_number},
             {"in_voltage3_scale", "0", AdcState::refused, IioError::not_a_number},
             {"in_voltage3_scale", "1.0 V", AdcState::refused, IioError::not_a_number},
             {"in_voltage0_offset", "1e99", AdcState::refused, IioError::not_a_number},
             {"current_timestamp_clock", "sundial", AdcState::refused, IioError::clock},
             {"scan_elements/in_voltage3_en", nullptr, AdcState::absent, IioError::file_missing},
             {"buffer", nullptr, AdcState::absent, IioError::file_missing}}) {
        FakeAdc other;
        const std::string file = std::string("device/") + wrong.file;
        if (wrong.text == nullptr) {
            other.remove(file);
        } else {
            other.write(file, wrong.text);
        }
        AdcCurrents adc(other.settings());
        adc.poll(start_us);
        const bool is_buffer = std::string(wrong.file) == "buffer";
        check_named(adc, wrong.state, wrong.error, other.name(is_buffer ? "device/buffer/enable" : file));
    }
}

TEST(AdcBuffered, elements_that_contradict_each_other_are_refused) {
    device.element("voltage3", 0, "be:s12/16>>4");
    AdcCurrents adc(device.settings());
    adc.poll(start_us);
    check_named(adc, AdcState::refused, IioError::scan_layout, device.name("device/scan_elements"));
    for (int k = 0; k < 20; ++k) {
        device.element("current" + std::to_string(k), 10 + k, "le:u16/16>>0", "1");
    }
    AdcSettings as_it_is = device.settings();
    as_it_is.configures = false;
    AdcCurrents crowded(as_it_is);
    crowded.poll(start_us);
    check_named(crowded, AdcState::refused, IioError::scan_layout, device.name("device/scan_elements"));
}

TEST(AdcBuffered, that_it_may_not_configure_is_read_as_somebody_set_it) {
    AdcSettings settings = device.settings();
    settings.configures = false;
    device.element("voltage0", 0, "le:u12/16>>0", "1");
    AdcCurrents one_off(settings);
    one_off.poll(start_us);
    check_named(one_off, AdcState::refused, IioError::channel_disabled,
                device.name("device/scan_elements/in_voltage3_en"));
    device.element("voltage1", 1, "le:u12/16>>0", "1");
    device.element("voltage3", 3, "be:s12/16>>4", "1");
    AdcCurrents adc(settings);
    adc.poll(start_us);
    device.put({0xF4, 0x09, 0xAA, 0xAA, 0x0F, 0xA0});  // 2548, a stranger's, 250; no time: six bytes a scan
    adc.poll(start_us + 1000);
    CHECK(adc.take(reading));
    DOUBLES_EQUAL(500 * 0.000805664062 * 10.0, reading.current_A[0], 1e-5);
    DOUBLES_EQUAL((0.25 - 0.5) * -2.0, reading.current_A[1], 1e-5);
    UNSIGNED_LONGS_EQUAL(start_us + 1000, reading.time_us);
    STRCMP_EQUAL("0", device.read("device/buffer/enable").c_str());
}

TEST(AdcBuffered, settings_without_a_channel_or_with_a_factor_of_none_are_refused) {
    AdcCurrents nothing{AdcSettings{}};
    nothing.poll(start_us);
    CHECK(nothing.health().fault.error == IioError::settings);
    AdcSettings settings = device.settings();
    settings.channels[0].A_per_V = 0.0F;
    AdcCurrents zero(settings);
    zero.poll(start_us);
    CHECK(zero.health().fault.error == IioError::settings);
    settings = device.settings();
    settings.device = Path(std::string(200, 'x'));
    AdcCurrents too_long(settings);
    too_long.poll(start_us);
    CHECK(too_long.health().fault.error == IioError::path_too_long);
}

TEST_GROUP(AdcPolled) {
    FakeAdc device{};
    CurrentReading reading{};

    AdcSettings settings() const {
        AdcSettings settings = device.settings();
        settings.mode = AdcMode::polled;
        device.write("device/in_voltage0_raw", "2548\n");
        device.write("device/in_voltage3_raw", "250\n");
        return settings;
    }
};

TEST(AdcPolled, reads_a_value_at_each_poll_and_needs_no_buffer) {
    const AdcSettings polled = settings();
    device.remove("device/scan_elements");
    AdcCurrents adc(polled);
    adc.poll(start_us);
    CHECK(adc.take(reading));
    DOUBLES_EQUAL(500 * 0.000805664062 * 10.0, reading.current_A[0], 1e-5);
    UNSIGNED_LONGS_EQUAL(start_us, reading.time_us);
    device.write("device/in_voltage0_raw", "1048\n");
    adc.poll(start_us + 1000);
    CHECK(adc.take(reading));
    DOUBLES_EQUAL(-1000 * 0.000805664062 * 10.0, reading.current_A[0], 1e-5);
}

TEST(AdcPolled, a_value_that_is_no_number_is_absent_and_the_other_stays) {
    AdcCurrents adc(settings());
    device.write("device/in_voltage0_raw", "2548 and more\n");
    adc.poll(start_us);
    CHECK(adc.take(reading));
    CHECK(!reading.has[0] && reading.has[1]);
    UNSIGNED_LONGS_EQUAL(1, adc.rejected(AdcReject::unreadable));
    device.write("device/in_voltage3_raw", "");
    adc.poll(start_us + 1000);
    CHECK_FALSE(adc.take(reading));
    adc.poll(start_us + 30'000);
    CHECK(adc.health().state == AdcState::silent);
}

TEST(AdcPolled, a_channel_that_the_device_has_not_is_named) {
    const AdcSettings polled = settings();
    device.remove("device/in_voltage3_raw");
    AdcCurrents adc(polled);
    adc.poll(start_us);
    check_named(adc, AdcState::absent, IioError::file_missing, device.name("device/in_voltage3_raw"));
}
