// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <random>
#include <string>

#include "program_status/program_status_frame.hpp"
#include "program_status/program_status_receiver.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::program_status;

namespace {

constexpr ProgramStatusReceiverSettings settings{.id = default_id, .timeout_us = 100'000};

ProgramStatusFrame status_of(float feed_mm_min, std::uint16_t counter, bool reset = false) {
    ProgramStatusFrame status;
    status.program.programmed_feed_mm_s = feed_mm_min / 60.0F;
    status.counter = counter;
    status.reset_fault = reset;
    return status;
}

hal::CanFrame frame_of(float feed_mm_min, std::uint16_t counter, bool reset = false) {
    return encode(status_of(feed_mm_min, counter, reset), default_id);
}

}  // namespace

TEST_GROUP(ProgramStatus){};

TEST(ProgramStatus, every_field_comes_back_to_half_a_step) {
    for (const float feed_mm_min : {0.0F, 0.01F, 37.5F, 1500.0F, 60000.0F, 167000.0F}) {
        ProgramStatusFrame sent = status_of(feed_mm_min, 0xBEEF, true);
        sent.program.operator_override = 0.7F;
        sent.program.rapid = true;
        ProgramStatusFrame got;
        CHECK(decode(encode(sent, default_id), default_id, got) == FrameError::none);
        DOUBLES_EQUAL(static_cast<double>(feed_mm_min) / 60.0, static_cast<double>(got.program.programmed_feed_mm_s),
                      0.0002 + 1e-6 * static_cast<double>(feed_mm_min));
        DOUBLES_EQUAL(0.7, got.program.operator_override, 1e-6);
        CHECK(got.program.rapid);
        CHECK_FALSE(got.program.feed_hold);
        CHECK(got.reset_fault);
        UNSIGNED_LONGS_EQUAL(0xBEEF, got.counter);
    }
}

TEST(ProgramStatus, what_no_field_can_hold_saturates_and_what_is_no_number_is_zero) {
    ProgramStatusFrame sent;
    sent.program.programmed_feed_mm_s = 1e9F;
    sent.program.operator_override = std::numeric_limits<float>::quiet_NaN();
    ProgramStatusFrame got;
    CHECK(decode(encode(sent, default_id), default_id, got) == FrameError::none);
    DOUBLES_EQUAL(167772.15 / 60.0, got.program.programmed_feed_mm_s, 0.01);
    DOUBLES_EQUAL(0.0, got.program.operator_override, 0.0);
}

TEST(ProgramStatus, a_frame_that_is_not_sound_is_refused_by_reason) {
    ProgramStatusFrame got;
    hal::CanFrame frame = frame_of(1500, 1);
    CHECK(decode(frame, 0x1FC, got) == FrameError::not_this_frame);
    frame.length = 7;
    CHECK(decode(frame, default_id, got) == FrameError::length);
    for (unsigned bit = 0; bit < 64; ++bit) {
        frame = frame_of(1500, 1);
        frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1U << (bit % 8)));
        CHECK(decode(frame, default_id, got) == FrameError::checksum);
    }
    // The id stands in the checksum.
    frame = encode(status_of(1500, 1), 0x1FC);
    frame.id = default_id;
    CHECK(decode(frame, default_id, got) == FrameError::checksum);
}

TEST(ProgramStatus, is_not_known_before_the_first_frame_and_held_after_the_last) {
    ProgramStatusReceiver receiver(settings);
    CHECK(receiver.source(0) == ProgramSource::never_heard);
    DOUBLES_EQUAL(0.0, receiver.program(0).programmed_feed_mm_s, 0.0);
    CHECK(receiver.on_frame(frame_of(1500, 1), 1'000'000));
    CHECK(receiver.source(1'100'000) == ProgramSource::fresh);
    CHECK_FALSE(receiver.program(1'100'000).feed_hold);
    CHECK(receiver.source(1'100'001) == ProgramSource::silent);
    CHECK(receiver.program(1'100'001).feed_hold);
    DOUBLES_EQUAL(25.0, receiver.program(1'100'001).programmed_feed_mm_s, 1e-4);
}

TEST(ProgramStatus, a_counter_that_stands_still_or_goes_back_is_no_sign_of_life) {
    ProgramStatusReceiver receiver(settings);
    CHECK(receiver.on_frame(frame_of(1500, 65535), 0));
    CHECK(receiver.on_frame(frame_of(1400, 0), 10'000));
    CHECK_FALSE(receiver.on_frame(frame_of(1300, 0), 20'000));
    CHECK_FALSE(receiver.on_frame(frame_of(1300, 65530), 30'000));
    UNSIGNED_LONGS_EQUAL(1, receiver.errors(ReceiveError::counter_repeated));
    UNSIGNED_LONGS_EQUAL(1, receiver.errors(ReceiveError::counter_backwards));
    CHECK(receiver.source(111'000) == ProgramSource::silent);
    // After a silence it may have started anew.
    CHECK(receiver.on_frame(frame_of(1200, 0), 200'000));
    DOUBLES_EQUAL(20.0, receiver.program(200'000).programmed_feed_mm_s, 1e-4);
}

TEST(ProgramStatus, a_reset_is_asked_once_per_press) {
    ProgramStatusReceiver receiver(settings);
    CHECK(receiver.on_frame(frame_of(1500, 1, true), 0));  // pressed before we heard of it: no press
    CHECK_FALSE(receiver.take_reset());
    CHECK(receiver.on_frame(frame_of(1500, 2, false), 1));
    CHECK(receiver.on_frame(frame_of(1500, 3, true), 2));
    CHECK(receiver.on_frame(frame_of(1500, 4, true), 3));
    CHECK(receiver.take_reset());
    CHECK_FALSE(receiver.take_reset());
}

TEST(ProgramStatus, random_frames_are_refused_or_within_their_ranges) {
    std::mt19937 random(5);
    ProgramStatusReceiver receiver(settings);
    std::uint64_t taken = 0;
    for (std::uint64_t k = 0; k < 300'000; ++k) {
        hal::CanFrame frame;
        frame.id = default_id;
        frame.length = static_cast<std::uint8_t>(random() % 4 == 0 ? random() % 16 : 8);
        for (std::uint8_t& byte : frame.data) {
            byte = static_cast<std::uint8_t>(random());
        }
        taken += receiver.on_frame(frame, k) ? 1U : 0U;
        const hal::ProgramStatus program = receiver.program(k);
        CHECK(program.programmed_feed_mm_s >= 0.0F && program.programmed_feed_mm_s < 2800.0F);
        CHECK(program.operator_override >= 0.0F && program.operator_override <= 2.55F);
    }
    CHECK(taken < 300);  // of 256 checksums one fits, of 32 flag bytes one
    UNSIGNED_LONGS_EQUAL(
        300'000, taken + receiver.errors(ReceiveError::length) + receiver.errors(ReceiveError::checksum) +
                     receiver.errors(ReceiveError::reserved_bits) + receiver.errors(ReceiveError::counter_repeated) +
                     receiver.errors(ReceiveError::counter_backwards));
}
