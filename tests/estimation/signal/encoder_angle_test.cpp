// SPDX-License-Identifier: Apache-2.0
#include "estimation/signal/encoder_angle.hpp"

#include <CppUTest/TestHarness.h>

using millforce::estimation::EncoderAngle;
using millforce::estimation::EncoderEvent;

TEST_GROUP(EncoderAngle){};

TEST(EncoderAngle, counts_forward_from_the_first_reading_when_no_index_is_wired) {
    EncoderAngle<float> encoder(1000);
    encoder.update(700, 0, 0);
    const auto reading = encoder.update(950, 0, 0);
    CHECK(reading.event == EncoderEvent::forward);
    DOUBLES_EQUAL(0.25, static_cast<double>(reading.turned_rev), 1e-6);
    DOUBLES_EQUAL(0.25, static_cast<double>(reading.angle_rev), 1e-6);
}

TEST(EncoderAngle, takes_its_zero_from_the_index) {
    EncoderAngle<float> encoder(1000);
    encoder.update(0, 0, 0);
    encoder.update(300, 120, 1);
    const auto reading = encoder.update(620, 120, 1);
    DOUBLES_EQUAL(0.5, static_cast<double>(reading.angle_rev), 1e-6);
}

TEST(EncoderAngle, says_that_the_first_index_moves_the_angle) {
    EncoderAngle<float> encoder(1000);
    encoder.update(0, 0, 0);
    CHECK(encoder.update(300, 120, 1).event == EncoderEvent::index_found);
    CHECK(encoder.update(620, 120, 1).event == EncoderEvent::forward);
}

TEST(EncoderAngle, says_when_counts_were_lost_between_two_index_pulses) {
    EncoderAngle<float> encoder(1000);
    encoder.update(0, 0, 0);
    encoder.update(100, 50, 1);
    for (std::uint32_t count = 200; count < 1050; count += 100) {
        CHECK(encoder.update(count, 50, 1).event == EncoderEvent::forward);
    }
    CHECK(encoder.update(1100, 1030, 2).event == EncoderEvent::index_slipped);
    DOUBLES_EQUAL(0.12, static_cast<double>(encoder.update(1150, 1030, 2).angle_rev), 1e-6);
}

TEST(EncoderAngle, accepts_an_index_one_count_beside_where_it_was) {
    EncoderAngle<float> encoder(1000);
    encoder.update(0, 0, 0);
    encoder.update(100, 50, 1);
    for (std::uint32_t count = 200; count < 1050; count += 100) {
        encoder.update(count, 50, 1);
    }
    CHECK(encoder.update(1100, 1051, 2).event == EncoderEvent::forward);
}

TEST(EncoderAngle, tells_reversal_from_jitter_of_one_count) {
    EncoderAngle<float> encoder(1000);
    encoder.update(500, 0, 0);
    CHECK(encoder.update(499, 0, 0).event == EncoderEvent::standstill);
    CHECK(encoder.update(480, 0, 0).event == EncoderEvent::reversed);
}

TEST(EncoderAngle, does_not_guess_a_direction_beyond_nearly_half_a_revolution) {
    EncoderAngle<float> encoder(1000);
    encoder.update(0, 0, 0);
    CHECK(encoder.update(451, 0, 0).event == EncoderEvent::too_fast);
    CHECK(encoder.update(551, 0, 0).event == EncoderEvent::forward);
}

TEST(EncoderAngle, survives_the_wrap_of_the_counter_and_hours_without_an_index) {
    EncoderAngle<float> encoder(1000);
    std::uint32_t count = 0xFFFFFF00U;
    encoder.update(count, 0, 0);
    std::uint64_t turned = 0;
    for (int k = 0; k < 12'000'000; ++k) {  // 4.8e9 counts: the 32-bit counter wraps once
        count += 400;
        turned += 400;
        const auto reading = encoder.update(count, 0, 0);
        CHECK(reading.event == EncoderEvent::forward);
        if (k % 1'000'000 == 0) {
            DOUBLES_EQUAL(static_cast<double>(turned % 1000) / 1000.0, static_cast<double>(reading.angle_rev), 1e-6);
        }
    }
}
