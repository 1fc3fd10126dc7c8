// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <random>

#include "program_status/program_status_receiver.hpp"
#include "program_status/tool_frame.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::program_status;

namespace {

constexpr std::uint32_t id = tool_frame_id(default_id);

}  // namespace

TEST_GROUP(ToolFrame){};

TEST(ToolFrame, gives_any_number_back) {
    for (const std::uint32_t number : {0U, 1U, 16U, 0x01020304U, UINT32_MAX}) {
        std::uint32_t got = 99;
        CHECK(decode_tool(encode_tool(number, id), id, got) == FrameError::none);
        UNSIGNED_LONGS_EQUAL(number, got);
    }
    const hal::CanFrame frame = encode_tool(0x01020304, id);
    MEMCMP_EQUAL("\x04\x03\x02\x01\x00\x00\x00", frame.data.data(), 7);
}

TEST(ToolFrame, has_the_id_of_the_next_pdo_or_none) {
    UNSIGNED_LONGS_EQUAL(0x2FD, tool_frame_id(0x1FD));
    UNSIGNED_LONGS_EQUAL(0, tool_frame_id(0));
    UNSIGNED_LONGS_EQUAL(0x7FF, tool_frame_id(0x6FF));
    UNSIGNED_LONGS_EQUAL(0, tool_frame_id(0x700));
}

TEST(ToolFrame, is_refused_by_reason_where_it_is_not_sound_and_keeps_the_number) {
    std::uint32_t number = 5;
    hal::CanFrame frame = encode_tool(7, id);
    CHECK(decode_tool(frame, default_id, number) == FrameError::not_this_frame);
    frame.length = 7;
    CHECK(decode_tool(frame, id, number) == FrameError::length);
    for (unsigned bit = 0; bit < 64; ++bit) {
        frame = encode_tool(7, id);
        frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1U << (bit % 8)));
        CHECK(decode_tool(frame, id, number) == FrameError::checksum);
    }
    for (const std::size_t reserved : {4U, 5U, 6U}) {
        frame = encode_tool(7, id);
        frame.data[reserved] = 1;
        frame.data[7] = checksum_of(frame);
        CHECK(decode_tool(frame, id, number) == FrameError::reserved_bits);
    }
    frame = encode_tool(7, id);
    frame.extended = true;
    CHECK(decode_tool(frame, id, number) == FrameError::not_this_frame);
    UNSIGNED_LONGS_EQUAL(5, number);
}

TEST(ToolFrame, is_no_program_status_and_the_other_way_round) {
    ProgramStatusReceiver status({.id = default_id, .timeout_us = 100'000});
    ToolReceiver tool(id);
    CHECK_FALSE(status.on_frame(encode_tool(7, id), 0));
    CHECK(status.source(0) == ProgramSource::never_heard);
    CHECK_FALSE(tool.on_frame(encode(ProgramStatusFrame{}, default_id), 0));
    UNSIGNED_LONGS_EQUAL(0, status.errors(ReceiveError::length) + status.errors(ReceiveError::checksum));
}

TEST(ToolFrame, is_known_from_the_first_frame_until_a_second_after_the_last) {
    ToolReceiver receiver(id);
    UNSIGNED_LONGS_EQUAL(0, receiver.number(0));
    CHECK(receiver.on_frame(encode_tool(7, id), 5'000'000));
    CHECK(receiver.on_frame(encode_tool(12, id), 5'100'000));
    UNSIGNED_LONGS_EQUAL(12, receiver.number(6'100'000));
    UNSIGNED_LONGS_EQUAL(0, receiver.number(6'100'001));
    CHECK(receiver.on_frame(encode_tool(0, id), 6'200'000));
    UNSIGNED_LONGS_EQUAL(0, receiver.number(6'200'000));
}

TEST(ToolFrame, is_not_heard_where_there_is_none) {
    ToolReceiver receiver(0);
    CHECK_FALSE(receiver.on_frame(encode_tool(7, 0), 0));
    UNSIGNED_LONGS_EQUAL(0, receiver.number(0));
}

TEST(ToolFrame, random_frames_change_nothing_but_for_those_that_are_sound) {
    std::mt19937 random(8);
    ToolReceiver receiver(id);
    unsigned taken = 0;
    std::uint32_t expected = 0;
    for (int k = 0; k < 300'000; ++k) {
        hal::CanFrame frame;
        frame.id = id;
        frame.length = static_cast<std::uint8_t>(random() % 4 == 0 ? random() % 16 : 8);
        for (std::uint8_t& byte : frame.data) {
            byte = static_cast<std::uint8_t>(random());
        }
        if (random() % 2 == 0) {
            frame.data[4] = frame.data[5] = frame.data[6] = 0;
        }
        if (receiver.on_frame(frame, 0)) {
            ++taken;
            expected = static_cast<std::uint32_t>(frame.data[0]) | (std::uint32_t{frame.data[1]} << 8U) |
                       (std::uint32_t{frame.data[2]} << 16U) | (std::uint32_t{frame.data[3]} << 24U);
        }
        UNSIGNED_LONGS_EQUAL(expected, receiver.number(0));
    }
    CHECK(taken > 100 && taken < 1200);  // of 256 checksums one fits, of two frames one has its reserved bytes 0
}
