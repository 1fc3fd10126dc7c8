// SPDX-License-Identifier: Apache-2.0
#include "way_window/way_frames.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::way_window;

namespace {

constexpr std::uint32_t id = way_frame_id(0x7E);
constexpr std::uint32_t answer_id = way_answer_id(0x7E);

constexpr StretchRecord stretch{.begin_um = 0xFEDC'BA98,
                                .feed_um_s = 0xABCDEF,
                                .tangential_mN = 0x123456,
                                .tooth_per_tangential_e4 = 0x654321,
                                .feed_per_tangential_e3 = -1234,
                                .falling_share_e4 = 9876,
                                .feed_per_softness_e3 = 60'000,
                                .least_share_percent = 37};
constexpr BlockRecord block{0xFEDCBA, 0x8765'4321, 0x123456};

FrameError decoded(const hal::CanFrame& frame) {
    WayFrame found;
    return decode(frame, id, found);
}

}  // namespace

TEST_GROUP(WayFrames){};

TEST(WayFrames, give_a_stretch_and_a_block_back) {
    CHECK(stretch_of(bytes_of(stretch)) == stretch);
    CHECK(block_of(bytes_of(block)) == block);
    MEMCMP_EQUAL("\x98\xBA\xDC\xFE\xEF\xCD\xAB\x56\x34\x12\x21\x43\x65\x2E\xFB\x94\x26\x60\xEA\x25",
                 bytes_of(stretch).data(), 20);
    MEMCMP_EQUAL("\xBA\xDC\xFE\x21\x43\x65\x87\x56\x34\x12", bytes_of(block).data(), 10);
}

TEST(WayFrames, give_number_kind_session_and_payload_back) {
    WayFrame found;
    CHECK(decode(encode(WayFrame{200, 5, 15, {1, 2, 3, 4, 255}}, id), id, found) == FrameError::none);
    UNSIGNED_LONGS_EQUAL(200, found.number);
    UNSIGNED_LONGS_EQUAL(5, found.kind);
    UNSIGNED_LONGS_EQUAL(15, found.session);
    MEMCMP_EQUAL("\x01\x02\x03\x04\xFF", found.payload.data(), 5);
}

TEST(WayFrames, give_an_answer_back) {
    WayAnswer found;
    const WayAnswer answer{77, WayState::refuted, 9, 0xABCD, 64, 0x1234};
    CHECK(decode(encode(answer, answer_id), answer_id, found) == FrameError::none);
    UNSIGNED_LONGS_EQUAL(77, found.ask);
    CHECK(found.state == WayState::refuted);
    UNSIGNED_LONGS_EQUAL(9, found.session);
    UNSIGNED_LONGS_EQUAL(0xABCD, found.expected);
    UNSIGNED_LONGS_EQUAL(64, found.room);
    UNSIGNED_LONGS_EQUAL(0x1234, found.digest);
}

TEST(WayFrames, every_wrong_bit_shows) {
    for (unsigned bit = 0; bit < 64; ++bit) {
        hal::CanFrame frame = encode(WayFrame{1, 2, 3, {4, 5, 6, 7, 8}}, id);
        frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1U << (bit % 8)));
        CHECK(decoded(frame) == FrameError::checksum);
        frame = encode(WayAnswer{1, WayState::takes, 1, 2, 3, 4}, answer_id);
        frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1U << (bit % 8)));
        WayAnswer answer;
        CHECK(decode(frame, answer_id, answer) == FrameError::checksum);
    }
}

TEST(WayFrames, of_another_id_or_length_are_not_taken) {
    hal::CanFrame frame = encode(WayFrame{1, 2, 3, {}}, id);
    CHECK(decoded(frame) == FrameError::none);
    frame.length = 7;
    CHECK(decoded(frame) == FrameError::length);
    CHECK(decoded(encode(WayFrame{1, 2, 3, {}}, answer_id)) == FrameError::not_this_frame);
}

TEST(WayFrames, outside_of_their_range_are_not_taken) {
    CHECK(decoded(encode(WayFrame{1, 8, 3, {}}, id)) == FrameError::range);
    CHECK(decoded(encode(WayFrame{1, 2, 0, {}}, id)) == FrameError::range);
    CHECK(decoded(encode(WayFrame{1, 7, 1, {0, 0, 1, 0, 0}}, id)) == FrameError::range);
    WayAnswer answer;
    CHECK(decode(encode(WayAnswer{1, WayState::takes, 1, 2, 65, 4}, answer_id), answer_id, answer) ==
          FrameError::range);
    CHECK(decode(encode(WayAnswer{1, static_cast<WayState>(6), 1, 2, 3, 4}, answer_id), answer_id, answer) ==
          FrameError::range);
}

TEST(WayFrames, a_record_outside_of_its_range_is_not_sound) {
    CHECK(is_sound(stretch));
    CHECK(is_sound(StretchRecord{.least_share_percent = StretchRecord::unknown_percent}));
    CHECK_FALSE(is_sound(StretchRecord{.feed_um_s = 0}));
    CHECK_FALSE(is_sound(StretchRecord{.feed_um_s = 0x100'0000}));
    CHECK_FALSE(is_sound(StretchRecord{.tangential_mN = 0x100'0000}));
    CHECK_FALSE(is_sound(StretchRecord{.falling_share_e4 = 0}));
    CHECK_FALSE(is_sound(StretchRecord{.falling_share_e4 = 10'001}));
    CHECK_FALSE(is_sound(StretchRecord{.feed_per_softness_e3 = 0}));
    CHECK_FALSE(is_sound(StretchRecord{.least_share_percent = 101}));
    CHECK(is_sound(block));
    CHECK_FALSE(is_sound(BlockRecord{0, 10, 5}));
    CHECK_FALSE(is_sound(BlockRecord{1, 10, 11}));
}

TEST(WayFrames, the_digest_depends_on_the_order) {
    const StretchBytes one = bytes_of(stretch);
    const BlockBytes other = bytes_of(block);
    CHECK(digest(digest(0, one), other) != digest(digest(0, other), one));
    const std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    UNSIGNED_LONGS_EQUAL(0x31C3, digest(0, digits));  // of CRC-16/XMODEM
}
