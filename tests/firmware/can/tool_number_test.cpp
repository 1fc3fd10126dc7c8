// SPDX-License-Identifier: Apache-2.0
#include "controller_on_loopback.hpp"
#include "firmware/ready_tools.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;
using firmware::Condition;

namespace {

constexpr std::uint32_t tool_id = 0x2FD;
constexpr float operators_override = 0.6F;

sim::Scenario slot() {
    return sim::read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/slot_entry.toml");
}

/// The scenario's tool under the numbers 7 and 8, out of a block as a board has it. Built once.
const firmware::ReadyTools& tools() {
    static std::array<firmware::ReadyTool, 2> memory;
    static const firmware::ReadyTools ready = [] {
        firmware::Parameters<float> parameters = slot().parameters;
        const std::array<firmware::NumberedTool, 2> both{firmware::NumberedTool{7, parameters.tool},
                                                         firmware::NumberedTool{8, parameters.tool}};
        firmware::LargestParameterBlock block{};
        const auto used = firmware::encode_tools(parameters.machine, both, 1, block);
        firmware::ReadyTools of_block(memory);
        of_block.add(firmware::tools_of(used), parameters);
        return of_block;
    }();
    return ready;
}

/// A spindle that turns in air, with the operator's override at 60 %.
class MachineWithTools {
  public:
    MachineWithTools() { status_.operator_override = operators_override; }

    void tell_tool(std::uint32_t number) { bus.cnc.set_tool(number, bus.now_us); }
    hal::FeedOverride run_ms(int duration_ms, float velocity_mm_s) {
        hal::FeedOverride newest;
        for (int k = 0; k < duration_ms; ++k) {
            ++sample_count_;
            hal::DriveSample sample = turning_in_air(sample_count_);
            sample.axis_velocity_mm_s = {velocity_mm_s, 0.0F, 0.0F};
            newest = bus.step(sample, status_);
        }
        return newest;
    }
    [[nodiscard]] bool is_unknown() const { return bus.controller.conditions().has(Condition::tool_unknown); }
    [[nodiscard]] bool is_change_due() const { return bus.controller.conditions().has(Condition::tool_change_due); }

    ControllerOnLoopback bus{slot(), &tools()};

  private:
    hal::ProgramStatus status_{25.0F};
    std::uint32_t sample_count_ = 0;
};

void check_operators(const hal::FeedOverride& got) {
    DOUBLES_EQUAL(operators_override, got.ratio, 1e-4);
    CHECK_FALSE(got.hold);
}

}  // namespace

TEST_GROUP(ToolNumber) {
    MachineWithTools machine;
};

TEST(ToolNumber, a_tool_that_the_cnc_tells_is_taken_at_rest_and_changed_at_rest) {
    machine.tell_tool(7);
    machine.run_ms(300, 0.0F);
    UNSIGNED_LONGS_EQUAL(7, machine.bus.controller.tool());
    CHECK(machine.bus.controller.conditions().none());
    machine.run_ms(200, 20.0F);
    machine.run_ms(20, 0.0F);
    machine.tell_tool(8);
    machine.run_ms(20, 0.0F);
    UNSIGNED_LONGS_EQUAL(8, machine.bus.controller.tool());
    CHECK_FALSE(machine.is_unknown());
}

TEST(ToolNumber, a_change_that_is_told_in_motion_waits_for_rest_with_the_last_tools_limits) {
    machine.tell_tool(7);
    machine.run_ms(300, 0.0F);
    const float limited = machine.run_ms(300, 20.0F).ratio;
    CHECK(limited < 0.95F * operators_override);  // as the law has it in air
    machine.tell_tool(8);
    DOUBLES_EQUAL(limited, machine.run_ms(50, 20.0F).ratio, 1e-3);
    CHECK(machine.is_change_due());
    CHECK_FALSE(machine.is_unknown());
    UNSIGNED_LONGS_EQUAL(7, machine.bus.controller.tool());
    machine.run_ms(10, 0.0F);
    UNSIGNED_LONGS_EQUAL(8, machine.bus.controller.tool());
    CHECK_FALSE(machine.is_change_due());
}

TEST(ToolNumber, a_tool_that_there_is_not_leaves_the_override_to_the_operator_until_a_known_one_is_back) {
    machine.tell_tool(7);
    machine.run_ms(300, 0.0F);
    machine.tell_tool(9);
    check_operators(machine.run_ms(50, 0.0F));
    check_operators(machine.run_ms(300, 20.0F));
    CHECK(machine.is_unknown());
    machine.tell_tool(7);
    machine.run_ms(10, 0.0F);
    UNSIGNED_LONGS_EQUAL(7, machine.bus.controller.tool());
    CHECK_FALSE(machine.is_unknown());
}

TEST(ToolNumber, a_cnc_that_has_told_no_tool_or_tells_none_any_more_has_the_operators_override) {
    machine.run_ms(300, 20.0F);
    check_operators(machine.run_ms(1, 20.0F));
    CHECK(machine.is_unknown());
    machine.tell_tool(7);
    machine.run_ms(50, 0.0F);
    UNSIGNED_LONGS_EQUAL(7, machine.bus.controller.tool());
    machine.bus.wire.set_fault([](const hal::CanFrame& f) {
        return sim::LoopbackBus::Fate{f.id == tool_id ? 0 : 1, 0, f};
    });
    machine.run_ms(850, 0.0F);
    CHECK_FALSE(machine.is_unknown());
    check_operators(machine.run_ms(200, 0.0F));
    CHECK(machine.is_unknown());
}

TEST(ToolNumber, the_counter_of_the_override_goes_on_over_each_change) {
    const std::uint32_t before = machine.bus.controller.ticks();
    for (const std::uint32_t number : {7U, 8U, 9U, 7U}) {
        machine.tell_tool(number);
        machine.run_ms(100, 0.0F);
    }
    machine.run_ms(200, 20.0F);
    CHECK(machine.bus.controller.ticks() > before + 500);
    CHECK(machine.bus.cnc.feed_override(machine.bus.now_us).is_alive);
}

TEST(ToolNumber, a_log_of_the_frames_gives_the_same_ticks_again) {
    machine.tell_tool(7);
    machine.run_ms(300, 0.0F);
    machine.run_ms(100, 20.0F);
    machine.tell_tool(8);
    machine.run_ms(100, 20.0F);
    machine.run_ms(100, 0.0F);
    machine.run_ms(100, 20.0F);
    const std::vector<std::string> again = replayed(machine.bus, slot(), 0, &tools());
    CHECK(again.size() > 500);
    CHECK(again == machine.bus.ticks.lines);
    CHECK_FALSE(replayed(machine.bus, slot()) == machine.bus.ticks.lines);  // with one tool
}

TEST(ToolNumber, with_one_tool_the_frame_is_no_frame_of_the_controllers) {
    ControllerOnLoopback bus(slot());
    bus.cnc.set_tool(9, bus.now_us);
    bus.run_us(500'000);
    CHECK_FALSE(bus.controller.conditions().has(Condition::tool_unknown));
    std::array<hal::CanFilter, firmware::CanController::filter_capacity> filters{};
    const std::size_t count = bus.controller.filters(filters);
    for (std::size_t k = 0; k < count; ++k) {
        CHECK(filters[k].id != tool_id);
    }
    const std::size_t with_tools = machine.bus.controller.filters(filters);
    UNSIGNED_LONGS_EQUAL(count + 1, with_tools);
}
