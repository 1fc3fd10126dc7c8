// SPDX-License-Identifier: Apache-2.0
#include "drivers/cnc/cnc_vectors.hpp"
#include "cnc_in_c99.h"
#include "override_frame/override_receiver.hpp"
#include "override_frame/override_sender.hpp"
#include "program_status/position_frame.hpp"
#include "program_status/program_status_frame.hpp"
#include "program_status/tool_frame.hpp"

#include <algorithm>
#include <map>
#include <string>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;

namespace {

millforce_can_frame in_c(const hal::CanFrame& frame) {
    millforce_can_frame c{frame.id, frame.extended, frame.remote, frame.length, {}};
    std::copy(frame.data.begin(), frame.data.end(), c.data);
    return c;
}

void check_same(const hal::CanFrame& expected, const hal::CanFrame& frame, const char* text) {
    CHECK_EQUAL_TEXT(expected.id, frame.id, text);
    CHECK_EQUAL_TEXT(expected.length, frame.length, text);
    CHECK_TEXT(expected.data == frame.data, text);
}

void check_same(const hal::CanFrame& expected, const millforce_can_frame& frame, const char* text) {
    CHECK_EQUAL_TEXT(expected.id, frame.id, text);
    CHECK_EQUAL_TEXT(expected.length, frame.length, text);
    CHECK_TEXT(std::equal(expected.data.begin(), expected.data.end(), frame.data), text);
    CHECK_TEXT(!frame.is_extended && !frame.is_remote, text);
}

float ratio_of(std::uint32_t bits) {
    return static_cast<float>(bits) * override_frame::ratio_per_bit;
}

/// Both receivers, on the same frames.
struct Receivers {
    override_frame::OverrideReceiver ours{override_frame::OverrideReceiverSettings{}};
    millforce_receiver in_c99{};

    Receivers() { c99_receiver_start(&in_c99); }
};

}  // namespace

TEST_GROUP(CncVectors){};

TEST(CncVectors, of_the_override_are_what_our_sender_sends_and_what_the_c_header_makes_and_reads) {
    int count = 0;
    for (const Words& words : cnc_vectors()) {
        if (words[0] != "override") {
            continue;
        }
        const char* text = words.back().c_str();
        const hal::CanFrame frame = frame_of(words, 1, 8);
        const std::uint32_t ratio = decimal(words[2]);
        const bool hold = words[3] == "1";
        const auto state = static_cast<std::uint8_t>(decimal(words[4]));
        const auto fault = static_cast<std::uint8_t>(decimal(words[5]));
        const std::uint32_t counter = decimal(words[6]);

        override_frame::OverrideSender sender{{.id = frame.id}};
        sender.update({ratio_of(ratio), hold, state, fault, counter}, 0);
        hal::CanFrame sent;
        CHECK_TEXT(sender.take_frame(sent), text);
        check_same(frame, sent, text);

        const millforce_override content{ratio, hold, state, fault, counter};
        millforce_can_frame encoded{};
        c99_encode_override(&content, frame.id, &encoded);
        check_same(frame, encoded, text);

        millforce_override decoded{};
        CHECK_EQUAL_TEXT(millforce_ok, c99_decode_override(&encoded, frame.id, &decoded), text);
        CHECK_TEXT(decoded.ratio == ratio && decoded.hold == hold && decoded.state == state && decoded.fault == fault &&
                       decoded.counter == counter,
                   text);
        ++count;
    }
    LONGS_EQUAL(7, count);
}

TEST(CncVectors, of_the_program_status_are_what_the_c_header_makes_and_what_our_receiver_reads) {
    int count = 0;
    for (const Words& words : cnc_vectors()) {
        if (words[0] != "status") {
            continue;
        }
        const char* text = words.back().c_str();
        const hal::CanFrame frame = frame_of(words, 1, 9);
        const millforce_program_status content{decimal(words[2]), decimal(words[3]), words[4] == "1", words[5] == "1",
                                               words[6] == "1"};
        const std::uint32_t counter = decimal(words[7]);
        millforce_can_frame encoded{};
        c99_encode_status(&content, counter, frame.id, &encoded);
        check_same(frame, encoded, text);

        millforce_program_status decoded{};
        std::uint32_t decoded_counter = 0;
        CHECK_EQUAL_TEXT(millforce_ok, c99_decode_status(&encoded, frame.id, &decoded, &decoded_counter), text);
        CHECK_TEXT(decoded.feed == content.feed && decoded.operator_override == content.operator_override &&
                       decoded.is_rapid == content.is_rapid && decoded.is_feed_held == content.is_feed_held &&
                       decoded.resets_fault == content.resets_fault && decoded_counter == counter,
                   text);

        program_status::ProgramStatusFrame ours;
        CHECK_TEXT(program_status::decode(frame, frame.id, ours) == program_status::FrameError::none, text);
        DOUBLES_EQUAL_TEXT(static_cast<double>(content.feed) / 6000.0,
                           static_cast<double>(ours.program.programmed_feed_mm_s), 1e-6 * content.feed / 6000.0, text);
        CHECK_TEXT(ours.program.rapid == content.is_rapid && ours.program.feed_hold == content.is_feed_held &&
                       ours.reset_fault == content.resets_fault && ours.counter == counter,
                   text);
        check_same(frame, program_status::encode(ours, frame.id), text);
        ++count;
    }
    LONGS_EQUAL(7, count);
}

struct NumberInC {
    void (*encode)(std::uint32_t number, std::uint32_t id, millforce_can_frame* frame);
    millforce_result (*decode)(const millforce_can_frame* frame, std::uint32_t id, std::uint32_t* number);
};

/// How many vectors there are of this name.
int check_numbers(const std::string& name, const NumberInC& in_c99) {
    int count = 0;
    for (const Words& words : cnc_vectors()) {
        if (words[0] != name) {
            continue;
        }
        const char* text = words.back().c_str();
        const hal::CanFrame frame = frame_of(words, 1, 4);
        const std::uint32_t number = decimal(words[2]);
        millforce_can_frame encoded{};
        in_c99.encode(number, frame.id, &encoded);
        check_same(frame, encoded, text);
        std::uint32_t decoded = ~number;
        CHECK_EQUAL_TEXT(millforce_ok, in_c99.decode(&encoded, frame.id, &decoded), text);
        CHECK_EQUAL_TEXT(number, decoded, text);
        std::uint32_t ours = ~number;
        CHECK_TEXT(program_status::decode_number(frame, frame.id, ours) == program_status::FrameError::none, text);
        CHECK_EQUAL_TEXT(number, ours, text);
        ++count;
    }
    return count;
}

TEST(CncVectors, of_the_tool_are_what_the_c_header_makes_and_what_our_receiver_reads) {
    LONGS_EQUAL(5, check_numbers("tool", {c99_encode_tool, c99_decode_tool}));
}

TEST(CncVectors, of_the_speed_are_what_the_c_header_makes_and_what_our_receiver_reads) {
    LONGS_EQUAL(4, check_numbers("speed", {c99_encode_speed, c99_decode_speed}));
}

TEST(CncVectors, of_the_position_are_what_the_c_header_makes_and_what_our_receiver_reads) {
    int count = 0;
    for (const Words& words : cnc_vectors()) {
        if (words[0] != "position") {
            continue;
        }
        const char* text = words.back().c_str();
        const hal::CanFrame frame = frame_of(words, 1, 6);
        const millforce_position content{decimal(words[2]), decimal(words[3])};
        const std::uint32_t counter = decimal(words[4]);
        millforce_can_frame encoded{};
        c99_encode_position(&content, counter, frame.id, &encoded);
        check_same(frame, encoded, text);
        millforce_position decoded{};
        std::uint32_t decoded_counter = 0;
        CHECK_EQUAL_TEXT(millforce_ok, c99_decode_position(&encoded, frame.id, &decoded, &decoded_counter), text);
        CHECK_TEXT(decoded.line == content.line && decoded.distance == content.distance && decoded_counter == counter,
                   text);
        program_status::ProgramPosition ours;
        CHECK_TEXT(program_status::decode_position(frame, frame.id, ours) == program_status::FrameError::none, text);
        CHECK_EQUAL_TEXT(content.line, ours.line, text);
        CHECK_EQUAL_TEXT(counter, ours.counter, text);
        const bool is_known = content.distance < MILLFORCE_DISTANCE_NOT_KNOWN;
        DOUBLES_EQUAL_TEXT(is_known ? 1e-3 * content.distance : 0.0, static_cast<double>(ours.distance_to_go_mm), 2e-3,
                           text);
        ++count;
    }
    LONGS_EQUAL(5, count);
}

TEST(CncVectors, that_are_refused_are_refused_by_both_for_the_reason_that_they_name) {
    using Override = override_frame::FrameError;
    using Status = program_status::FrameError;
    const std::map<std::string, std::pair<Override, millforce_result>> override_reasons{
        {"length", {Override::length, millforce_wrong_length}},
        {"checksum", {Override::checksum, millforce_wrong_checksum}},
        {"reserved_bits", {Override::reserved_bits, millforce_reserved_bits}}};
    const std::map<std::string, std::pair<Status, millforce_result>> status_reasons{
        {"length", {Status::length, millforce_wrong_length}},
        {"checksum", {Status::checksum, millforce_wrong_checksum}},
        {"reserved_bits", {Status::reserved_bits, millforce_reserved_bits}}};
    int count = 0;
    for (const Words& words : cnc_vectors()) {
        if (!words[0].starts_with("refused_")) {
            continue;
        }
        const hal::CanFrame frame = frame_of(words, 2, 3);
        const millforce_can_frame c_frame = in_c(frame);
        if (words[0] == "refused_override") {
            hal::FeedOverride ours;
            millforce_override theirs{};
            CHECK(override_frame::decode(frame, frame.id, ours) == override_reasons.at(words[1]).first);
            CHECK_EQUAL(override_reasons.at(words[1]).second, c99_decode_override(&c_frame, frame.id, &theirs));
        } else if (words[0] == "refused_tool") {
            std::uint32_t number = 0;
            CHECK(program_status::decode_tool(frame, frame.id, number) == status_reasons.at(words[1]).first);
            CHECK_EQUAL(status_reasons.at(words[1]).second, c99_decode_tool(&c_frame, frame.id, &number));
        } else if (words[0] == "refused_speed") {
            std::uint32_t speed = 0;
            CHECK(program_status::decode_number(frame, frame.id, speed) == status_reasons.at(words[1]).first);
            CHECK_EQUAL(status_reasons.at(words[1]).second, c99_decode_speed(&c_frame, frame.id, &speed));
        } else if (words[0] == "refused_position") {
            program_status::ProgramPosition ours;
            millforce_position theirs{};
            std::uint32_t counter = 0;
            CHECK(program_status::decode_position(frame, frame.id, ours) == status_reasons.at(words[1]).first);
            CHECK_EQUAL(status_reasons.at(words[1]).second, c99_decode_position(&c_frame, frame.id, &theirs, &counter));
        } else {
            program_status::ProgramStatusFrame ours;
            millforce_program_status theirs{};
            std::uint32_t counter = 0;
            CHECK(program_status::decode(frame, frame.id, ours) == status_reasons.at(words[1]).first);
            CHECK_EQUAL(status_reasons.at(words[1]).second, c99_decode_status(&c_frame, frame.id, &theirs, &counter));
        }
        ++count;
    }
    LONGS_EQUAL(19, count);
}

TEST(CncVectors, of_sequences_lead_both_receivers_to_what_they_say) {
    Receivers receivers;
    std::string name;
    int sequences = 0;
    for (const Words& words : cnc_vectors()) {
        if (words[0] == "sequence") {
            receivers = Receivers();
            name = words[1];
            ++sequences;
        }
        if (words[0] != "at") {
            continue;
        }
        const std::uint32_t time_us = decimal(words[1]);
        const std::string text = name + " at " + words[1];
        if (words[2] == "frame") {
            const hal::CanFrame frame = frame_of(words, 3, 4);
            const millforce_can_frame c_frame = in_c(frame);
            receivers.ours.on_frame(frame, time_us);
            (void)c99_on_frame(&receivers.in_c99, &c_frame, time_us);
            continue;
        }
        const bool is_alive = words[3] == "alive";
        const std::uint32_t ratio = is_alive ? decimal(words[4]) : 0;
        const bool hold = !is_alive || words[5] == "1";
        const std::uint32_t state = is_alive ? decimal(words[6]) : 0;
        const std::uint32_t fault = is_alive ? decimal(words[7]) : 0;
        const override_frame::ReceivedOverride ours = receivers.ours.current(time_us);
        CHECK_EQUAL_TEXT(is_alive, ours.is_alive, text.c_str());
        CHECK_EQUAL_TEXT(hold, ours.hold, text.c_str());
        DOUBLES_EQUAL_TEXT(ratio_of(ratio), ours.ratio, 0.0, text.c_str());
        CHECK_TEXT(ours.state == state && ours.fault == fault, text.c_str());
        const millforce_received c99 = c99_now(&receivers.in_c99, time_us);
        CHECK_EQUAL_TEXT(is_alive, c99.is_alive, text.c_str());
        CHECK_EQUAL_TEXT(hold, c99.hold, text.c_str());
        CHECK_EQUAL_TEXT(ratio, c99.ratio, text.c_str());
        CHECK_TEXT(c99.state == state && c99.fault == fault, text.c_str());
    }
    LONGS_EQUAL(17, sequences);
}
