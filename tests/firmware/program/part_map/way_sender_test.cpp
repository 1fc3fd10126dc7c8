// SPDX-License-Identifier: Apache-2.0
#include "part_map/way_sender.hpp"

#include "files/input_error.hpp"
#include "firmware/tool_checksum.hpp"
#include "override_frame/override_frame.hpp"
#include "parameters/parameter_files.hpp"
#include "way_window/way_receiver.hpp"

#include <CppUTest/TestHarness.h>

#include <deque>
#include <limits>
#include <string>
#include <utility>

using namespace millforce;
using namespace millforce::host;
using way_window::BlockRecord;
using way_window::NextRecord;
using way_window::StretchRecord;
using way_window::WayEvent;

namespace {

constexpr std::uint8_t node = override_frame::default_node_id;
constexpr std::uint32_t position_id = program_status::position_frame_id(program_status::default_id);

const firmware::Parameters<float>& parameters() {
    static const firmware::Parameters<float> read =
        read_parameters(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/machines/vmc.toml",
                        std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/tools/endmill_10mm.toml");
    return read;
}

/// Blocks of 10 mm in air, each a line and each faster than the last, so that each is a stretch of its own.
PartMap staircase(int blocks) {
    PartMap map;
    for (int k = 0; k <= blocks; ++k) {
        MapPlace place;
        place.path_mm = 10.0 * k;
        place.block_end_mm = 10.0 * (k < blocks ? k + 1 : k);
        place.line = static_cast<std::size_t>(k < blocks ? k + 1 : k);
        place.programmed_feed_mm_s = 10.0 + (k % 2 == 0 ? 10.0 : 0.0);
        place.spindle_speed_rad_s = 400.0;
        map.push_back(place);
    }
    return map;
}

/// Short blocks of one cut.
PartMap fine(int blocks) {
    PartMap map = staircase(blocks);
    for (MapPlace& place : map) {
        place.programmed_feed_mm_s = 10.0;
    }
    return map;
}

control::Stretch<float> stretch(float tangential_N) {
    control::Stretch<float> made;
    made.begin_mm = 12.5F;
    made.feed_mm_s = 20.0F;
    made.tangential_N = tangential_N;
    made.tooth_per_tangential = 2.5F;
    made.feed_per_tangential = -0.25F;
    return made;
}

}  // namespace

TEST_GROUP(WayRecords){};

TEST(WayRecords, a_block_comes_before_the_stretch_that_begins_in_it) {
    const std::vector<WayRecord> records = way_records(staircase(2), parameters());
    UNSIGNED_LONGS_EQUAL(5, records.size());  // two blocks, two stretches and the end
    CHECK((std::get<BlockRecord>(records[0]) == BlockRecord{1, 10'000, 10'000}));
    UNSIGNED_LONGS_EQUAL(0, std::get<StretchRecord>(records[1]).begin_um);
    CHECK((std::get<BlockRecord>(records[2]) == BlockRecord{2, 20'000, 10'000}));
    UNSIGNED_LONGS_EQUAL(10'000, std::get<StretchRecord>(records[3]).begin_um);
    UNSIGNED_LONGS_EQUAL(20'000, std::get<StretchRecord>(records[4]).begin_um);
}

TEST(WayRecords, a_stretch_over_many_blocks_is_repeated) {
    int blocks_in_a_row = 0;
    int longest = 0;
    for (const WayRecord& record : way_records(fine(100), parameters())) {
        blocks_in_a_row = std::holds_alternative<BlockRecord>(record) ? blocks_in_a_row + 1 : 0;
        longest = std::max(longest, blocks_in_a_row);
    }
    LONGS_EQUAL(16, longest);
}

TEST(WayRecords, a_stretch_goes_with_its_digits_or_as_not_known) {
    const StretchRecord record = record_of(stretch(123.4567F));
    UNSIGNED_LONGS_EQUAL(12'500, record.begin_um);
    UNSIGNED_LONGS_EQUAL(20'000, record.feed_um_s);
    UNSIGNED_LONGS_EQUAL(123'457, record.tangential_mN);
    UNSIGNED_LONGS_EQUAL(25'000, record.tooth_per_tangential_e4);
    LONGS_EQUAL(-250, record.feed_per_tangential_e3);
    UNSIGNED_LONGS_EQUAL(100, record.least_share_percent);
    for (const float force_N : {17'000.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
        const StretchRecord refused = record_of(stretch(force_N));
        UNSIGNED_LONGS_EQUAL(StretchRecord::unknown_percent, refused.least_share_percent);
        CHECK(is_sound(refused));
        UNSIGNED_LONGS_EQUAL(12'500, refused.begin_um);
    }
}

TEST(WayRecords, a_path_that_is_too_long_is_refused) {
    PartMap map = staircase(2);
    map.back().path_mm = map.back().block_end_mm = 4.3e6;
    CHECK_THROWS(InputError, static_cast<void>(way_records(map, parameters())));
}

TEST_GROUP(WaySender) {
    static constexpr std::uint64_t ms = 1000;

    WaySender sender{{.node_id = node, .position_id = position_id}, staircase(200), parameters()};
    way_window::WayReceiver controller{node, firmware::tool_checksum(parameters().tool)};
    std::uint64_t now_us = 1'000'000;
    std::uint8_t counter = 0;
    std::size_t room = 64;
    std::uint32_t first_line = 0;  // of the session
    bool changes_a_byte = false;
    std::uint64_t delay_us = 0;
    std::deque<std::pair<std::uint64_t, hal::CanFrame>> answers{};

    void run_ms(int duration_ms) {
        for (int k = 0; k < duration_ms; ++k) {
            now_us += ms;
            sender.poll(now_us);
            hal::CanFrame frame;
            while (sender.take_frame(frame)) {
                hear(changed(frame));
            }
            while (!answers.empty() && answers.front().first <= now_us) {
                sender.on_frame(answers.front().second, now_us);
                answers.pop_front();
            }
        }
    }
    void hear(const hal::CanFrame& frame) {
        const WayEvent event = controller.on_frame(frame);
        if (event == WayEvent::begun) {
            room = 64;
            first_line = 0;
        }
        auto record = NextRecord::none;
        while (room > 0 && (record = controller.take_record()) != NextRecord::none) {
            --room;
            first_line = record == NextRecord::block && first_line == 0 ? controller.block().line : first_line;
        }
        if (event == WayEvent::asked) {
            way_window::WayAnswer answer = controller.answer();
            answer.room = static_cast<std::uint8_t>(room);
            answers.emplace_back(now_us + delay_us, encode(answer, way_window::way_answer_id(node)));
        }
    }
    hal::CanFrame changed(const hal::CanFrame& frame) {
        way_window::WayFrame way_frame;
        const std::uint32_t id = way_window::way_frame_id(node);
        CHECK(decode(frame, id, way_frame) == way_window::FrameError::none);
        if (!changes_a_byte || way_frame.kind != 1) {
            return frame;
        }
        changes_a_byte = false;
        ++way_frame.payload[0];
        return encode(way_frame, id);
    }
    void report(double path_mm) {
        const auto line = static_cast<std::uint32_t>(path_mm / 10.0) + 1;
        for (int k = 0; k < 10; ++k) {
            const auto to_go_mm = static_cast<float>(10.0 * line - path_mm);
            sender.on_frame(program_status::encode_position({line, to_go_mm, ++counter}, position_id), now_us);
            run_ms(10);
        }
    }
};

TEST(WaySender, fills_the_window_and_no_more) {
    run_ms(1000);
    UNSIGNED_LONGS_EQUAL(0, room);
    UNSIGNED_LONGS_EQUAL(64, controller.answer().expected);
    UNSIGNED_LONGS_EQUAL(1, first_line);
    UNSIGNED_LONGS_EQUAL(1, sender.sessions());
    CHECK(sender.controller_state(now_us) == way_window::WayState::takes);
    room = 10;
    run_ms(200);
    UNSIGNED_LONGS_EQUAL(74, controller.answer().expected);
}

TEST(WaySender, sends_one_frame_in_a_period) {
    int frames = 0;
    for (int k = 0; k < 100; ++k) {
        now_us += ms;
        sender.poll(now_us);
        hal::CanFrame frame;
        while (sender.take_frame(frame)) {
            ++frames;
            hear(frame);
        }
    }
    CHECK(frames <= 104);
}

TEST(WaySender, begins_where_the_tool_is_when_the_controller_starts_anew) {
    run_ms(500);
    report(1503.0);
    controller.forget();
    run_ms(200);
    CHECK(sender.sessions() > 1);
    UNSIGNED_LONGS_EQUAL(150, first_line);  // 5 mm behind the tool
    CHECK(controller.has_session());
}

TEST(WaySender, begins_where_the_tool_is_when_it_has_left_the_window_behind) {
    run_ms(500);
    report(1503.0);
    run_ms(200);
    UNSIGNED_LONGS_EQUAL(150, first_line);
}

TEST(WaySender, another_run_begins_where_the_program_does) {
    report(103.0);
    const std::uint8_t run = controller.run();
    report(3.0);
    UNSIGNED_LONGS_EQUAL(run + 1, controller.run());
    UNSIGNED_LONGS_EQUAL(1, first_line);
}

TEST(WaySender, a_controller_that_has_taken_something_else_gets_all_again) {
    run_ms(50);
    const std::uint32_t sessions = sender.sessions();
    way_window::WayFrame begin = way_window::begin_frame(9, 0, firmware::tool_checksum(parameters().tool));
    hear(encode(begin, way_window::way_frame_id(node)));  // of another sender
    run_ms(50);
    CHECK(sender.sessions() > sessions);
    run_ms(1000);
    UNSIGNED_LONGS_EQUAL(64, controller.answer().expected);
}

TEST(WaySender, a_wrong_byte_that_no_checksum_has_shown_is_found_by_the_digest) {
    run_ms(100);
    changes_a_byte = true;
    run_ms(100);
    CHECK_FALSE(changes_a_byte);
    UNSIGNED_LONGS_EQUAL(2, sender.sessions());
    run_ms(1000);
    UNSIGNED_LONGS_EQUAL(2, sender.sessions());
    UNSIGNED_LONGS_EQUAL(64, controller.answer().expected);
}

TEST(WaySender, answers_may_be_a_fifth_of_a_second_late) {
    delay_us = 200'000;
    run_ms(3000);
    UNSIGNED_LONGS_EQUAL(1, sender.sessions());
    UNSIGNED_LONGS_EQUAL(64, controller.answer().expected);
}

TEST(WaySender, a_controller_of_another_tool_is_asked_again_each_second) {
    controller.set_tool(1);
    run_ms(500);
    CHECK(sender.controller_state(now_us) == way_window::WayState::other_tool);
    UNSIGNED_LONGS_EQUAL(1, sender.sessions());
    controller.set_tool(firmware::tool_checksum(parameters().tool));
    run_ms(1500);
    CHECK(sender.controller_state(now_us) == way_window::WayState::takes);
    UNSIGNED_LONGS_EQUAL(64, controller.answer().expected);
}

TEST(WaySender, without_a_controller_the_bus_carries_asks_alone) {
    int frames = 0;
    for (int k = 0; k < 2000; ++k) {
        now_us += ms;
        sender.poll(now_us);
        hal::CanFrame frame;
        while (sender.take_frame(frame)) {
            ++frames;
        }
    }
    CHECK(frames < 250);
}

TEST(WaySender, a_silent_controller_is_named_so) {
    run_ms(100);
    CHECK(sender.controller_state(now_us) == way_window::WayState::takes);
    CHECK_FALSE(sender.controller_state(now_us + 1'000'000).has_value());
}
