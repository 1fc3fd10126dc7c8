// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "machine/drive_plant.hpp"
#include "machine/load_meter.hpp"

using namespace millforce::sim;

namespace {

constexpr double turn_rad = 2.0 * std::numbers::pi;

}  // namespace

TEST_GROUP(CurrentSensor){};

TEST(CurrentSensor, an_int16_in_per_mille_has_steps_of_a_thousandth_of_the_rated_current) {
    CurrentSensor sensor(CurrentChannel::per_mille_int16, 12.0, 0.0, 1);
    for (double current = -5.0; current < 5.0; current += 0.00123) {
        const double read = sensor.read(current);
        const double steps = read / 0.012;
        DOUBLES_EQUAL(std::round(steps), steps, 1e-9);
        CHECK(std::abs(read - current) <= 0.006 + 1e-12);
    }
    DOUBLES_EQUAL(32.767 * 12.0, sensor.read(1e6), 1e-9);
    DOUBLES_EQUAL(-32.768 * 12.0, sensor.read(-1e6), 1e-9);
}

TEST(CurrentSensor, a_12_bit_converter_has_4096_steps_over_two_and_a_half_times_the_rated_current) {
    CurrentSensor sensor(CurrentChannel::adc_12_bit, 12.0, 0.0, 1);
    const double step = 60.0 / 4096.0;
    for (double current = -29.9; current < 29.9; current += 0.0037) {
        const double read = sensor.read(current);
        DOUBLES_EQUAL(std::round(read / step), read / step, 1e-9);
        CHECK(std::abs(read - current) <= 0.5 * step + 1e-12);
    }
    DOUBLES_EQUAL(2047.0 * step, sensor.read(1e6), 1e-9);
    DOUBLES_EQUAL(-2048.0 * step, sensor.read(-1e6), 1e-9);
}

TEST(CurrentSensor, the_exact_channel_without_noise_is_exact) {
    CurrentSensor sensor(CurrentChannel::exact, 12.0, 0.0, 1);
    DOUBLES_EQUAL(0.123456789, sensor.read(0.123456789), 0.0);
}

TEST(CurrentSensor, noise_is_white_and_has_the_stated_deviation) {
    for (const auto channel : {CurrentChannel::exact, CurrentChannel::per_mille_int16}) {
        CurrentSensor sensor(channel, 12.0, 0.01, 42);
        constexpr int count = 200000;
        double sum = 0.0;
        double squares = 0.0;
        double products = 0.0;
        double before = 0.0;
        for (int k = 0; k < count; ++k) {
            const double noise = sensor.read(3.0) - 3.0;
            sum += noise;
            squares += noise * noise;
            products += noise * before;
            before = noise;
        }
        DOUBLES_EQUAL(0.0, sum / count, 0.12 * 0.01);  // some 4 standard errors
        DOUBLES_EQUAL(0.12, std::sqrt(squares / count), 0.001);
        DOUBLES_EQUAL(0.0, products / squares, 0.01);
    }
}

TEST(CurrentSensor, a_seed_repeats_its_noise_and_another_does_not) {
    CurrentSensor one(CurrentChannel::exact, 12.0, 0.01, 7);
    CurrentSensor same(CurrentChannel::exact, 12.0, 0.01, 7);
    CurrentSensor other(CurrentChannel::exact, 12.0, 0.01, 8);
    int alike = 0;
    for (int k = 0; k < 1000; ++k) {
        const double read = one.read(1.0);
        DOUBLES_EQUAL(read, same.read(1.0), 0.0);
        alike += read == other.read(1.0) ? 1 : 0;
    }
    CHECK(alike < 5);
}

TEST_GROUP(EncoderSensor){};

TEST(EncoderSensor, counts_whole_steps_of_the_angle) {
    EncoderSensor encoder(4096, 1.0);
    for (double turns = 0.0; turns < 3.0; turns += 0.00037) {
        encoder.update(turns * turn_rad);
        LONGS_EQUAL(static_cast<long>(std::floor(turns * turn_rad / turn_rad * 4096.0)), encoder.count());
    }
}

TEST(EncoderSensor, the_index_is_latched_once_a_revolution_at_its_place) {
    const double place_rad = 1.0;
    EncoderSensor encoder(8192, place_rad);
    encoder.update(0.0);
    LONGS_EQUAL(0, encoder.index_number());
    int latched = 0;
    double step_rad = 0.0391;  // never a divisor of a turn
    for (double angle = step_rad; angle < 50.0 * turn_rad; angle += step_rad) {
        const auto before = encoder.index_number();
        encoder.update(angle);
        if (encoder.index_number() != before) {
            const double passed = place_rad + latched * turn_rad;
            CHECK(angle >= passed && angle - step_rad < passed);
            LONGS_EQUAL(static_cast<long>(std::floor(passed / turn_rad * 8192.0)), encoder.index_count());
            ++latched;
        }
    }
    LONGS_EQUAL(50, latched);
    LONGS_EQUAL(50, encoder.index_number());
}

TEST(EncoderSensor, the_index_number_never_returns_to_the_zero_of_no_index) {
    EncoderSensor encoder(1024, 0.5);
    encoder.update(0.0);
    std::uint8_t before = 0;
    for (int k = 1; k < 600; ++k) {
        encoder.update(k * turn_rad);
        CHECK(encoder.index_number() != 0);
        CHECK(encoder.index_number() != before);
        before = encoder.index_number();
    }
}

TEST(EncoderSensor, a_reversal_counts_back_and_latches_the_index_at_the_same_place) {
    EncoderSensor encoder(8192, 1.0);
    encoder.update(0.5);
    encoder.update(1.5);
    const std::uint32_t forward = encoder.index_count();
    LONGS_EQUAL(1, encoder.index_number());
    encoder.update(0.5);
    LONGS_EQUAL(2, encoder.index_number());
    LONGS_EQUAL(forward, encoder.index_count());
    encoder.update(-0.5);
    LONGS_EQUAL(static_cast<std::uint32_t>(-652), encoder.count());  // −0.5/2π · 8192 = −651.9
    LONGS_EQUAL(2, encoder.index_number());
    encoder.update(-6.0);  // over the index one revolution before: 1 − 2π
    LONGS_EQUAL(3, encoder.index_number());
    LONGS_EQUAL(forward - 8192U, encoder.index_count());
}

TEST(EncoderSensor, the_count_wraps_at_32_bits_and_its_differences_do_not_care) {
    EncoderSensor encoder(1U << 24U, 0.0);
    encoder.update(255.9 * turn_rad);
    const std::uint32_t before = encoder.count();
    encoder.update(256.1 * turn_rad);
    CHECK(encoder.count() < before);
    DOUBLES_EQUAL(0.2 * (1U << 24U), static_cast<double>(encoder.count() - before), 2.0);
}

TEST_GROUP(LoadMeter){};

TEST(LoadMeter, shows_a_step_late_and_stepwise) {
    LoadMeter meter({.period_s = 0.1, .age_s = 0.15, .smoothing_s = 0.0, .resolution_A = 0.1});
    meter.start_at(2.0);
    double last_A = 2.0;
    double first_change_s = 0.0;
    int changes = 0;
    for (int k = 1; k <= 1000; ++k) {
        const double time_s = 0.001 * k;
        meter.advance(0.001, time_s < 0.35 ? 2.0 : 2.0 + 2.0 * (time_s - 0.35));
        if (std::abs(meter.shown_A() - last_A) > 1e-9) {
            first_change_s = changes == 0 ? time_s : first_change_s;
            last_A = meter.shown_A();
            ++changes;
        }
    }
    DOUBLES_EQUAL(0.55, first_change_s, 0.005);  // asked at 0.4 s, there 0.15 s later
    LONGS_EQUAL(5, changes);
}

TEST(LoadMeter, smooths_and_rounds) {
    LoadMeter meter({.period_s = 0.01, .age_s = 0.0, .smoothing_s = 0.1, .resolution_A = 0.1});
    meter.start_at(0.0);
    for (int k = 0; k < 100; ++k) {
        meter.advance(0.001, 10.0);
    }
    DOUBLES_EQUAL(6.2, meter.shown_A(), 0.15);  // 10 (1 - 1/e), up to 10 ms old
    DOUBLES_EQUAL(std::round(meter.shown_A() * 10.0), meter.shown_A() * 10.0, 1e-9);
}
