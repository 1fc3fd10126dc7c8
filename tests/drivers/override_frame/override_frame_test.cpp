// SPDX-License-Identifier: Apache-2.0
#include "override_frame/override_frame.hpp"

#include <array>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "override_frame/override_receiver.hpp"
#include "override_frame/override_sender.hpp"
#include "override_sender_settings.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::override_frame;

namespace {

hal::FeedOverride override_of(float ratio, std::uint32_t heartbeat) {
    return {ratio, false, 3, 0, heartbeat};
}

/// A controller that ticks every millisecond and a CNC that listens.
struct Link {
    OverrideSender sender{test::an_override_sender()};
    OverrideReceiver receiver{OverrideReceiverSettings{}};
    std::uint64_t now_us = 1'000'000;
    std::uint32_t heartbeat = 65'500;
    float ratio = 0.8F;
    bool ticks = true;
    std::function<bool(hal::CanFrame&)> passes = [](hal::CanFrame&) { return true; };
    std::vector<hal::CanFrame> sent{};

    void run_ms(int duration_ms) {
        for (int k = 0; k < duration_ms; ++k, now_us += 1000) {
            if (ticks) {
                sender.update(override_of(ratio, ++heartbeat), now_us);
            }
            sender.poll(now_us);
            hal::CanFrame frame;
            while (sender.take_frame(frame)) {
                sent.push_back(frame);
                if (passes(frame)) {
                    receiver.on_frame(frame, now_us);
                }
            }
        }
    }
    [[nodiscard]] ReceivedOverride received() const { return receiver.current(now_us); }
};

}  // namespace

TEST_GROUP(OverrideFrame){};

TEST(OverrideFrame, has_the_published_check_value_of_its_checksum) {
    const std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    UNSIGNED_LONGS_EQUAL(0xDF, crc8_2f(digits));
}

TEST(OverrideFrame, is_these_bytes) {
    const hal::CanFrame frame = encode({0.85F, true, 4, 2, 0xABCD1234}, default_id);
    UNSIGNED_LONGS_EQUAL(0x1FE, frame.id);
    const std::array<std::uint8_t, 7> expected{0x34, 0x21, 0x01, 0x04, 0x02, 0x34, 0x12};
    for (std::size_t k = 0; k < expected.size(); ++k) {
        UNSIGNED_LONGS_EQUAL(expected[k], frame.data[k]);
    }
}

TEST(OverrideFrame, comes_back_to_half_a_bit_over_its_whole_range) {
    for (int k = 0; k <= 65535; ++k) {
        const float ratio = static_cast<float>(k) * 0.0001F;
        hal::FeedOverride back;
        CHECK(decode(encode(override_of(ratio, 7), 0x321), 0x321, back) == FrameError::none);
        DOUBLES_EQUAL(ratio, back.ratio, 0.00005 + 1e-6);
    }
}

TEST(OverrideFrame, holds_where_the_ratio_is_no_number_and_saturates_where_it_is_too_large) {
    hal::FeedOverride back;
    for (const float ratio : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        CHECK(decode(encode(override_of(ratio, 1), default_id), default_id, back) == FrameError::none);
        DOUBLES_EQUAL(0.0, back.ratio, 0.0);
        CHECK(back.hold);
    }
    CHECK(decode(encode(override_of(1e9F, 1), default_id), default_id, back) == FrameError::none);
    DOUBLES_EQUAL(6.5535, back.ratio, 1e-4);
    CHECK(decode(encode(override_of(-1.0F, 1), default_id), default_id, back) == FrameError::none);
    DOUBLES_EQUAL(0.0, back.ratio, 0.0);
}

TEST(OverrideFrame, any_one_two_or_three_wrong_bits_are_found) {
    std::mt19937 random(9);
    hal::FeedOverride back;
    for (int k = 0; k < 200'000; ++k) {
        hal::CanFrame frame = encode(override_of(0.9F, static_cast<std::uint32_t>(k)), default_id);
        const hal::CanFrame good = frame;
        for (unsigned flips = 1 + static_cast<unsigned>(random() % 3); flips > 0; --flips) {
            const auto bit = static_cast<unsigned>(random() % 64);
            frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1U << (bit % 8)));
        }
        CHECK(frame.data == good.data || decode(frame, default_id, back) != FrameError::none);
    }
}

TEST(OverrideFrame, of_another_id_length_or_layout_is_refused) {
    hal::FeedOverride back;
    hal::CanFrame frame = encode(override_of(1.0F, 1), 0x1FD);
    CHECK(decode(frame, default_id, back) == FrameError::not_this_frame);
    frame.id = default_id;  // the same bytes under our id
    CHECK(decode(frame, default_id, back) == FrameError::checksum);
    frame = encode(override_of(1.0F, 1), default_id);
    frame.length = 7;
    CHECK(decode(frame, default_id, back) == FrameError::length);
}

TEST_GROUP(OverrideLink){};

TEST(OverrideLink, carries_the_override_at_its_rate_over_the_counter_s_wrap) {
    Link link;
    link.run_ms(100);
    CHECK(link.received().is_alive);
    DOUBLES_EQUAL(0.8, link.received().ratio, 1e-4);
    CHECK_FALSE(link.received().hold);
    int overrides = 0;
    for (const hal::CanFrame& frame : link.sent) {
        overrides += frame.id == default_id ? 1 : 0;
    }
    LONGS_EQUAL(50, overrides);
    UNSIGNED_LONGS_EQUAL(0, link.receiver.errors(ReceiveError::counter_jump));
}

TEST(OverrideLink, a_hold_goes_out_at_once) {
    Link link;
    link.run_ms(10);
    hal::CanFrame frame;
    link.sender.update({0.8F, true, 3, 0, ++link.heartbeat}, link.now_us);
    CHECK(link.sender.take_frame(frame));
    link.receiver.on_frame(frame, link.now_us);
    CHECK(link.received().hold);
}

TEST(OverrideLink, a_tick_that_stands_still_is_a_hold_although_frames_go_on) {
    Link link;
    link.run_ms(50);
    link.ticks = false;
    link.run_ms(25);
    CHECK_FALSE(link.received().is_alive);
    CHECK(link.received().hold);
    CHECK(link.receiver.errors(ReceiveError::counter_repeated) > 5);
    UNSIGNED_LONGS_EQUAL(0x04, link.sent.back().id == 0x77E ? link.sent.back().data[0] : 0x04);
    link.ticks = true;
    link.run_ms(20);
    CHECK(link.received().is_alive);
}

TEST(OverrideLink, silence_is_a_hold_and_ends_after_three_fresh_frames) {
    Link link;
    link.run_ms(50);
    link.passes = [](hal::CanFrame&) { return false; };
    link.run_ms(17);
    CHECK(link.received().is_alive);
    link.run_ms(5);
    CHECK_FALSE(link.received().is_alive);
    link.passes = [](hal::CanFrame&) { return true; };
    link.run_ms(3);
    CHECK_FALSE(link.received().is_alive);
    link.run_ms(4);
    CHECK(link.received().is_alive);
}

TEST(OverrideLink, a_replayed_or_reordered_frame_is_not_used) {
    Link link;
    link.run_ms(50);
    link.receiver.on_frame(link.sent.back(), link.now_us);
    UNSIGNED_LONGS_EQUAL(1, link.receiver.errors(ReceiveError::counter_repeated));
    link.receiver.on_frame(encode(override_of(1.9F, link.heartbeat - 40), default_id), link.now_us);
    UNSIGNED_LONGS_EQUAL(1, link.receiver.errors(ReceiveError::counter_jump));
    CHECK_FALSE(link.received().is_alive);
}

TEST(OverrideLink, a_ratio_beyond_what_the_cnc_allows_is_not_used) {
    Link link;
    link.run_ms(50);
    link.ratio = 3.0F;
    link.run_ms(10);
    DOUBLES_EQUAL(0.8, link.received().ratio, 1e-4);
    link.run_ms(20);
    CHECK_FALSE(link.received().is_alive);
    CHECK(link.receiver.errors(ReceiveError::ratio_range) > 0);
}

TEST(OverrideLink, a_heartbeat_that_says_stopped_ends_the_trust_at_once) {
    Link link;
    link.run_ms(50);
    hal::CanFrame stopped;
    stopped.id = 0x77E;
    stopped.length = 1;
    stopped.data[0] = 0x04;
    link.receiver.on_frame(stopped, link.now_us);
    CHECK_FALSE(link.received().is_alive);
}

TEST(OverrideLink, boots_as_a_canopen_node_does) {
    OverrideSender sender{test::an_override_sender()};
    hal::CanFrame frame;
    sender.poll(0);
    CHECK(sender.take_frame(frame));
    UNSIGNED_LONGS_EQUAL(0x77E, frame.id);
    UNSIGNED_LONGS_EQUAL(0x00, frame.data[0]);
    CHECK(sender.take_frame(frame));
    UNSIGNED_LONGS_EQUAL(0x7F, frame.data[0]);
    CHECK_FALSE(sender.take_frame(frame));
}

TEST(OverrideLink, fuzz_is_never_trusted) {
    std::mt19937 random(13);
    OverrideReceiver receiver{OverrideReceiverSettings{}};
    int alive = 0;
    for (std::uint64_t now_us = 0; now_us < 2'000'000'000; now_us += 1000) {
        hal::CanFrame frame;
        frame.id = random() % 8 == 0 ? 0x77E : default_id;
        frame.length = static_cast<std::uint8_t>(random() % 4 == 0 ? random() % 256 : 8);
        for (std::uint8_t& byte : frame.data) {
            byte = static_cast<std::uint8_t>(random());
        }
        frame.data[2] &= 1U;
        receiver.on_frame(frame, now_us);
        const ReceivedOverride now = receiver.current(now_us);
        alive += now.is_alive ? 1 : 0;
        CHECK(now.ratio >= 0.0F && now.ratio <= 2.0F);
    }
    LONGS_EQUAL(0, alive);
}
