// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "program_status/position_frame.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::program_status;

namespace {

constexpr std::uint32_t id = position_frame_id(default_id);

ProgramPosition received(const ProgramPosition& position) {
    ProgramPosition got{99, 99.0F, 99};
    CHECK(decode_position(encode_position(position, id), id, got) == FrameError::none);
    return got;
}

}  // namespace

TEST_GROUP(PositionFrame){};

TEST(PositionFrame, gives_line_and_distance_back) {
    const hal::CanFrame frame = encode_position({0x010203, 66.051F, 7}, id);
    MEMCMP_EQUAL("\x03\x02\x01\x03\x02\x01\x07", frame.data.data(), 7);
    const ProgramPosition got = received({16'777'215, 16'777.0F, 255});
    UNSIGNED_LONGS_EQUAL(16'777'215, got.line);
    DOUBLES_EQUAL(16'777.0, static_cast<double>(got.distance_to_go_mm), 2e-3);
    UNSIGNED_LONGS_EQUAL(255, got.counter);
}

TEST(PositionFrame, what_does_not_fit_is_not_known) {
    for (const float distance_mm :
         {-0.1F, 16'777.3F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        UNSIGNED_LONGS_EQUAL(0, received({5, distance_mm, 0}).line);
    }
    UNSIGNED_LONGS_EQUAL(0, received({0x1000000, 1.0F, 0}).line);
}

TEST(PositionFrame, has_the_id_of_the_third_pdo_or_none) {
    UNSIGNED_LONGS_EQUAL(0x3FD, position_frame_id(0x1FD));
    UNSIGNED_LONGS_EQUAL(0, position_frame_id(0));
    UNSIGNED_LONGS_EQUAL(0, position_frame_id(0x600));
}

TEST(PositionFrame, is_refused_where_it_is_not_sound) {
    ProgramPosition position;
    for (unsigned bit = 0; bit < 64; ++bit) {
        hal::CanFrame frame = encode_position({7, 1.0F, 1}, id);
        frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1U << (bit % 8)));
        CHECK(decode_position(frame, id, position) == FrameError::checksum);
    }
    hal::CanFrame frame = encode_position({7, 1.0F, 1}, id);
    frame.length = 7;
    CHECK(decode_position(frame, id, position) == FrameError::length);
    CHECK(decode_position(frame, default_id, position) == FrameError::not_this_frame);
    UNSIGNED_LONGS_EQUAL(0, position.line);
}

TEST(PositionFrame, a_frame_that_is_repeated_or_late_is_not_used) {
    PositionReceiver receiver(id);
    CHECK(receiver.on_frame(encode_position({3, 10.0F, 254}, id), 1000));
    CHECK(receiver.on_frame(encode_position({3, 9.0F, 1}, id), 2000));  // two lost, over the counter's end
    CHECK_FALSE(receiver.on_frame(encode_position({3, 9.0F, 1}, id), 3000));
    CHECK_FALSE(receiver.on_frame(encode_position({3, 9.5F, 255}, id), 3000));
    DOUBLES_EQUAL(9.0, static_cast<double>(receiver.position(2000, 0.0F).distance_to_go_mm), 1e-3);
    CHECK(receiver.on_frame(encode_position({1, 5.0F, 0}, id), 2000 + PositionReceiver::timeout_us + 1));
}

TEST(PositionFrame, between_frames_the_tool_goes_on_and_after_their_silence_it_is_nowhere) {
    PositionReceiver receiver(id);
    UNSIGNED_LONGS_EQUAL(0, receiver.position(0, 0.0F).line);
    CHECK(receiver.on_frame(encode_position({3, 10.0F, 1}, id), 1000));
    DOUBLES_EQUAL(9.75, static_cast<double>(receiver.position(11'000, 25.0F).distance_to_go_mm), 1e-3);
    DOUBLES_EQUAL(0.0, static_cast<double>(receiver.position(11'000, 2000.0F).distance_to_go_mm), 1e-3);
    UNSIGNED_LONGS_EQUAL(3, receiver.position(1000 + PositionReceiver::timeout_us, 0.0F).line);
    UNSIGNED_LONGS_EQUAL(0, receiver.position(1001 + PositionReceiver::timeout_us, 0.0F).line);
}

TEST(PositionFrame, is_not_heard_where_there_is_none) {
    PositionReceiver receiver(0);
    CHECK_FALSE(receiver.on_frame(encode_position({7, 1.0F, 1}, 0), 0));
}
