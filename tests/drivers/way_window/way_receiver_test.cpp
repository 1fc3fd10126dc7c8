// SPDX-License-Identifier: Apache-2.0
#include "way_window/way_receiver.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <vector>

using namespace millforce;
using namespace millforce::way_window;

namespace {

constexpr std::uint8_t node = 0x7E;
constexpr std::uint32_t tool = 0x1234'5678;

hal::CanFrame frame_of(const WayFrame& frame) {
    return encode(frame, way_frame_id(node));
}

template <typename Record>
std::vector<hal::CanFrame> frames_of(const Record& record, WayFrameKind kind, std::uint8_t number,
                                     std::uint8_t session = 1) {
    std::vector<hal::CanFrame> frames;
    const auto bytes = bytes_of(record);
    WayFrame frame{number, static_cast<std::uint8_t>(kind), session, {}};
    for (std::size_t place = 0; place < bytes.size(); place += payload_bytes) {
        for (std::size_t k = 0; k < payload_bytes; ++k) {
            frame.payload[k] = bytes[place + k];
        }
        frames.push_back(frame_of(frame));
        ++frame.kind;
    }
    return frames;
}

std::vector<hal::CanFrame> stretch_at(std::uint32_t begin_um, std::uint8_t number, std::uint8_t session = 1) {
    return frames_of(StretchRecord{.begin_um = begin_um}, WayFrameKind::stretch, number, session);
}

}  // namespace

TEST_GROUP(WayReceiver) {
    WayReceiver receiver{node, tool};

    NextRecord give(const std::vector<hal::CanFrame>& frames) {
        for (const hal::CanFrame& frame : frames) {
            (void)receiver.on_frame(frame);
        }
        return receiver.take_record();
    }
    WayEvent hear(const WayFrame& frame) {
        return receiver.on_frame(frame_of(frame));
    }
    void begin(std::uint8_t session = 1) {
        CHECK(hear(begin_frame(session, 0, tool)) == WayEvent::begun);
    }
    void expect(std::uint16_t number) {
        UNSIGNED_LONGS_EQUAL(number, receiver.answer().expected);
    }
};

TEST(WayReceiver, takes_records_in_their_order) {
    begin();
    CHECK(give(stretch_at(5000, 0)) == NextRecord::stretch);
    UNSIGNED_LONGS_EQUAL(5000, receiver.stretch().begin_um);
    CHECK(give(frames_of(BlockRecord{7, 9000, 4000}, WayFrameKind::block, 1)) == NextRecord::block);
    CHECK((receiver.block() == BlockRecord{7, 9000, 4000}));
    expect(2);
}

TEST(WayReceiver, takes_nothing_before_a_session) {
    CHECK(give(stretch_at(5000, 0)) == NextRecord::none);
    CHECK(receiver.answer().state == WayState::waits);
}

TEST(WayReceiver, takes_a_doubled_frame_once) {
    begin();
    for (std::uint8_t number = 0; number < 3; ++number) {
        int taken = 0;
        for (const hal::CanFrame& frame : stretch_at(number, number)) {
            taken += give({frame, frame}) == NextRecord::stretch ? 1 : 0;
        }
        LONGS_EQUAL(1, taken);
        CHECK(give(stretch_at(number, number)) == NextRecord::none);
    }
    expect(3);
}

TEST(WayReceiver, a_lost_frame_leaves_the_record_to_be_sent_again) {
    begin();
    for (std::uint8_t number = 0; number < stretch_frames; ++number) {
        std::vector<hal::CanFrame> lost = stretch_at(number, number);
        lost.erase(lost.begin() + number);
        CHECK(give(lost) == NextRecord::none);
        expect(number);
        CHECK(give({stretch_at(number, number)[number]}) == NextRecord::stretch);
        UNSIGNED_LONGS_EQUAL(number, receiver.stretch().begin_um);
    }
}

TEST(WayReceiver, records_that_overtake_a_lost_one_wait_for_it_up_to_eight_in_all) {
    begin();
    for (std::uint8_t number = 12; number > 0; --number) {
        CHECK(give(stretch_at(number, number)) == NextRecord::none);
    }
    CHECK(give(stretch_at(0, 0)) == NextRecord::stretch);
    for (std::uint8_t number = 1; number < 8; ++number) {
        CHECK(receiver.take_record() == NextRecord::stretch);
        UNSIGNED_LONGS_EQUAL(number, receiver.stretch().begin_um);
    }
    CHECK(receiver.take_record() == NextRecord::none);
    expect(8);
}

TEST(WayReceiver, frames_of_a_record_may_overtake_each_other) {
    begin();
    std::vector<hal::CanFrame> frames = stretch_at(0xABCD'EF01, 0);
    std::reverse(frames.begin(), frames.end());
    CHECK(give(frames) == NextRecord::stretch);
    UNSIGNED_LONGS_EQUAL(0xABCD'EF01, receiver.stretch().begin_um);
}

TEST(WayReceiver, frames_of_two_records_make_none) {
    begin();
    std::vector<hal::CanFrame> mixed = stretch_at(1, 0);
    mixed[2] = stretch_at(1, 1)[2];
    CHECK(give(mixed) == NextRecord::none);
    mixed = stretch_at(1, 0);
    mixed[1] = frames_of(BlockRecord{7, 9000, 4000}, WayFrameKind::block, 0)[1];
    CHECK(give(mixed) == NextRecord::none);
    expect(0);
}

TEST(WayReceiver, frames_of_another_session_are_not_taken) {
    begin(1);
    begin(2);
    CHECK(give(stretch_at(1, 0, 1)) == NextRecord::none);
    CHECK(give(stretch_at(1, 0, 2)) == NextRecord::stretch);
    CHECK(hear(begin_frame(2, 0, tool)) == WayEvent::nothing);  // the same frame once more
    expect(1);
}

TEST(WayReceiver, refuses_another_tool_or_layout_until_a_session_that_fits) {
    CHECK(hear(begin_frame(1, 0, tool + 1)) == WayEvent::begun);
    CHECK(receiver.answer().state == WayState::other_tool);
    CHECK(give(stretch_at(1, 0)) == NextRecord::none);
    WayFrame of_tomorrow = begin_frame(2, 0, tool);
    ++of_tomorrow.payload.back();
    (void)hear(of_tomorrow);
    CHECK(receiver.answer().state == WayState::other_layout);
    begin(3);
    CHECK(give(stretch_at(1, 0, 3)) == NextRecord::stretch);
}

TEST(WayReceiver, a_record_out_of_its_range_ends_the_session) {
    begin();
    CHECK(give(stretch_at(1, 0)) == NextRecord::stretch);
    CHECK(give(frames_of(StretchRecord{.begin_um = 9, .feed_um_s = 0}, WayFrameKind::stretch, 1)) == NextRecord::none);
    CHECK(receiver.answer().state == WayState::unsound_record);
    CHECK_FALSE(receiver.has_session());
    CHECK(give(stretch_at(9, 1)) == NextRecord::none);
}

TEST(WayReceiver, numbers_go_on_over_their_end) {
    begin();
    for (std::uint32_t k = 0; k < 70'000; ++k) {
        CHECK(give(frames_of(BlockRecord{7, 9000, 4000}, WayFrameKind::block, static_cast<std::uint8_t>(k))) ==
              NextRecord::block);
    }
    expect(static_cast<std::uint16_t>(70'000));
}

TEST(WayReceiver, an_ask_gets_its_number_and_the_digest_of_what_was_taken) {
    begin();
    give(stretch_at(5000, 0));
    CHECK(hear({99, static_cast<std::uint8_t>(WayFrameKind::ask), 1, {}}) == WayEvent::asked);
    const WayAnswer answer = receiver.answer();
    UNSIGNED_LONGS_EQUAL(99, answer.ask);
    UNSIGNED_LONGS_EQUAL(1, answer.session);
    UNSIGNED_LONGS_EQUAL(digest(0, bytes_of(StretchRecord{.begin_um = 5000})), answer.digest);
}

TEST(WayReceiver, another_tool_in_the_spindle_ends_the_session) {
    begin();
    receiver.set_tool(tool + 1);
    CHECK(receiver.answer().state == WayState::waits);
    CHECK(give(stretch_at(1, 0)) == NextRecord::none);
}
