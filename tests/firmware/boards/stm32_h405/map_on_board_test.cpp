// SPDX-License-Identifier: Apache-2.0
#include "firmware/boards/stm32_h405/board_bench.hpp"
#include "firmware/tool_checksum.hpp"
#include "way_window/way_frames.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::way_window;

namespace {

constexpr std::uint8_t node = override_frame::default_node_id;

}  // namespace

TEST_GROUP(MapOnBoard) {
    BoardBench board;

    void tell(const WayFrame& frame) {
        board.tell(encode(frame, way_frame_id(node)));
        board.run(1);
    }
    void begin(std::uint8_t session, std::uint32_t tool_checksum) {
        tell(begin_frame(session, 0, tool_checksum));
    }
    std::optional<WayAnswer> asked() {
        board.frames.clear();
        tell({5, static_cast<std::uint8_t>(WayFrameKind::ask), 1, {}});
        board.run(2);
        std::optional<WayAnswer> found;
        for (const hal::CanFrame& frame : board.frames) {
            WayAnswer answer;
            if (decode(frame, way_answer_id(node), answer) == FrameError::none) {
                found = answer;
            }
        }
        return found;
    }
    void give(const StretchRecord& record, std::uint8_t number) {
        const StretchBytes bytes = bytes_of(record);
        for (std::uint8_t part = 0; part < stretch_frames; ++part) {
            WayFrame frame{number, part, 1, {}};
            std::copy_n(bytes.begin() + part * static_cast<int>(payload_bytes), payload_bytes, frame.payload.begin());
            tell(frame);
        }
    }
};

TEST(MapOnBoard, the_chip_takes_records_and_answers_an_ask) {
    board.run(10);
    begin(1, firmware::tool_checksum(board.parameters.tool));
    give({.begin_um = 0, .feed_um_s = 20'000}, 0);
    give({.begin_um = 5000, .feed_um_s = 10'000}, 1);
    const auto answer = asked();
    CHECK(answer.has_value());
    CHECK(answer->state == WayState::takes);
    UNSIGNED_LONGS_EQUAL(5, answer->ask);
    UNSIGNED_LONGS_EQUAL(2, answer->expected);
    UNSIGNED_LONGS_EQUAL(62, answer->room);
}

TEST(MapOnBoard, a_map_of_another_tool_is_refused) {
    board.run(10);
    begin(1, firmware::tool_checksum(board.parameters.tool) + 1);
    const auto answer = asked();
    CHECK(answer.has_value());
    CHECK(answer->state == WayState::other_tool);
}

TEST(MapOnBoard, the_chip_says_nothing_of_a_map_until_it_is_asked) {
    board.run(10);
    begin(1, firmware::tool_checksum(board.parameters.tool));
    board.run(50);
    for (const hal::CanFrame& frame : board.frames) {
        CHECK(frame.id != way_answer_id(node));
    }
}
