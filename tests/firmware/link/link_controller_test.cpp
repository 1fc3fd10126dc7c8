// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "firmware/ready_tools.hpp"
#include "firmware/tick_bench.hpp"
#include "firmware_link/link_controller.hpp"
#include "sample_message.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using local_link::MessageError;

namespace {

firmware::Parameters<float> a_mill() {
    firmware::Parameters<float> p;
    p.machine.cnc.override_max = 2.0F;
    p.tool.tooth_force_limit_N = 700.0F;
    p.tool.control.highest_programmed_feed_mm_s = 10.0F;
    return p;
}

/// A CNC whose spindle turns at 4000 rpm in air, in a rapid.
struct Cnc {
    local_link::SampleMessage message{};
    Cnc() {
        message.present = 0x1F;
        message.programmed_feed_mm_s = 10.0F;
        message.rapid = true;
    }
    local_link::SampleBytes next(std::uint32_t elapsed_us = 1000) {
        ++message.sequence;
        message.time_us += elapsed_us;
        message.spindle_count += 273;
        return encode(message);
    }
};

local_link::OverrideMessage answer(firmware::LinkController& controller, const local_link::SampleBytes& bytes) {
    local_link::OverrideBytes answered{};
    CHECK(controller.on_message(bytes, answered) == MessageError::none);
    local_link::OverrideMessage message;
    CHECK(decode(answered, message) == MessageError::none);
    return message;
}

struct FeedsSeen final : firmware::WaySource<float> {
    std::vector<float> feeds_mm_s{};
    std::vector<std::uint32_t> tools{};
    void set_tool(std::uint32_t number) override { tools.push_back(number); }
    void look_ahead(firmware::ForceControlTick<float>&, const hal::ProgramStatus& program) override {
        feeds_mm_s.push_back(program.programmed_feed_mm_s);
    }
};

}  // namespace

TEST_GROUP(LinkController) {
    Cnc cnc;
};

TEST(LinkController, answers_each_sample_with_its_sequence_and_a_heartbeat) {
    firmware::LinkController controller(a_mill(), 1.0F);
    for (std::uint32_t k = 1; k <= 5; ++k) {
        const auto m = answer(controller, cnc.next());
        UNSIGNED_LONGS_EQUAL(k, m.sequence);
        UNSIGNED_LONGS_EQUAL(k, m.heartbeat);
        CHECK(!m.hold && m.fault == 0);
    }
}

TEST(LinkController, asks_for_no_more_than_the_cnc_takes) {
    firmware::LinkController controller(a_mill(), 0.8F);
    float highest = 0.0F;
    for (int k = 0; k < 2000; ++k) {
        highest = std::max(highest, answer(controller, cnc.next()).ratio);
    }
    DOUBLES_EQUAL(0.8, static_cast<double>(highest), 1e-6);
}

TEST(LinkController, tells_no_estimate_as_a_number_that_is_none) {
    firmware::LinkController controller(a_mill(), 1.0F);
    const auto m = answer(controller, cnc.next());
    CHECK(std::isnan(m.tooth_force_N) && std::isnan(m.radial_immersion) && std::isnan(m.axial_depth_mm));
}

TEST(LinkController, tells_a_force_of_which_only_a_bound_is_known_as_no_estimate) {
    auto mill = a_mill();
    mill.machine.spindle.K_t1_Nm_per_A = 0.5F;
    mill.tool.law.k_s_N_per_mm2 = 1700.0F;
    mill.tool.law.k_1 = 0.4F;
    firmware::LinkController controller(mill, 1.0F);
    cnc.message.present = 0x03;  // no axis currents: no immersion, and the tooth's force only at the narrowest cut
    cnc.message.rapid = false;
    cnc.message.spindle_current_A = 20.0F;
    cnc.message.axis_velocity_mm_s = {5.0F, 0.0F, 0.0F};
    local_link::OverrideMessage m;
    for (int k = 0; k < 200; ++k) {
        m = answer(controller, cnc.next());
    }
    CHECK(m.tangential_N > 100.0F);
    CHECK(std::isnan(m.tooth_force_N));
}

TEST(LinkController, tells_the_engagement_and_the_tooth_force_that_the_tick_finds_in_a_cut) {
    firmware::LinkController controller(test::machine_and_tool(), 1.0F);
    const float in_air_A = test::sample_of(0).axis_current_A[0];
    local_link::OverrideMessage m;
    for (int k = 0; k < 1000; ++k) {
        cnc.message = test::message_of(test::sample_of(k), test::program());
        float& current_A = cnc.message.axis_current_A[0];
        current_A = in_air_A + 2.0F * (current_A - in_air_A);  // a narrow cut, whose tooth force is certain
        m = answer(controller, encode(cnc.message));
    }
    const auto engagement = controller.tick().engagement();
    CHECK(engagement.immersion_valid && engagement.depth_valid);
    CHECK(m.radial_immersion > 0.0F && m.radial_immersion == engagement.radial_immersion);
    CHECK(m.radial_immersion_sd > 0.0F && m.radial_immersion_sd == engagement.radial_immersion_sd);
    CHECK(m.axial_depth_mm > 0.0F && m.axial_depth_mm == engagement.axial_depth_mm);
    CHECK(m.axial_depth_sd_mm > 0.0F && m.axial_depth_sd_mm == engagement.axial_depth_sd_mm);
    CHECK(m.tooth_force_N > 0.0F && m.tooth_force_N == controller.tick().estimate().tooth_force_N.value);
}

TEST(LinkController, asks_what_lies_ahead_once_for_each_sample) {
    FeedsSeen way;
    firmware::LinkController controller(a_mill(), 1.0F, &way);
    answer(controller, cnc.next());
    cnc.message.programmed_feed_mm_s = 4.0F;
    answer(controller, cnc.next());
    CHECK((way.feeds_mm_s == std::vector<float>{10.0F, 4.0F}));
}

TEST(LinkController, leaves_bytes_that_are_not_sound_unanswered) {
    firmware::LinkController controller(a_mill(), 1.0F);
    answer(controller, cnc.next());
    local_link::SampleBytes wrong = cnc.next();
    wrong[0] ^= 1U;
    local_link::OverrideBytes untouched{};
    CHECK(controller.on_message(wrong, untouched) == MessageError::not_this_link);
    CHECK(controller.on_message({}, untouched) == MessageError::length);
    CHECK(untouched == local_link::OverrideBytes{});
    UNSIGNED_LONGS_EQUAL(1, controller.output().heartbeat);
}

TEST(LinkController, faults_where_the_samples_have_a_gap_and_resets_at_rest_only) {
    firmware::LinkController controller(a_mill(), 1.0F);
    answer(controller, cnc.next());
    const auto after_gap = answer(controller, cnc.next(80'000));  // stale_s is 50 ms
    CHECK(after_gap.hold);
    BYTES_EQUAL(static_cast<int>(control::Fault::stale_input), after_gap.fault);
    cnc.message.axis_velocity_mm_s = {5.0F, 0.0F, 0.0F};
    cnc.message.reset = true;
    CHECK(answer(controller, cnc.next()).hold);
    cnc.message.axis_velocity_mm_s = {};
    CHECK(answer(controller, cnc.next()).hold);  // the reset still stands: no new one
    cnc.message.reset = false;
    answer(controller, cnc.next());
    cnc.message.reset = true;
    CHECK(!answer(controller, cnc.next()).hold);
}

TEST(LinkController, a_reset_that_stands_from_the_start_resets_nothing) {
    firmware::LinkController controller(a_mill(), 1.0F);
    cnc.message.reset = true;
    answer(controller, cnc.next());
    CHECK(answer(controller, cnc.next(80'000)).hold);
    CHECK(answer(controller, cnc.next()).hold);
}

TEST(LinkController, gives_the_same_overrides_whenever_the_samples_come_and_whatever_they_hold) {
    firmware::LinkController one(a_mill(), 1.0F);
    firmware::LinkController other(a_mill(), 1.0F);
    const std::array<float, 4> values{0.0F, 3.0F, std::numeric_limits<float>::quiet_NaN(),
                                      std::numeric_limits<float>::infinity()};
    for (std::size_t k = 0; k < 3000; ++k) {
        cnc.message.spindle_current_A = values[k % 4];
        cnc.message.axis_velocity_mm_s[0] = values[(k / 7) % 4];
        cnc.message.programmed_feed_mm_s = values[(k / 11) % 4];
        cnc.message.operator_limit = values[(k / 13) % 4];
        const auto bytes = cnc.next();
        local_link::OverrideBytes first{};
        local_link::OverrideBytes second{};
        CHECK(one.on_message(bytes, first) == MessageError::none);
        CHECK(other.on_message(bytes, second) == MessageError::none);
        CHECK(first == second);
        CHECK(one.output().ratio >= 0.0F && one.output().ratio <= 1.0F);
    }
}

TEST(LinkController, a_hold_from_outside_is_in_the_answers_alone) {
    firmware::LinkController one(a_mill(), 1.0F);
    firmware::LinkController other(a_mill(), 1.0F);
    for (int k = 0; k < 100; ++k) {
        const auto bytes = cnc.next();
        one.hold_from_outside(k < 50);
        const auto held = answer(one, bytes);
        const auto free = answer(other, bytes);
        CHECK_EQUAL(k < 50 || free.hold, held.hold);
        DOUBLES_EQUAL(static_cast<double>(free.ratio), static_cast<double>(held.ratio), 0.0);
    }
}

TEST(LinkController, follows_the_tool_that_the_cnc_tells_at_rest_and_says_where_it_is_not_known) {
    const firmware::Parameters<float> capped_mill{firmware::capped(a_mill().machine, 1.0F), a_mill().tool};
    std::array<firmware::ReadyTool, 1> memory;
    firmware::ReadyTools tools(memory);
    tools.add(7, capped_mill);
    FeedsSeen way;
    firmware::LinkController controller(a_mill(), 1.0F, &way, &tools);
    cnc.message.tool = 7;
    cnc.message.operator_limit = 0.7F;
    CHECK_FALSE(answer(controller, cnc.next()).tool_unknown);
    UNSIGNED_LONGS_EQUAL(7, controller.tool());
    cnc.message.tool = 8;
    cnc.message.axis_velocity_mm_s = {5.0F, 0.0F, 0.0F};
    CHECK_FALSE(answer(controller, cnc.next()).tool_unknown);
    CHECK(controller.is_tool_change_due());
    UNSIGNED_LONGS_EQUAL(7, controller.tool());
    for (const float velocity_mm_s : {0.0F, 5.0F}) {
        cnc.message.axis_velocity_mm_s[0] = velocity_mm_s;
        const auto unknown = answer(controller, cnc.next());
        CHECK(unknown.tool_unknown && !unknown.hold);
        DOUBLES_EQUAL(0.7, static_cast<double>(unknown.ratio), 1e-7);
        CHECK(std::isnan(unknown.tangential_N) && std::isnan(unknown.tooth_force_N));
    }
    cnc.message.tool = 7;
    CHECK(answer(controller, cnc.next()).tool_unknown);  // in motion
    cnc.message.axis_velocity_mm_s = {};
    CHECK_FALSE(answer(controller, cnc.next()).tool_unknown);
    UNSIGNED_LONGS_EQUAL(6, controller.output().heartbeat);
    CHECK((way.tools == std::vector<std::uint32_t>{7, 0, 7}));
    UNSIGNED_LONGS_EQUAL(3, way.feeds_mm_s.size());  // of no tool that is not known
}

TEST(LinkController, with_one_tool_takes_no_notice_of_numbers) {
    firmware::LinkController controller(a_mill(), 1.0F);
    for (const std::uint32_t number : {0U, 7U, 99U}) {
        cnc.message.tool = number;
        CHECK_FALSE(answer(controller, cnc.next()).tool_unknown);
    }
}
