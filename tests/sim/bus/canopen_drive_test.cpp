// SPDX-License-Identifier: Apache-2.0
#include "bus/canopen_drive.hpp"
#include "can_frames.hpp"

#include <initializer_list>
#include <random>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using sim::CanopenDrive;

namespace {

std::uint32_t last_four(const hal::CanFrame& f) {
    return static_cast<std::uint32_t>(f.data[4]) | static_cast<std::uint32_t>(f.data[5]) << 8U |
           static_cast<std::uint32_t>(f.data[6]) << 16U | static_cast<std::uint32_t>(f.data[7]) << 24U;
}

}  // namespace

TEST_GROUP(CanopenDrive) {
    CanopenDrive drive{{3, 12.0, 8.0, 0}};
    std::uint64_t now_us = 0;

    void setup() override {
        CHECK_EQUAL(1U, drive.take_frames().size());
    }  // the boot-up
    std::vector<hal::CanFrame> hears(const hal::CanFrame& f) {
        drive.on_frame(f, now_us);
        return drive.take_frames();
    }
    std::uint32_t abort_code(std::initializer_list<unsigned> request) {
        const auto answers = hears(frame_of(0x603, request));
        CHECK_EQUAL(1U, answers.size());
        UNSIGNED_LONGS_EQUAL(0x583, answers[0].id);
        return answers[0].data[0] == 0x80 ? last_four(answers[0]) : 0;
    }
};

TEST(CanopenDrive, answers_a_read_with_size_and_value) {
    const auto answers = hears(frame_of(0x603, {0x40, 0x75, 0x60, 0, 0, 0, 0, 0}));
    CHECK_EQUAL(1U, answers.size());
    UNSIGNED_LONGS_EQUAL(0x43, answers[0].data[0]);
    UNSIGNED_LONGS_EQUAL(12'000, last_four(answers[0]));
}

TEST(CanopenDrive, refuses_with_the_code_that_the_standard_gives) {
    UNSIGNED_LONGS_EQUAL(0x06020000, abort_code({0x40, 0x99, 0x20, 0, 0, 0, 0, 0}));           // no such object
    UNSIGNED_LONGS_EQUAL(0x06090011, abort_code({0x40, 0x75, 0x60, 7, 0, 0, 0, 0}));           // no such subindex
    UNSIGNED_LONGS_EQUAL(0x06010002, abort_code({0x23, 0x75, 0x60, 0, 1, 0, 0, 0}));           // read only
    UNSIGNED_LONGS_EQUAL(0x06070010, abort_code({0x23, 0x17, 0x10, 0, 1, 0, 0, 0}));           // four bytes for two
    UNSIGNED_LONGS_EQUAL(0x08000022, abort_code({0x23, 0x00, 0x1A, 1, 0x10, 0, 0x78, 0x60}));  // its PDO is on
    UNSIGNED_LONGS_EQUAL(0x06040041, abort_code({0x23, 0x01, 0x1A, 1, 0x20, 0, 0x75, 0x60}));  // cannot be mapped
    UNSIGNED_LONGS_EQUAL(0x05040001, abort_code({0xE0, 0x75, 0x60, 0, 0, 0, 0, 0}));           // no such command
    UNSIGNED_LONGS_EQUAL(7, drive.aborts());
}

TEST(CanopenDrive, sends_pdos_at_sync_when_it_is_operational_and_not_before) {
    CHECK_EQUAL(0U, hears(frame_of(0x080, {})).size());
    CHECK_EQUAL(0U, hears(frame_of(0x000, {0x01, 4})).size());  // another node is started
    CHECK_EQUAL(0U, hears(frame_of(0x080, {})).size());
    hears(frame_of(0x000, {0x01, 3}));
    drive.set_position(-2);
    drive.set_current_A(-6.0);
    const auto sent = hears(frame_of(0x080, {}));
    CHECK_EQUAL(1U, sent.size());
    UNSIGNED_LONGS_EQUAL(0x183, sent[0].id);
    const std::array<std::uint8_t, 8> expected{0xFE, 0xFF, 0xFF, 0xFF, 0x0C, 0xFE, 0x37, 0x02};
    CHECK(sent[0].data == expected);
    hears(frame_of(0x000, {0x02, 0}));
    CHECK_EQUAL(0U, hears(frame_of(0x080, {})).size());
}

TEST(CanopenDrive, sends_a_pdo_at_every_third_sync_where_its_type_says_so) {
    UNSIGNED_LONGS_EQUAL(0, abort_code({0x2F, 0x00, 0x18, 2, 3, 0, 0, 0}));
    hears(frame_of(0x000, {0x01, 3}));
    std::size_t sent = 0;
    for (int k = 0; k < 30; ++k) {
        sent += hears(frame_of(0x080, {})).size();
    }
    CHECK_EQUAL(10U, sent);
}

TEST(CanopenDrive, produces_its_heartbeat_and_boots_when_it_is_reset) {
    UNSIGNED_LONGS_EQUAL(0, abort_code({0x2B, 0x17, 0x10, 0, 10, 0, 0, 0}));
    int heartbeats = 0;
    for (; now_us < 100'000; now_us += 1000) {
        drive.poll(now_us);
        for (const hal::CanFrame& f : drive.take_frames()) {
            UNSIGNED_LONGS_EQUAL(0x703, f.id);
            UNSIGNED_LONGS_EQUAL(0x7F, f.data[0]);
            ++heartbeats;
        }
    }
    LONGS_EQUAL(10, heartbeats);
    const auto boot = hears(frame_of(0x000, {0x81, 0}));
    CHECK_EQUAL(1U, boot.size());
    UNSIGNED_LONGS_EQUAL(0, boot[0].data[0]);
    UNSIGNED_LONGS_EQUAL(0, drive.object(0x1017, 0));
}

TEST(CanopenDrive, saturates_currents_at_sixteen_bits) {
    drive.set_current_A(1e9);
    UNSIGNED_LONGS_EQUAL(0x7FFF, drive.object(0x6078, 0));
    drive.set_current_A(-1e9);
    UNSIGNED_LONGS_EQUAL(0x8000, drive.object(0x6078, 0));
}

TEST(CanopenDrive, without_power_says_nothing) {
    drive.set_power(false);
    CHECK_EQUAL(0U, hears(frame_of(0x603, {0x40, 0x75, 0x60, 0, 0, 0, 0, 0})).size());
    drive.raise_emergency(0x1000, 1);
    CHECK_EQUAL(0U, drive.take_frames().size());
    drive.set_power(true);
    CHECK_EQUAL(1U, drive.take_frames().size());
}

TEST(CanopenDrive, any_frames_do_no_harm) {
    std::mt19937 random(31);
    for (int k = 0; k < 200'000; ++k) {
        hal::CanFrame f;
        const std::uint32_t ids[] = {0x000, 0x080, 0x603, static_cast<std::uint32_t>(random() & 0x7FFU)};
        f.id = ids[random() % 4];
        f.length = static_cast<std::uint8_t>(random() % 4 == 0 ? random() % 256 : 8);
        for (std::uint8_t& byte : f.data) {
            byte = static_cast<std::uint8_t>(random());
        }
        if (f.id == 0x603) {  // mostly objects that there are
            f.data[2] = random() % 2 == 0 ? 0x1A : 0x18;
            f.data[1] = static_cast<std::uint8_t>(random() % 5);
            f.data[3] = static_cast<std::uint8_t>(random() % 10);
        }
        f.length = f.id == 0x000 ? std::uint8_t{2} : f.length;
        for (const hal::CanFrame& sent : hears(f)) {
            CHECK(sent.length <= 8 && sent.id <= 0x7FF);
        }
    }
}
