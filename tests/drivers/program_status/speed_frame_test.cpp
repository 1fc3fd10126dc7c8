// SPDX-License-Identifier: Apache-2.0
#include "program_status/speed_frame.hpp"

#include <limits>

#include "program_status/tool_frame.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::program_status;

namespace {

constexpr std::uint32_t id = speed_frame_id(default_id);

float sent_and_received(float speed_rad_s) {
    SpeedReceiver receiver(id);
    CHECK(receiver.on_frame(encode_speed(speed_rad_s, id), 0));
    return receiver.speed_rad_s(0);
}

}  // namespace

TEST_GROUP(SpeedFrame){};

TEST(SpeedFrame, gives_a_speed_back_to_a_thousandth_of_a_revolution_a_minute) {
    for (const double speed_rad_s : {0.0, 0.001, 1.0, 104.72, 314.159, 6283.0}) {
        DOUBLES_EQUAL(speed_rad_s, static_cast<double>(sent_and_received(static_cast<float>(speed_rad_s))),
                      1.1e-4 + 1e-7 * speed_rad_s);
    }
    const hal::CanFrame frame = encode_speed(104.719755F, id);  // 1000/min
    MEMCMP_EQUAL("\x40\x42\x0F\x00\x00\x00\x00", frame.data.data(), 7);
}

TEST(SpeedFrame, says_that_a_speed_is_not_known_where_none_can_be_told) {
    for (const float speed_rad_s : {-1.0F, 1e9F, std::numeric_limits<float>::quiet_NaN(),
                                    std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
        CHECK_EQUAL(0.0F, sent_and_received(speed_rad_s));
    }
}

TEST(SpeedFrame, has_the_id_of_the_fourth_pdo_or_none) {
    UNSIGNED_LONGS_EQUAL(0x4FD, speed_frame_id(0x1FD));
    UNSIGNED_LONGS_EQUAL(0, speed_frame_id(0));
    UNSIGNED_LONGS_EQUAL(0x7FF, speed_frame_id(0x4FF));
    UNSIGNED_LONGS_EQUAL(0, speed_frame_id(0x500));
}

TEST(SpeedFrame, is_no_tool_frame_and_is_forgotten_a_second_after_the_last) {
    ToolReceiver tool(tool_frame_id(default_id));
    CHECK_FALSE(tool.on_frame(encode_speed(100.0F, id), 0));
    SpeedReceiver receiver(id);
    CHECK_FALSE(receiver.on_frame(encode_tool(7, tool_frame_id(default_id)), 0));
    CHECK(receiver.on_frame(encode_speed(100.0F, id), 5'000'000));
    CHECK(receiver.speed_rad_s(6'000'000) > 99.9F);
    CHECK_EQUAL(0.0F, receiver.speed_rad_s(6'000'001));
}
