// SPDX-License-Identifier: Apache-2.0
#include "stm32/can_controller.hpp"

#include "drivers/stm32/fake_can.hpp"

#include <array>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::stm32;

TEST_GROUP(Stm32Can) {
    static constexpr std::uint32_t patience = 100;
    FakeCan chip;
    CanController can{chip.registers};

    void start_on_bus(std::span<const hal::CanFilter> filters = {}) {
        can.start(CanBitRate::kbit_500, filters);
        chip.join_bus(can);
        LONGS_EQUAL(CanState::running, can.state());
    }
    void set_errors(std::uint32_t esr) {
        chip.registers.esr = esr;
        can.poll(patience);
    }
};

TEST(Stm32Can, asks_for_setup_and_waits_until_it_is_acknowledged) {
    can.start(CanBitRate::kbit_500, {});
    UNSIGNED_LONGS_EQUAL(1, chip.registers.mcr);  // INRQ, and no SLEEP
    can.poll(patience);
    LONGS_EQUAL(CanState::entering_setup, can.state());
    UNSIGNED_LONGS_EQUAL(0, chip.registers.btr);
    chip.react();
    can.poll(patience);
    LONGS_EQUAL(CanState::joining, can.state());
    UNSIGNED_LONGS_EQUAL(0x44, chip.registers.mcr);  // ABOM, TXFP; no INRQ
    can.poll(patience);
    LONGS_EQUAL(CanState::joining, can.state());
    chip.react();
    can.poll(patience);
    LONGS_EQUAL(CanState::running, can.state());
}

TEST(Stm32Can, bit_rates_of_14_quanta) {
    struct Case {
        CanBitRate rate;
        std::uint32_t bits_per_s;
    };
    for (const Case& c : {Case{CanBitRate::kbit_125, 125'000}, Case{CanBitRate::kbit_250, 250'000},
                          Case{CanBitRate::kbit_500, 500'000}, Case{CanBitRate::kbit_1000, 1'000'000}}) {
        can.start(c.rate, {});
        chip.react();
        can.poll(patience);
        const std::uint32_t btr = chip.registers.btr;
        const std::uint32_t quanta = 1 + (btr >> 16U & 0xFU) + 1 + (btr >> 20U & 7U) + 1;
        UNSIGNED_LONGS_EQUAL(14, quanta);
        UNSIGNED_LONGS_EQUAL(c.bits_per_s, 42'000'000 / ((btr & 0x3FFU) + 1) / quanta);
        UNSIGNED_LONGS_EQUAL(0, btr >> 30U);  // neither silent nor looped back
    }
}

TEST(Stm32Can, a_controller_that_never_answers_is_absent_and_nothing_is_sent) {
    can.start(CanBitRate::kbit_500, {});
    for (std::uint32_t k = 0; k < patience; ++k) {
        LONGS_EQUAL(CanState::entering_setup, can.state());
        can.poll(patience);
    }
    LONGS_EQUAL(CanState::absent, can.state());
    CHECK_FALSE(can.send({}));
    hal::CanFrame frame;
    chip.arrive(0, 0, 0, 0);
    CHECK_FALSE(can.receive(frame));
    STRCMP_EQUAL("absent", name(can.state()));
}

TEST(Stm32Can, a_bus_that_is_stuck_keeps_it_joining_not_absent) {
    can.start(CanBitRate::kbit_500, {});
    chip.react();
    for (std::uint32_t k = 0; k < 3 * patience; ++k) {
        can.poll(patience);
    }
    LONGS_EQUAL(CanState::joining, can.state());
}

TEST(Stm32Can, without_filters_every_frame_passes) {
    start_on_bus();
    UNSIGNED_LONGS_EQUAL(1, chip.registers.fa1r);
    UNSIGNED_LONGS_EQUAL(1, chip.registers.fs1r);
    UNSIGNED_LONGS_EQUAL(0, chip.registers.fm1r);
    UNSIGNED_LONGS_EQUAL(0, chip.registers.filter[0].r2);  // a mask without a bit
    UNSIGNED_LONGS_EQUAL(0, chip.registers.fmr & 1U);
}

TEST(Stm32Can, two_filters_share_a_bank) {
    const std::array<hal::CanFilter, 3> filters{{{0x080, 0x7FF}, {0x181, 0x7FF}, {0x700, 0x780}}};
    start_on_bus(filters);
    UNSIGNED_LONGS_EQUAL(3, chip.registers.fa1r);
    UNSIGNED_LONGS_EQUAL(0, chip.registers.fs1r);  // 16 bits
    UNSIGNED_LONGS_EQUAL(0xFFE8'0000U | 0x080U << 5U, chip.registers.filter[0].r1);
    UNSIGNED_LONGS_EQUAL(0xFFE8'0000U | 0x181U << 5U, chip.registers.filter[0].r2);
    UNSIGNED_LONGS_EQUAL(0xF008'0000U | 0x700U << 5U, chip.registers.filter[1].r1);
    UNSIGNED_LONGS_EQUAL(chip.registers.filter[1].r1, chip.registers.filter[1].r2);
}

TEST(Stm32Can, more_filters_than_the_chip_has_let_every_frame_pass) {
    const std::array<hal::CanFilter, CanController::filter_capacity + 1> filters{};
    start_on_bus(filters);
    UNSIGNED_LONGS_EQUAL(1, chip.registers.fa1r);
    UNSIGNED_LONGS_EQUAL(1, chip.registers.fs1r);
}

TEST(Stm32Can, all_fourteen_banks_are_used_by_28_filters) {
    const std::array<hal::CanFilter, CanController::filter_capacity> filters{};
    start_on_bus(filters);
    UNSIGNED_LONGS_EQUAL(0x3FFF, chip.registers.fa1r);
}

TEST(Stm32Can, a_frame_goes_into_the_first_empty_mailbox) {
    start_on_bus();
    CHECK_TRUE(can.send({0x1FE, false, false, 8, {1, 2, 3, 4, 5, 6, 7, 8}}));
    UNSIGNED_LONGS_EQUAL(0x1FEU << 21U | 1U, chip.registers.transmit[0].identifier);
    UNSIGNED_LONGS_EQUAL(8, chip.registers.transmit[0].length);
    UNSIGNED_LONGS_EQUAL(0x0403'0201U, chip.registers.transmit[0].low);
    UNSIGNED_LONGS_EQUAL(0x0807'0605U, chip.registers.transmit[0].high);
    chip.occupy();
    CHECK_FALSE(can.is_all_sent());
    CHECK_TRUE(can.send({0x1234'5678, true, true, 3, {}}));
    UNSIGNED_LONGS_EQUAL(0x1234'5678U << 3U | 7U, chip.registers.transmit[1].identifier);
    UNSIGNED_LONGS_EQUAL(3, chip.registers.transmit[1].length);
}

TEST(Stm32Can, without_an_empty_mailbox_a_frame_is_dropped_and_counted) {
    start_on_bus();
    for (unsigned k = 0; k < 3; ++k) {
        CHECK_TRUE(can.send({}));
        chip.occupy();
    }
    CHECK_FALSE(can.send({}));
    UNSIGNED_LONGS_EQUAL(1, can.health().unsent);
    LONGS_EQUAL(3, chip.sent().size());
    CHECK_TRUE(can.is_all_sent());
    CHECK_TRUE(can.send({}));
}

TEST(Stm32Can, a_received_frame_is_given_once_and_released) {
    start_on_bus();
    chip.arrive(0x181U << 21U, 0xAB05U | 0x7700'0000U, 0x4433'2211U, 0x8877'6655U);
    hal::CanFrame frame;
    CHECK_TRUE(can.receive(frame));
    UNSIGNED_LONGS_EQUAL(0x181, frame.id);
    CHECK_FALSE(frame.extended || frame.remote);
    LONGS_EQUAL(5, frame.length);
    const std::array<std::uint8_t, 8> bytes{0x11, 0x22, 0x33, 0x44, 0x55, 0, 0, 0};
    CHECK_TRUE(frame.data == bytes);
    UNSIGNED_LONGS_EQUAL(1U << 5U, chip.registers.rf0r);  // RFOM
    chip.registers.rf0r = 1U << 5U | 1U;                  // not shifted yet
    CHECK_FALSE(can.receive(frame));
    chip.react();
    CHECK_TRUE(can.receive(frame));
}

TEST(Stm32Can, a_remote_frame_of_29_bits_carries_no_data_and_a_length_above_8_is_8) {
    start_on_bus();
    chip.arrive(0x1ABC'DEF0U << 3U | 6U, 0xF, 0xFFFF'FFFFU, 0xFFFF'FFFFU);
    hal::CanFrame frame;
    CHECK_TRUE(can.receive(frame));
    CHECK_TRUE(frame.extended && frame.remote);
    UNSIGNED_LONGS_EQUAL(0x1ABC'DEF0U, frame.id);
    LONGS_EQUAL(8, frame.length);
    LONGS_EQUAL(0, frame.data[0]);
    LONGS_EQUAL(0, frame.data[7]);
}

TEST(Stm32Can, error_counters_become_states) {
    start_on_bus();
    set_errors(0x60'0000U | 3U << 4U | 1U);
    LONGS_EQUAL(CanState::error_warning, can.state());
    LONGS_EQUAL(0x60, can.health().transmit_errors);
    LONGS_EQUAL(3, can.health().last_error);
    set_errors(0x8000'0000U | 3U);
    LONGS_EQUAL(CanState::error_passive, can.state());
    LONGS_EQUAL(0x80, can.health().receive_errors);
    CHECK_TRUE(can.send({}));
    set_errors(0);
    LONGS_EQUAL(CanState::running, can.state());
}

TEST(Stm32Can, bus_off_gives_waiting_frames_up_sends_nothing_and_ends_by_itself) {
    start_on_bus();
    CHECK_TRUE(can.send({}));
    chip.occupy();
    set_errors(7);
    LONGS_EQUAL(CanState::bus_off, can.state());
    UNSIGNED_LONGS_EQUAL(0x80'8080U, chip.registers.tsr);  // ABRQ0…2
    chip.react();
    CHECK_FALSE(can.send({}));
    set_errors(7);
    UNSIGNED_LONGS_EQUAL(1, can.health().bus_offs);
    set_errors(0);
    LONGS_EQUAL(CanState::running, can.state());
    CHECK_TRUE(chip.sent().empty());
    CHECK_TRUE(can.send({}));
}

TEST(Stm32Can, a_receive_queue_that_ran_over_is_counted_and_its_flag_cleared) {
    start_on_bus();
    chip.registers.rf0r = 1U << 4U | 3U;
    can.poll(patience);
    UNSIGNED_LONGS_EQUAL(1, can.health().overruns);
    UNSIGNED_LONGS_EQUAL(1U << 4U, chip.registers.rf0r);  // FOVR by a one, RFOM not touched
}
