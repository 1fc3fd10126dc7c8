// SPDX-License-Identifier: Apache-2.0
#include "can_frames.hpp"
#include "cnc_in_c99.h"
#include "override_frame/override_receiver.hpp"
#include "program_status/program_status_receiver.hpp"
#include "program_status/speed_frame.hpp"
#include "program_status/tool_frame.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include <CppUTest/TestHarness.h>

using namespace millforce;

namespace {

constexpr std::size_t results = millforce_heartbeat_malformed + 1;

hal::CanFrame in_cpp(const millforce_can_frame& frame) {
    hal::CanFrame cpp{frame.id, frame.is_extended, frame.is_remote, static_cast<std::uint8_t>(frame.length), {}};
    std::copy_n(frame.data, cpp.data.size(), cpp.data.begin());
    return cpp;
}

/// A bus that loses, repeats, reorders and breaks frames, with pauses now and then.
class TroubledBus {
  public:
    millforce_can_frame next_frame() {
        counter_ = (counter_ + (one_in(8) ? below(120) : below(3))) & 0xFFFFU;
        const std::uint32_t ratio = one_in(10) ? below(65536) : below(20001);
        const millforce_override content{ratio, one_in(8), below(256), below(256), counter_};
        millforce_can_frame frame{};
        c99_encode_override(&content, MILLFORCE_OVERRIDE_ID, &frame);
        trouble(frame);
        return frame;
    }
    std::uint32_t pause_us() { return one_in(200) ? below(60'000) : below(3'000); }

  private:
    std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }
    bool one_in(std::uint32_t times) { return below(times) == 0; }

    void trouble(millforce_can_frame& frame) {
        switch (below(40)) {
            case 0:
                frame.data[below(8)] ^= static_cast<std::uint8_t>(1U << below(8));
                break;
            case 1:
                frame.length = below(9);
                break;
            case 2:
                frame.id = 0x77E;
                frame.length = below(3);
                frame.data[0] = one_in(2) ? 5 : 4;
                break;
            case 3:
                frame.is_remote = true;
                break;
            case 4:
                frame.is_extended = true;
                break;
            case 5:
                counter_ = below(65536);
                break;
            default:
                break;
        }
    }

    std::mt19937 random_{71};
    std::uint32_t counter_ = 0;
};

std::string text_of_function_blocks() {
    std::ifstream file(MILLFORCE_SOURCE_DIR "/drivers/cnc/millforce_cnc.st");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

}  // namespace

TEST_GROUP(CncSide){};

TEST(CncSide, in_c_starts_with_the_settings_of_our_receiver) {
    const override_frame::OverrideReceiverSettings ours;
    const millforce_settings in_c = millforce_default_settings();
    UNSIGNED_LONGS_EQUAL(hal::default_tick_timeout_us, in_c.timeout_us);
    UNSIGNED_LONGS_EQUAL(ours.timeout_us, in_c.timeout_us);
    UNSIGNED_LONGS_EQUAL(ours.node_id, in_c.node);
    UNSIGNED_LONGS_EQUAL(ours.id, in_c.id);
    UNSIGNED_LONGS_EQUAL(ours.largest_counter_step, in_c.largest_counter_step);
    UNSIGNED_LONGS_EQUAL(ours.frames_to_trust, in_c.frames_to_trust);
    DOUBLES_EQUAL(ours.largest_ratio, static_cast<float>(in_c.largest_ratio) * override_frame::ratio_per_bit, 1e-6);
    DOUBLES_EQUAL(ours.fallback_ratio, static_cast<float>(in_c.fallback_ratio) * override_frame::ratio_per_bit, 0.0);
    CHECK_EQUAL(ours.fallback_hold, in_c.fallback_hold);
}

TEST(CncSide, in_c_and_our_receiver_agree_at_every_frame_and_every_poll_of_a_troubled_bus) {
    TroubledBus bus;
    override_frame::OverrideReceiver ours{override_frame::OverrideReceiverSettings{}};
    millforce_receiver in_c99{};
    c99_receiver_start(&in_c99);
    std::array<std::uint32_t, results> counts{};
    int alive = 0;
    std::uint64_t now_us = UINT32_MAX - 300'000'000U;  // its 32 bits wrap on the way
    for (int k = 0; k < 300'000; ++k) {
        now_us += bus.pause_us();
        const millforce_can_frame frame = bus.next_frame();
        ours.on_frame(in_cpp(frame), now_us);
        ++counts.at(c99_on_frame(&in_c99, &frame, static_cast<std::uint32_t>(now_us)));
        now_us += bus.pause_us();
        const override_frame::ReceivedOverride expected = ours.current(now_us);
        const millforce_received received = c99_now(&in_c99, static_cast<std::uint32_t>(now_us));
        CHECK_EQUAL(expected.is_alive, received.is_alive);
        CHECK_EQUAL(expected.hold, received.hold);
        DOUBLES_EQUAL(expected.ratio, static_cast<float>(received.ratio) * override_frame::ratio_per_bit, 0.0);
        CHECK(expected.state == received.state && expected.fault == received.fault);
        alive += received.is_alive ? 1 : 0;
    }
    using override_frame::ReceiveError;
    UNSIGNED_LONGS_EQUAL(ours.errors(ReceiveError::length), counts[millforce_wrong_length]);
    UNSIGNED_LONGS_EQUAL(ours.errors(ReceiveError::checksum), counts[millforce_wrong_checksum]);
    UNSIGNED_LONGS_EQUAL(ours.errors(ReceiveError::ratio_range), counts[millforce_ratio_too_large]);
    UNSIGNED_LONGS_EQUAL(ours.errors(ReceiveError::counter_repeated), counts[millforce_counter_repeated]);
    UNSIGNED_LONGS_EQUAL(ours.errors(ReceiveError::counter_jump), counts[millforce_counter_jumped]);
    UNSIGNED_LONGS_EQUAL(ours.errors(ReceiveError::heartbeat_malformed), counts[millforce_heartbeat_malformed]);
    CHECK(now_us > UINT32_MAX);
    CHECK(alive > 10'000 && alive < 290'000);  // both states were met often
}

TEST(CncSide, in_c_counts_time_over_its_wrap) {
    millforce_receiver receiver{};
    c99_receiver_start(&receiver);
    std::uint32_t now_us = 0U - 5000U;
    for (std::uint32_t counter = 1; counter <= 3; ++counter, now_us += 2000) {
        const millforce_override content{8000, false, 3, 0, counter};
        millforce_can_frame frame{};
        c99_encode_override(&content, MILLFORCE_OVERRIDE_ID, &frame);
        CHECK_EQUAL(millforce_ok, c99_on_frame(&receiver, &frame, now_us));
    }
    CHECK(c99_now(&receiver, 19'000).is_alive);
    CHECK_FALSE(c99_now(&receiver, 19'001).is_alive);
    CHECK_FALSE(c99_now(&receiver, 0U - 1000U).is_alive);  // an hour later: the time of the last frame again
}

TEST(CncSide, sends_the_program_status_every_ten_ms_and_at_once_where_a_flag_changes) {
    millforce_status_sender sender{};
    c99_status_start(&sender);
    program_status::ProgramStatusReceiver receiver({.id = program_status::default_id, .timeout_us = 100'000});
    millforce_program_status status{150'000, 100, false, false, false};
    millforce_can_frame frame{};
    int sent = 0;
    for (std::uint32_t now_us = 0; now_us < 100'000; now_us += 1000) {
        status.is_feed_held = now_us >= 33'000;
        status.feed = 150'000 + now_us;  // alone no reason to send
        if (c99_status_due(&sender, &status, now_us, &frame)) {
            CHECK(receiver.on_frame(in_cpp(frame), now_us));
            ++sent;
        }
        CHECK_EQUAL(status.is_feed_held, receiver.program(now_us).feed_hold);
    }
    LONGS_EQUAL(11, sent);  // 0, 10, 20, 30, 33, 43 … 93 ms
    CHECK(receiver.source(193'000) == program_status::ProgramSource::fresh);
    DOUBLES_EQUAL(2430.0 / 60.0, static_cast<double>(receiver.program(100'000).programmed_feed_mm_s), 1e-4);
}

TEST(CncSide, sends_the_tool_every_hundred_ms_and_at_once_where_it_changes) {
    millforce_tool_sender sender{};
    c99_tool_start(&sender);
    program_status::ToolReceiver receiver(program_status::tool_frame_id(program_status::default_id));
    millforce_can_frame frame{};
    int sent = 0;
    for (std::uint32_t now_us = 0; now_us < 500'000; now_us += 1000) {
        const std::uint32_t tool = now_us < 250'000 ? 7 : 12;
        if (c99_tool_due(&sender, tool, now_us, &frame)) {
            CHECK(receiver.on_frame(in_cpp(frame), now_us));
            ++sent;
        }
        CHECK_EQUAL(tool, receiver.number(now_us));
    }
    LONGS_EQUAL(6, sent);  // 0, 100, 200, 250, 350, 450 ms
}

TEST(CncSide, sends_the_spindles_speed_every_hundred_ms_and_no_sooner) {
    millforce_speed_sender sender{};
    c99_speed_start(&sender);
    program_status::SpeedReceiver receiver(program_status::speed_frame_id(program_status::default_id));
    millforce_can_frame frame{};
    int sent = 0;
    for (std::uint32_t now_us = 0; now_us < 500'000; now_us += 1000) {
        const std::uint32_t speed_rpm = now_us < 250'000 ? 3000 : 3300;
        if (c99_speed_due(&sender, speed_rpm * MILLFORCE_SPEED_UNITS_PER_RPM, now_us, &frame)) {
            CHECK(receiver.on_frame(in_cpp(frame), now_us));
            ++sent;
        }
    }
    LONGS_EQUAL(5, sent);
    DOUBLES_EQUAL(345.575, static_cast<double>(receiver.speed_rad_s(500'000)), 1e-3);  // 3300/min
}

TEST(CncSide, saturates_what_the_program_status_cannot_hold) {
    const millforce_program_status status{0x1000000, 300, false, false, false};
    millforce_can_frame frame{};
    c99_encode_status(&status, 1, MILLFORCE_STATUS_ID, &frame);
    program_status::ProgramStatusFrame ours;
    CHECK(program_status::decode(in_cpp(frame), program_status::default_id, ours) == program_status::FrameError::none);
    DOUBLES_EQUAL(167772.15 / 60.0, static_cast<double>(ours.program.programmed_feed_mm_s), 1e-3);
    DOUBLES_EQUAL(2.55, static_cast<double>(ours.program.operator_override), 1e-6);
}

TEST(CncSide, in_structured_text_has_the_constants_of_the_c_header) {
    const millforce_settings settings = millforce_default_settings();
    const std::string text = text_of_function_blocks();
    std::ostringstream id;
    id << std::uppercase << std::hex << "OverrideId : WORD := 16#" << settings.id << ";|HeartbeatId : WORD := 16#"
       << 0x700U + settings.node << ";|StatusId : WORD := 16#" << MILLFORCE_STATUS_ID << ";|ToolId : WORD := 16#"
       << MILLFORCE_TOOL_ID << ";|SpeedId : WORD := 16#" << MILLFORCE_SPEED_ID << ";|";
    std::ostringstream limits;
    limits << "Timeout : TIME := T#" << settings.timeout_us / 1000 << "ms;|Period : TIME := T#"
           << MILLFORCE_STATUS_PERIOD_US / 1000 << "ms;|Period : TIME := T#" << MILLFORCE_TOOL_PERIOD_US / 1000
           << "ms;|LargestStep : DINT := " << settings.largest_counter_step
           << ";|FramesToTrust : INT := " << settings.frames_to_trust
           << ";|LargestRatio : DINT := " << settings.largest_ratio
           << ";|FallbackRatio : DINT := " << settings.fallback_ratio << ";|Crc XOR BYTE#16#2F;";
    std::istringstream all(id.str() + limits.str());
    for (std::string part; std::getline(all, part, '|');) {
        CHECK_TEXT(text.find(part) != std::string::npos, part.c_str());
    }
}
