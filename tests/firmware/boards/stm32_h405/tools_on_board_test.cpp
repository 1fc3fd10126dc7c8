// SPDX-License-Identifier: Apache-2.0
#include "firmware/boards/stm32_h405/board_bench.hpp"

#include <array>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using emergency::Reason;
using firmware::NumberedTool;

namespace {

constexpr float operators_override = 0.6F;

firmware::ToolParameters<float> tool_with(float tooth_force_limit_N) {
    firmware::ToolParameters<float> tool = instructions::machine_and_tool().tool;
    tool.tooth_force_limit_N = tooth_force_limit_N;
    return tool;
}

/// The tools 7 and 12 in a block, as it is in the board's flash, and what the start makes of it.
struct Flash {
    Flash() {
        const std::array<NumberedTool, 2> both{NumberedTool{7, tool_with(700.0F)}, NumberedTool{12, tool_with(150.0F)}};
        (void)firmware::encode_tools(instructions::machine_and_tool().machine, both, 1, block);
        error = firmware::decode(block, parameters);
    }
    firmware::LargestParameterBlock block{};
    firmware::Parameters<float> parameters{};
    firmware::BlockError error = firmware::BlockError::empty;
};

}  // namespace

/// A spindle that turns in air, with the operator's override at 60 %.
TEST_GROUP(ToolsOnBoard) {
    Flash flash;
    BoardBench::AnalogueController::Tools tools{firmware::tools_of(flash.block), flash.parameters};
    BoardBench board{tools, flash.parameters};
    program_status::ProgramStatusFrame status;

    void setup() override {
        LONGS_EQUAL(firmware::BlockError::none, flash.error);
        status.program = {.programmed_feed_mm_s = 25.0F, .operator_override = operators_override};
    }
    /// The CNC tells its program and the tool by turns.
    void run_periods(unsigned periods, std::uint32_t tool, float velocity_mm_s = 0.0F) {
        for (unsigned k = 0; k < periods; ++k) {
            board.x_count += velocity_mm_s * 1e-3F / board.wiring.axes[0].mm_per_count;
            if (k % 2U == 0) {
                board.tell_tool(tool);
            } else {
                ++status.counter;
                board.tell_program(status);
            }
            board.run_period();
        }
    }
    void check_operators() const {
        UNSIGNED_LONGS_EQUAL(0, board.controller->tool());
        DOUBLES_EQUAL(operators_override, board.seen_by_cnc().ratio, 1e-3);
        CHECK_FALSE(board.seen_by_cnc().hold);
    }
    [[nodiscard]] std::uint32_t unknown_tool() const {
        return BoardBench::detail_of(*board.emergency(Reason::tool_unknown));
    }
    [[nodiscard]] bool is_told_unknown() const {
        const auto emergency = board.emergency(Reason::tool_unknown);
        return emergency.has_value() && BoardBench::code_of(*emergency) == 0xFF01U;
    }
};

TEST(ToolsOnBoard, the_override_is_the_operators_until_the_CNC_tells_a_tool_of_the_block) {
    run_periods(50, 0);
    check_operators();
    CHECK_TRUE(is_told_unknown());
    UNSIGNED_LONGS_EQUAL(0, unknown_tool());
    run_periods(20, 12);
    UNSIGNED_LONGS_EQUAL(12, board.controller->tool());
    CHECK_FALSE(is_told_unknown());
    DOUBLES_EQUAL(150.0, flash.parameters.tool.tooth_force_limit_N, 1e-6);
}

TEST(ToolsOnBoard, a_tool_that_is_not_in_the_block_is_told_with_its_number) {
    run_periods(20, 7);
    CHECK_FALSE(is_told_unknown());
    for (const std::uint32_t number : {99U, 70'000U}) {
        run_periods(40, number);
        check_operators();
        CHECK_TRUE(is_told_unknown());
        UNSIGNED_LONGS_EQUAL(number, unknown_tool());
    }
    run_periods(20, 7);
    UNSIGNED_LONGS_EQUAL(7, board.controller->tool());
    CHECK_FALSE(is_told_unknown());
}

TEST(ToolsOnBoard, a_number_that_is_told_in_motion_waits_for_rest) {
    run_periods(20, 7);
    run_periods(200, 7, 20.0F);
    UNSIGNED_LONGS_EQUAL(7, board.controller->tool());
    for (const std::uint32_t number : {12U, 99U, 0U}) {
        run_periods(50, number, 20.0F);
        UNSIGNED_LONGS_EQUAL(7, board.controller->tool());
        CHECK_FALSE(is_told_unknown());
    }
    run_periods(40, 12);
    UNSIGNED_LONGS_EQUAL(12, board.controller->tool());
}

TEST(ToolsOnBoard, the_time_that_a_change_takes_is_no_stale_input) {
    run_periods(20, 7);
    while (board.controller->tool() != 12) {
        run_periods(1, 12);
    }
    board.now_us += 150'000;
    run_periods(40, 12);
    LONGS_EQUAL(control::Fault::none, board.seen_by_cnc().fault);
    CHECK_FALSE(board.seen_by_cnc().hold);
    CHECK_TRUE(board.seen_by_cnc().is_alive);
}

TEST(ToolsOnBoard, the_counter_goes_on_over_a_change_and_the_watchdog_waits_for_it) {
    UNSIGNED_LONGS_EQUAL(3199, board.watchdog.rlr);
    run_periods(20, 7);
    const std::uint32_t before = board.controller->output().heartbeat;
    run_periods(20, 12);
    UNSIGNED_LONGS_EQUAL(before + 20, board.controller->output().heartbeat);
    UNSIGNED_LONGS_EQUAL(0xAAAA, board.watchdog.kr);
}

TEST(ToolsOnBoard, a_tool_that_the_flash_has_lost_is_not_used) {
    flash.block[firmware::block_header_bytes + firmware::machine_value_bytes + 100] ^= 1U;
    run_periods(40, 7);
    check_operators();
    UNSIGNED_LONGS_EQUAL(7, unknown_tool());
}

TEST(ToolsOnBoard, numbers_mean_nothing_to_a_board_with_one_tool) {
    BoardBench one;
    one.run(10);
    one.tell_tool(99);
    one.run(40);
    CHECK_FALSE(one.emergency(Reason::tool_unknown).has_value());
    UNSIGNED_LONGS_EQUAL(0, one.controller->tool());
    UNSIGNED_LONGS_EQUAL(159, one.watchdog.rlr);
}
