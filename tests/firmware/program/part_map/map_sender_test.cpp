// SPDX-License-Identifier: Apache-2.0
#include "part_map/map_sender.hpp"

#include "firmware/tool_checksum.hpp"
#include "override_frame/override_frame.hpp"
#include "parameters/parameter_files.hpp"
#include "way_window/way_receiver.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

using namespace millforce;
using namespace millforce::host;
using way_window::WayState;

namespace {

constexpr std::uint8_t node = override_frame::default_node_id;
constexpr std::uint32_t status_id = program_status::default_id;
constexpr std::uint32_t position_id = program_status::position_frame_id(status_id);

firmware::Parameters<float> parameters_with(float tooth_force_limit_N) {
    firmware::Parameters<float> parameters =
        read_parameters(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/machines/vmc.toml",
                        std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/tools/endmill_10mm.toml");
    parameters.tool.tooth_force_limit_N = tooth_force_limit_N;
    return parameters;
}

/// Blocks of 10 mm in air, one in each line.
PartMap air(std::size_t blocks) {
    PartMap map(blocks + 1);
    for (std::size_t k = 0; k < map.size(); ++k) {
        const bool is_end = k == blocks;
        map[k].path_mm = 10.0 * static_cast<double>(k);
        map[k].block_end_mm = map[k].path_mm + (is_end ? 0.0 : 10.0);
        map[k].line = is_end ? k : k + 1;
        map[k].programmed_feed_mm_s = k % 2 == 0 ? 10.0 : 20.0;
        map[k].spindle_speed_rad_s = 400.0;
    }
    return map;
}

}  // namespace

/// A chip beside the sender: it has the tool that it was told.
TEST_GROUP(MapSender) {
    const firmware::Parameters<float> seven = parameters_with(700.0F);
    const firmware::Parameters<float> twelve = parameters_with(500.0F);
    MapSender sender{{.node_id = node, .position_id = position_id}, status_id};
    way_window::WayReceiver chip{node, firmware::tool_checksum(seven.tool)};
    std::uint64_t now_us = 1'000'000;
    std::uint32_t tool = 0;  // that the CNC tells
    int frames = 0;

    void run_ms(int duration_ms) {
        for (int k = 0; k < duration_ms; ++k) {
            now_us += 1000;
            if (k % 100 == 0) {
                sender.on_frame(program_status::encode_tool(tool, program_status::tool_frame_id(status_id)), now_us);
            }
            sender.poll(now_us);
            hal::CanFrame frame;
            while (sender.take_frame(frame)) {
                ++frames;
                hear(frame);
            }
        }
    }
    void hear(const hal::CanFrame& frame) {
        const bool is_asked = chip.on_frame(frame) == way_window::WayEvent::asked;
        while (chip.take_record() != way_window::NextRecord::none) {
        }
        if (is_asked) {
            way_window::WayAnswer answer = chip.answer();
            answer.room = way_window::largest_window;
            sender.on_frame(encode(answer, way_window::way_answer_id(node)), now_us);
        }
    }
    void change_tool(std::uint32_t number, const firmware::Parameters<float>& parameters) {
        tool = number;
        chip.set_tool(firmware::tool_checksum(parameters.tool));
        chip.forget();
    }
    [[nodiscard]] bool chip_takes_all_of(std::uint16_t records) const {
        return chip.answer().state == WayState::takes && chip.answer().expected == records;
    }
};

TEST(MapSender, hands_over_the_map_of_the_tool_in_the_spindle_and_again_when_it_comes_back) {
    CHECK(sender.add(7, air(2), seven));
    CHECK(sender.add(12, air(4), twelve));
    run_ms(300);
    LONGS_EQUAL(0, frames);  // the CNC tells no tool
    change_tool(7, seven);
    run_ms(300);
    CHECK(chip_takes_all_of(5));
    change_tool(12, twelve);
    run_ms(300);
    CHECK(chip_takes_all_of(9));
    change_tool(7, seven);
    run_ms(300);
    CHECK(chip_takes_all_of(5));
    UNSIGNED_LONGS_EQUAL(7, sender.tool());
}

TEST(MapSender, says_nothing_for_a_tool_without_a_map_and_where_the_cnc_falls_silent) {
    CHECK(sender.add(7, air(2), seven));
    change_tool(9, twelve);
    run_ms(300);
    LONGS_EQUAL(0, frames);
    CHECK(sender.sender() == nullptr);
    change_tool(7, seven);
    run_ms(300);
    CHECK(frames > 0);
    frames = 0;
    sender.poll(now_us += 2'000'000);
    hal::CanFrame frame;
    CHECK_FALSE(sender.take_frame(frame));
    UNSIGNED_LONGS_EQUAL(0, sender.tool());
}

TEST(MapSender, takes_one_map_for_each_number) {
    CHECK(sender.add(7, air(2), seven));
    CHECK_FALSE(sender.add(7, air(2), seven));
}

TEST(MapSender, of_one_tool_follows_no_numbers) {
    sender.add(air(2), seven);
    tool = 12;
    run_ms(300);
    CHECK(chip_takes_all_of(5));
    UNSIGNED_LONGS_EQUAL(0, sender.tool());
}
