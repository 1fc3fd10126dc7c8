// SPDX-License-Identifier: Apache-2.0
#include "zcu102/bus_controller.hpp"
#include "drivers/zynqmp/fake_can.hpp"
#include "firmware/ready_tools.hpp"
#include "firmware/tool_checksum.hpp"
#include "hal/tick_watch.hpp"
#include "instructions/machine_and_tool.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

#include <CppUTest/TestHarness.h>

using namespace millforce;

namespace {

/// A bus whose drives are asked for nothing: this controller makes the SYNC alone.
firmware::Parameters<float> with_a_bus() {
    firmware::Parameters<float> parameters = bench::machine_and_tool();
    auto& bus = parameters.machine.bus;
    bus.produces_sync = true;
    parameters.machine.spindle_rated_current_A = 10.0F;
    parameters.machine.axis_rated_current_A = {5.0F, 5.0F, 5.0F};
    for (std::size_t k = 0; k < bus.drives.size(); ++k) {
        bus.drives[k].node_id = static_cast<std::uint8_t>(k + 1);
        bus.drives[k].velocity_mm_s_per_unit = 0.001F;
        bus.drives[k].tpdo_every[1] = 4;
    }
    return parameters;
}

}  // namespace

TEST_GROUP(Zcu102Bus) {
    FakeZynqCan chip;
    firmware::Parameters<float> parameters = with_a_bus();
    firmware::CanControllerSettings settings =
        firmware::can_controller_settings(parameters.machine, zcu102::bus_objects);
    zynqmp::WatchdogRegisters watchdog{};
    zynqmp::ErrorRegisters errors{};
    zcu102::BusController controller{{chip.registers, watchdog, errors}, settings, parameters};

    /// Frames with this id that leave until then.
    int frames_until(std::uint64_t & now_us, std::uint64_t end_us, std::uint32_t id) {
        int frames = 0;
        for (; now_us < end_us; now_us += 50) {
            chip.registers.transmit.identifier = 0;
            controller.poll(now_us);
            chip.react();
            frames += chip.registers.transmit.identifier == id << 21U ? 1 : 0;
        }
        return frames;
    }
};

/// The same with drives that answer each SYNC: a spindle that turns, axes at rest. An emergency is the last frame of
/// its poll, and so the one that is seen.
TEST_GROUP(Zcu102Guard) {
    FakeZynqCan chip;
    zynqmp::WatchdogRegisters watchdog{};
    zynqmp::ErrorRegisters errors{};
    firmware::Parameters<float> parameters = with_a_bus();
    std::optional<zcu102::BusController> controller;
    std::uint64_t now_us = 0;
    bool drives_answer = true;
    std::uint32_t answered = 0;
    std::optional<hal::CanFrame> newest_override;
    std::optional<way_window::WayAnswer> newest_answer;
    std::array<std::optional<hal::CanFrame>, emergency::reason_count> emergencies;
    int feeds = 0;

    void start(hal::ResetCause cause, const firmware::ReadyTools* tools = nullptr) {
        controller.emplace(zcu102::Peripherals{chip.registers, watchdog, errors},
                           firmware::can_controller_settings(parameters.machine, zcu102::bus_objects), parameters,
                           tools);
        controller->start(zynqmp::kbit_1000, cause);
        chip.react();
    }
    void poll() {
        now_us += 50;
        chip.registers.transmit.identifier = 0;
        watchdog.restart = 0;
        controller->poll(now_us);
        chip.react();
        feeds += watchdog.restart == 0x1999U ? 1 : 0;
        note_sent();
    }
    void note_sent() {
        hal::CanFrame frame;
        frame.id = chip.registers.transmit.identifier >> 21U;
        for (unsigned k = 0; k < 8U; ++k) {
            const std::uint32_t word = k < 4U ? chip.registers.transmit.data1 : chip.registers.transmit.data2;
            frame.data[k] = static_cast<std::uint8_t>(word >> (24U - 8U * (k % 4U)));
        }
        if (frame.id == 0x080U + override_frame::default_node_id) {
            emergencies[frame.data[3]] = frame;
        } else if (frame.id == override_frame::default_id) {
            newest_override = frame;
        } else if (frame.id == way_window::way_answer_id(override_frame::default_node_id)) {
            frame.length = way_window::frame_bytes;
            CHECK(way_window::decode(frame, frame.id, newest_answer.emplace()) == way_window::FrameError::none);
        }
    }
    void run_ms(int duration_ms) {
        for (const std::uint64_t end_us = now_us + static_cast<std::uint64_t>(duration_ms) * 1000U; now_us < end_us;) {
            poll();
            const std::uint32_t syncs = controller->controller().drives().health().syncs;
            if (drives_answer && syncs != answered) {
                answer_sync();
                answered = syncs;
            }
        }
    }
    void answer_sync() {
        spindle_count += 546;
        const std::uint32_t turned = __builtin_bswap32(spindle_count);
        constexpr std::uint32_t no_current_operation_enabled = 0x0000'3706U;
        const auto arrive = [this](std::uint32_t id, std::uint32_t length, std::uint32_t data1, std::uint32_t data2) {
            chip.arrive(id << 21U, length, data1, data2);
            poll();
        };
        arrive(0x181, 8, turned, no_current_operation_enabled);
        arrive(0x281, 6, 0, 0);
        for (std::uint32_t axis = 0x182; axis <= 0x184; ++axis) {
            arrive(axis, 8, 0, no_current_operation_enabled);
        }
    }
    void tell_tool(std::uint32_t number) {
        tell(program_status::encode_tool(number, 0x2FD));
    }
    void tell(const hal::CanFrame& frame) {
        const auto word = [&frame](std::size_t first) {
            std::uint32_t value = 0;
            std::memcpy(&value, frame.data.data() + first, sizeof(value));
            return __builtin_bswap32(value);
        };
        chip.arrive(frame.id << 21U, frame.length, word(0), word(4));
        poll();
    }
    void tell(const way_window::WayFrame& frame) {
        tell(way_window::encode(frame, way_window::way_frame_id(override_frame::default_node_id)));
    }
    void begin_a_map_and_ask() {
        begin_a_map_and_ask(parameters.tool);
    }
    void begin_a_map_and_ask(const firmware::ToolParameters<float>& tool) {
        newest_answer.reset();
        tell(way_window::begin_frame(1, 0, firmware::tool_checksum(tool)));
        tell(way_window::WayFrame{9, static_cast<std::uint8_t>(way_window::WayFrameKind::ask), 1, {}});
        run_ms(1);
    }
    [[nodiscard]] std::uint32_t code_of(emergency::Reason reason) const {
        const auto& frame = emergencies[static_cast<std::size_t>(reason)];
        CHECK_TRUE_TEXT(frame.has_value(), "no such emergency");
        return static_cast<std::uint32_t>(frame->data[0] | frame->data[1] << 8U);
    }
    [[nodiscard]] std::uint32_t detail_of(emergency::Reason reason) const {
        return emergencies[static_cast<std::size_t>(reason)]->data[4];
    }
    [[nodiscard]] bool is_held() const {
        return newest_override.has_value() && (newest_override->data[2] & 1U) != 0;
    }

    std::uint32_t spindle_count = 0;
};

TEST(Zcu102Guard, the_bus_is_told_why_the_chip_has_started) {
    struct Case {
        hal::ResetCause cause;
        std::uint32_t code;
    };
    for (const Case& c : {Case{hal::ResetCause::watchdog, 0x6010}, Case{hal::ResetCause::power_on, 0},
                          Case{hal::ResetCause::unknown, 0x1000}}) {
        emergencies = {};
        chip = {};
        start(c.cause);
        run_ms(10);
        UNSIGNED_LONGS_EQUAL(c.code, code_of(emergency::Reason::started));
        UNSIGNED_LONGS_EQUAL(c.cause, detail_of(emergency::Reason::started));
    }
}

TEST(Zcu102Guard, a_tool_of_the_block_is_taken_at_rest_and_another_one_is_told_with_its_number) {
    std::array<firmware::ReadyTool, 2> memory;
    firmware::ReadyTools tools(memory);
    tools.add(7, parameters);
    tools.add(12, parameters);
    start(hal::ResetCause::power_on, &tools);
    run_ms(20);
    UNSIGNED_LONGS_EQUAL(0xFF01, code_of(emergency::Reason::tool_unknown));
    for (const std::uint32_t number : {7U, 12U}) {
        tell_tool(number);
        run_ms(20);
        UNSIGNED_LONGS_EQUAL(number, controller->controller().tool());
        UNSIGNED_LONGS_EQUAL(0, code_of(emergency::Reason::tool_unknown));
    }
    tell_tool(99);
    run_ms(20);
    UNSIGNED_LONGS_EQUAL(0, controller->controller().tool());
    UNSIGNED_LONGS_EQUAL(0xFF01, code_of(emergency::Reason::tool_unknown));
    UNSIGNED_LONGS_EQUAL(99, detail_of(emergency::Reason::tool_unknown));
}

TEST(Zcu102Guard, the_watchdog_waits_for_the_first_tick_and_is_fed_once_by_each) {
    drives_answer = false;
    start(hal::ResetCause::power_on);
    run_ms(50);
    UNSIGNED_LONGS_EQUAL(0, watchdog.mode);
    drives_answer = true;
    run_ms(10);
    UNSIGNED_LONGS_EQUAL(0xABC1C3, watchdog.mode);
    const std::uint32_t ticks_before = controller->controller().ticks();
    feeds = 0;
    run_ms(100);
    const std::uint32_t ticks = controller->controller().ticks() - ticks_before;
    DOUBLES_EQUAL(100, ticks, 2);
    LONGS_EQUAL(ticks, feeds);
    UNSIGNED_LONGS_EQUAL(0xABC1C3, watchdog.mode);
}

TEST(Zcu102Guard, drives_that_fall_silent_are_told_twice_and_are_no_reason_for_a_reset) {
    start(hal::ResetCause::power_on);
    run_ms(50);
    CHECK_FALSE(emergencies[static_cast<std::size_t>(emergency::Reason::inputs_missing)].has_value());
    drives_answer = false;
    run_ms(100);
    feeds = 0;
    run_ms(100);
    CHECK_COMPARE(feeds, >=, 95);
    UNSIGNED_LONGS_EQUAL(0x5000, code_of(emergency::Reason::inputs_missing));
    UNSIGNED_LONGS_EQUAL(0, detail_of(emergency::Reason::inputs_missing));
    UNSIGNED_LONGS_EQUAL(0xFF00, code_of(emergency::Reason::tick_fault));
    UNSIGNED_LONGS_EQUAL(control::Fault::stale_input, detail_of(emergency::Reason::tick_fault));
    CHECK_TRUE(is_held());
}

TEST(Zcu102Guard, a_bus_that_is_off_is_no_reason_for_a_reset_and_is_told_when_it_is_back) {
    start(hal::ResetCause::power_on);
    run_ms(50);
    chip.registers.isr = 1U << 9U;
    feeds = 0;
    for (int part = 0; part < 5; ++part) {
        run_ms(18);
        CHECK_COMPARE(feeds, >, 0);
        feeds = 0;
    }
    run_ms(50);
    UNSIGNED_LONGS_EQUAL(0x8140, code_of(emergency::Reason::bus_was_off));
    UNSIGNED_LONGS_EQUAL(1, detail_of(emergency::Reason::bus_was_off));
}

TEST(Zcu102Guard, a_ratio_beyond_the_limits_is_not_healthy) {
    hal::FeedOverride output;
    for (const float ratio : {0.0F, 0.1F, 1.5F}) {
        output.ratio = ratio;
        CHECK_TRUE(hal::is_within_limits(output, 1.5F));
    }
    for (const float ratio :
         {-0.001F, 1.501F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        output.ratio = ratio;
        CHECK_FALSE(hal::is_within_limits(output, 1.5F));
    }
}

TEST(Zcu102Guard, a_map_over_the_bus_is_taken_for_one_tool) {
    start(hal::ResetCause::power_on);
    run_ms(50);
    begin_a_map_and_ask();
    CHECK_TRUE(newest_answer.has_value());
    CHECK_TRUE(newest_answer->state == way_window::WayState::takes);
    UNSIGNED_LONGS_EQUAL(9, newest_answer->ask);
}

TEST(Zcu102Guard, a_map_over_the_bus_is_taken_for_the_tool_in_the_spindle) {
    firmware::Parameters<float> other = parameters;
    other.tool.tooth_force_limit_N *= 0.5F;
    std::array<firmware::ReadyTool, 2> memory;
    firmware::ReadyTools tools(memory);
    tools.add(7, parameters);
    tools.add(12, other);
    start(hal::ResetCause::power_on, &tools);
    const auto state_for = [this](const firmware::ToolParameters<float>& tool) {
        begin_a_map_and_ask(tool);
        CHECK_TRUE(newest_answer.has_value());
        return newest_answer->state;
    };
    for (int k = 0; k < 2; ++k) {
        tell_tool(7);
        run_ms(20);
        CHECK_TRUE(state_for(other.tool) == way_window::WayState::other_tool);
        CHECK_TRUE(state_for(parameters.tool) == way_window::WayState::takes);
        tell_tool(12);
        run_ms(20);
        CHECK_TRUE(state_for(parameters.tool) == way_window::WayState::other_tool);
        CHECK_TRUE(state_for(other.tool) == way_window::WayState::takes);
    }
}

TEST(Zcu102Bus, the_usual_mapping_and_the_table_s_numbers_make_settings_that_pass) {
    CHECK_TRUE(cia402::SettingsError::none == cia402::check(settings.drives));
    UNSIGNED_LONGS_EQUAL(0x181, settings.drives.drives[0].pdos[0].id);
    UNSIGNED_LONGS_EQUAL(0x281, settings.drives.drives[0].pdos[1].id);
    UNSIGNED_LONGS_EQUAL(0x184, settings.drives.drives[3].pdos[0].id);
    UNSIGNED_LONGS_EQUAL(1000, settings.drives.sync_period_us);
}

TEST(Zcu102Bus, a_SYNC_leaves_each_millisecond_and_counts_as_heard) {
    std::uint64_t now_us = 0;
    controller.start(zynqmp::kbit_1000, hal::ResetCause::power_on);
    chip.react();
    const int syncs = frames_until(now_us, 100'000, 0x080);
    CHECK_COMPARE(syncs, >=, 95);
    CHECK_COMPARE(syncs, <=, 101);
    CHECK_FALSE(controller.controller().drives().health().sync_lost);
    CHECK_COMPARE(controller.controller().drives().health().syncs, >=, 95);
}

TEST(Zcu102Bus, after_bus_off_it_is_silent_for_a_tenth_of_a_second_and_joins_again) {
    std::uint64_t now_us = 0;
    controller.start(zynqmp::kbit_1000, hal::ResetCause::power_on);
    chip.react();
    frames_until(now_us, 10'000, 0x080);
    chip.registers.isr = 1U << 9U;
    LONGS_EQUAL(0, frames_until(now_us, 105'000, 0x080));
    CHECK_TRUE(zynqmp::CanState::bus_off == controller.can().state());
    const int syncs = frames_until(now_us, 200'000, 0x080);
    CHECK_COMPARE(syncs, >=, 80);
    UNSIGNED_LONGS_EQUAL(1, controller.can().health().bus_offs);
}
