// SPDX-License-Identifier: Apache-2.0
#include "firmware/tools_in_block.hpp"
#include "firmware/tool_tick.hpp"
#include "tick_bench.hpp"

#include <array>
#include <cstdint>
#include <optional>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;
using firmware::NumberedTool;

namespace {

using Tick = firmware::SmallTick<float>;
using Tools = firmware::ToolsInBlock<Tick>;

constexpr std::uint32_t strong = 7;  // numbers of the two tools that there are
constexpr std::uint32_t weak = 12;

Parameters with_limit(float tooth_force_limit_N) {
    Parameters p = machine_and_tool();
    p.tool.tooth_force_limit_N = tooth_force_limit_N;
    p.tool.control.overload_share = 10.0F;
    return p;
}

/// The two tools as a block, and what a small chip makes of it.
struct Chip {
    Chip() {
        const std::array<NumberedTool, 2> both{NumberedTool{strong, with_limit(2000.0F).tool},
                                               NumberedTool{weak, with_limit(150.0F).tool}};
        (void)firmware::encode_tools(machine_and_tool().machine, both, 1, block);
        is_read = firmware::decode(block, parameters) == firmware::BlockError::none;
        tools.emplace(firmware::tools_of(block), parameters);
    }

    firmware::LargestParameterBlock block{};
    Parameters parameters{};
    bool is_read = false;
    std::optional<Tools> tools{};
};

/// Air, and from sample 200 on the cut of tick_bench.hpp.
template <typename AnyTick>
hal::FeedOverride mill(AnyTick& tick, int from, int to) {
    hal::FeedOverride output;
    for (int k = from; k < to; ++k) {
        output = firmware::step_and_work(tick, sample_of(k), program());
    }
    return output;
}

}  // namespace

TEST_GROUP(ToolsInBlock) {
    Chip chip;
};

TEST(ToolsInBlock, hold_each_tool_of_the_block_and_no_other) {
    CHECK(chip.is_read);
    CHECK(chip.tools->has(strong));
    CHECK(chip.tools->has(weak));
    CHECK_FALSE(chip.tools->has(0));
    CHECK_FALSE(chip.tools->has(8));
}

TEST(ToolsInBlock, give_after_a_change_the_tick_that_the_tools_own_parameters_give) {
    firmware::ToolTickOf<Tick, Tools> by_number(chip.parameters, &*chip.tools);
    CHECK(by_number.follow_tool(strong, true));
    mill(by_number, 0, 200);
    CHECK(by_number.follow_tool(weak, true));
    UNSIGNED_LONGS_EQUAL(weak, by_number.tool());
    Tick alone(with_limit(150.0F));
    alone.set_machine_knowledge(by_number.of_tool().machine_knowledge());
    const hal::FeedOverride expected = mill(alone, 0, 1200);
    const hal::FeedOverride got = mill(by_number, 0, 1200);
    CHECK(expected.ratio == got.ratio);
    CHECK(expected.state == got.state);
    CHECK(alone.estimate().tooth_force_N.valid);
    CHECK(alone.estimate().tooth_force_N.value == by_number.of_tool().estimate().tooth_force_N.value);
}

TEST(ToolsInBlock, leave_the_override_to_the_operator_without_a_known_tool) {
    firmware::ToolTickOf<Tick, Tools> tick(chip.parameters, &*chip.tools);
    tick.follow_tool(strong, true);
    hal::ProgramStatus status = program();
    status.operator_override = 0.8F;
    for (const std::uint32_t unknown : {0U, 99U}) {
        tick.follow_tool(unknown, true);
        CHECK_FALSE(tick.is_tool_known());
        DOUBLES_EQUAL(0.8, tick.step(sample_of(0), status).ratio, 1e-6);
    }
}

TEST(ToolsInBlock, lose_a_tool_whose_bytes_have_changed_since_the_start) {
    chip.block[firmware::block_header_bytes + firmware::machine_value_bytes + 100] ^= 1U;
    CHECK_FALSE(chip.tools->has(strong));
    CHECK(chip.tools->has(weak));
}
