// SPDX-License-Identifier: Apache-2.0
#include "drivers/zynqmp/fake_can.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::zynqmp;

TEST_GROUP(ZynqCan) {
    FakeZynqCan chip;
    CanController can{chip.registers};

    void start_on_bus() {
        can.start(kbit_500);
        chip.react();
        can.poll();
        LONGS_EQUAL(CanState::running, can.state());
    }
    void set_status(std::uint32_t bits) {
        chip.registers.sr = FakeZynqCan::normal | bits;
        can.poll();
    }
};

TEST(ZynqCan, is_set_up_while_reset_and_runs_once_the_status_says_so) {
    chip.registers.msr = 7;
    chip.registers.afr = 0xF;
    can.start(kbit_500);
    UNSIGNED_LONGS_EQUAL(2, chip.registers.srr);  // CEN
    UNSIGNED_LONGS_EQUAL(0, chip.registers.msr);
    UNSIGNED_LONGS_EQUAL(0, chip.registers.afr);
    UNSIGNED_LONGS_EQUAL(0, chip.registers.ier);
    LONGS_EQUAL(CanState::joining, can.state());
    can.poll();
    LONGS_EQUAL(CanState::joining, can.state());
    CHECK_FALSE(can.send({}));
    chip.react();
    can.poll();
    LONGS_EQUAL(CanState::running, can.state());
}

TEST(ZynqCan, bit_rates_of_a_clock_of_100_MHz) {
    struct Case {
        CanBitTiming timing;
        std::uint32_t bits_per_s;
    };
    for (const Case& c : {Case{kbit_500, 500'000}, Case{kbit_1000, 1'000'000}}) {
        chip.registers.sr = FakeZynqCan::setup;
        can.start(c.timing);
        const std::uint32_t btr = chip.registers.btr;
        const std::uint32_t quanta = 1 + ((btr & 0xFU) + 1) + ((btr >> 4U & 7U) + 1);
        UNSIGNED_LONGS_EQUAL(c.bits_per_s, 100'000'000 / (chip.registers.brpr + 1) / quanta);
        UNSIGNED_LONGS_EQUAL(0, btr >> 7U);  // jumps of one
    }
}

TEST(ZynqCan, a_controller_that_does_not_enter_its_setup_is_absent) {
    chip.registers.sr = 0;
    can.start(kbit_500);
    LONGS_EQUAL(CanState::absent, can.state());
    can.poll();
    CHECK_FALSE(can.send({}));
    UNSIGNED_LONGS_EQUAL(1, can.health().unsent);
    STRCMP_EQUAL("absent", name(can.state()));
}

TEST(ZynqCan, a_frame_begins_in_the_highest_byte_of_its_first_word) {
    start_on_bus();
    CHECK_TRUE(can.send({0x1FE, false, false, 8, {1, 2, 3, 4, 5, 6, 7, 8}}));
    UNSIGNED_LONGS_EQUAL(0x1FEU << 21U, chip.registers.transmit.identifier);
    UNSIGNED_LONGS_EQUAL(8U << 28U, chip.registers.transmit.length);
    UNSIGNED_LONGS_EQUAL(0x0102'0304U, chip.registers.transmit.data1);
    UNSIGNED_LONGS_EQUAL(0x0506'0708U, chip.registers.transmit.data2);
}

TEST(ZynqCan, a_remote_frame_of_29_bits_sets_SRR_IDE_and_RTR) {
    start_on_bus();
    CHECK_TRUE(can.send({0x1234'5678, true, true, 3, {}}));
    const std::uint32_t expected = (0x1234'5678U >> 18U) << 21U | 3U << 19U | (0x1234'5678U & 0x3'FFFFU) << 1U | 1U;
    UNSIGNED_LONGS_EQUAL(expected, chip.registers.transmit.identifier);
    CHECK_TRUE(can.send({0x123, false, true, 0, {}}));
    UNSIGNED_LONGS_EQUAL(0x123U << 21U | 1U << 20U, chip.registers.transmit.identifier);
}

TEST(ZynqCan, what_was_sent_is_received_as_it_was) {
    start_on_bus();
    for (const hal::CanFrame& sent :
         {hal::CanFrame{0x181, false, false, 5, {9, 8, 7, 6, 5}}, hal::CanFrame{0x1ABC'DEF0, true, false, 8, {1, 2, 3}},
          hal::CanFrame{0x7FF, false, true, 2, {}}, hal::CanFrame{0x1FFF'FFFF, true, true, 0, {}}}) {
        CHECK_TRUE(can.send(sent));
        const auto& out = chip.registers.transmit;
        chip.arrive(out.identifier, out.length >> 28U, out.data1, out.data2);
        hal::CanFrame got;
        CHECK_TRUE(can.receive(got));
        chip.react();
        UNSIGNED_LONGS_EQUAL(sent.id, got.id);
        CHECK_TRUE(sent.extended == got.extended && sent.remote == got.remote && sent.length == got.length);
        CHECK_TRUE(sent.data == got.data);
        CHECK_FALSE(can.receive(got));
    }
}

TEST(ZynqCan, bytes_behind_the_length_are_not_taken_and_a_length_above_8_is_8) {
    start_on_bus();
    chip.arrive(0x200U << 21U, 2, 0x1122'3344U, 0x5566'7788U);
    hal::CanFrame frame;
    CHECK_TRUE(can.receive(frame));
    const std::array<std::uint8_t, 8> two{0x11, 0x22};
    CHECK_TRUE(frame.data == two);
    chip.arrive(0x200U << 21U, 0xF, 0x1122'3344U, 0x5566'7788U);
    CHECK_TRUE(can.receive(frame));
    LONGS_EQUAL(8, frame.length);
    LONGS_EQUAL(0x88, frame.data[7]);
}

TEST(ZynqCan, a_full_queue_drops_the_frame_and_counts_it) {
    start_on_bus();
    CHECK_TRUE(can.has_room());
    set_status(1U << 10U);  // TXFLL
    CHECK_FALSE(can.has_room());
    CHECK_FALSE(can.send({}));
    UNSIGNED_LONGS_EQUAL(1, can.health().unsent);
    set_status(0);
    CHECK_TRUE(can.send({}));
}

TEST(ZynqCan, error_counters_become_states) {
    start_on_bus();
    chip.registers.ecr = 0x0360U;
    chip.registers.esr = 1U << 4U;
    set_status(1U << 6U);  // ERRWRN
    LONGS_EQUAL(CanState::error_warning, can.state());
    LONGS_EQUAL(0x60, can.health().transmit_errors);
    LONGS_EQUAL(3, can.health().receive_errors);
    LONGS_EQUAL(16, can.health().last_errors);
    set_status(1U << 6U | 3U << 7U);
    LONGS_EQUAL(CanState::error_passive, can.state());
    CHECK_TRUE(can.send({}));
    set_status(1U << 7U);  // ESTAT 01: active
    LONGS_EQUAL(CanState::running, can.state());
}

TEST(ZynqCan, bus_off_leaves_the_bus_until_it_is_started_anew) {
    start_on_bus();
    chip.registers.isr = 1U << 9U;
    can.poll();
    LONGS_EQUAL(CanState::bus_off, can.state());
    UNSIGNED_LONGS_EQUAL(1, chip.registers.srr);  // SRST
    UNSIGNED_LONGS_EQUAL(1, can.health().bus_offs);
    can.poll();
    CHECK_FALSE(can.send({}));
    hal::CanFrame frame;
    chip.arrive(0, 0, 0, 0);
    CHECK_FALSE(can.receive(frame));
    chip.react();
    start_on_bus();
    CHECK_TRUE(can.send({}));
}

TEST(ZynqCan, a_receive_queue_that_ran_over_is_counted_and_its_flag_cleared) {
    start_on_bus();
    chip.registers.isr = 1U << 6U;
    can.poll();
    UNSIGNED_LONGS_EQUAL(1, can.health().overruns);
    UNSIGNED_LONGS_EQUAL(1U << 6U, chip.registers.icr);
    chip.react();
    can.poll();
    UNSIGNED_LONGS_EQUAL(1, can.health().overruns);
}
