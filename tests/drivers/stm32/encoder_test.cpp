// SPDX-License-Identifier: Apache-2.0
#include "stm32/timers.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::stm32;

TEST_GROUP(Stm32Encoder) {
    static constexpr std::uint32_t captured = 1U << 3U;
    static constexpr std::uint32_t captured_again = 1U << 11U;
    TimerRegisters timer{};
    /// What the chip does at an index pulse.
    void index_pulse_at(std::uint32_t count) {
        timer.ccr[2] = count;
        timer.sr = timer.sr | ((timer.sr & captured) != 0 ? captured_again : captured);
    }
};

TEST(Stm32Encoder, counts_both_edges_over_the_whole_range) {
    Encoder encoder(timer, {.is_32_bit = true, .reversed = false, .has_index = true, .filter = 3});
    encoder.start();
    UNSIGNED_LONGS_EQUAL(3, timer.smcr);         // SMS
    UNSIGNED_LONGS_EQUAL(0x3131, timer.ccmr1);   // CC1S, CC2S direct; IC1F, IC2F
    UNSIGNED_LONGS_EQUAL(0x31, timer.ccmr2);     // CC3S, IC3F
    UNSIGNED_LONGS_EQUAL(1U << 8U, timer.ccer);  // CC3E
    UNSIGNED_LONGS_EQUAL(0xFFFF'FFFFU, timer.arr);
    UNSIGNED_LONGS_EQUAL(1, timer.cr1);
}

TEST(Stm32Encoder, turns_round_where_it_counts_the_wrong_way) {
    Encoder encoder(timer, {.is_32_bit = false, .reversed = true, .has_index = false, .filter = 0});
    encoder.start();
    UNSIGNED_LONGS_EQUAL(2, timer.ccer);  // CC1P
    UNSIGNED_LONGS_EQUAL(0x0101, timer.ccmr1);
    UNSIGNED_LONGS_EQUAL(0, timer.ccmr2);
    UNSIGNED_LONGS_EQUAL(0xFFFF, timer.arr);
}

TEST(Stm32Encoder, an_index_pulse_is_captured_once_and_its_flag_cleared) {
    Encoder encoder(timer, {.is_32_bit = true, .reversed = false, .has_index = true});
    encoder.start();
    timer.cnt = 1000;
    UNSIGNED_LONGS_EQUAL(0, encoder.read().index_number);
    timer.cnt = 5000;
    index_pulse_at(4800);
    const EncoderReading reading = encoder.read();
    UNSIGNED_LONGS_EQUAL(5000, reading.count);
    UNSIGNED_LONGS_EQUAL(4800, reading.index_count);
    UNSIGNED_LONGS_EQUAL(1, reading.index_number);
    UNSIGNED_LONGS_EQUAL(~(captured | captured_again), timer.sr);  // zeros clear, ones leave
    timer.sr = 0;
    UNSIGNED_LONGS_EQUAL(1, encoder.read().index_number);
    UNSIGNED_LONGS_EQUAL(0, encoder.missed_indexes());
}

TEST(Stm32Encoder, two_pulses_between_two_readings_are_one_and_told) {
    Encoder encoder(timer, {.is_32_bit = true, .reversed = false, .has_index = true});
    encoder.start();
    index_pulse_at(100);
    index_pulse_at(4196);
    UNSIGNED_LONGS_EQUAL(1, encoder.read().index_number);
    UNSIGNED_LONGS_EQUAL(1, encoder.missed_indexes());
}

TEST(Stm32Encoder, sixteen_bits_go_on_as_32_in_both_directions) {
    Encoder encoder(timer, {});
    encoder.start();
    for (const std::uint32_t count : {30'000U, 60'000U, 90'000U, 120'000U, 95'000U, 64'000U, 40'000U, 8'000U}) {
        timer.cnt = count & 0xFFFFU;
        UNSIGNED_LONGS_EQUAL(count, encoder.read().count);
    }
    timer.cnt = static_cast<std::uint32_t>(8'000 - 20'000) & 0xFFFFU;
    LONGS_EQUAL(-12'000, static_cast<std::int32_t>(encoder.read().count));
}

TEST(Stm32Encoder, sixteen_bits_with_an_index_across_the_wrap) {
    Encoder encoder(timer, {.is_32_bit = false, .reversed = false, .has_index = true});
    encoder.start();
    timer.cnt = 30'000;
    (void)encoder.read();
    timer.cnt = 60'000;
    (void)encoder.read();
    timer.cnt = 70'000U & 0xFFFFU;
    index_pulse_at(65'000);
    const EncoderReading reading = encoder.read();
    UNSIGNED_LONGS_EQUAL(70'000, reading.count);
    UNSIGNED_LONGS_EQUAL(65'000, reading.index_count);
}

TEST_GROUP(Stm32Timers) {
    TimerRegisters timer{};
};

TEST(Stm32Timers, a_clock_of_microseconds) {
    start_microsecond_clock(timer, 84'000'000);
    UNSIGNED_LONGS_EQUAL(83, timer.psc);
    UNSIGNED_LONGS_EQUAL(0xFFFF'FFFFU, timer.arr);
    UNSIGNED_LONGS_EQUAL(1, timer.egr);
    UNSIGNED_LONGS_EQUAL(1, timer.cr1);
}

TEST(Stm32Timers, a_trigger_at_8_kHz) {
    start_trigger(timer, 168'000'000, 8'000);
    UNSIGNED_LONGS_EQUAL(20'999, timer.arr);
    UNSIGNED_LONGS_EQUAL(0x20, timer.cr2);  // MMS: update
    UNSIGNED_LONGS_EQUAL(1, timer.cr1);
}
