// SPDX-License-Identifier: Apache-2.0
#include "firmware_can/way_over_bus.hpp"

#include "firmware/parameters_in.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>

using namespace millforce;
using namespace millforce::way_window;
using estimation::Fixed;

namespace {

constexpr std::uint8_t node = 0x7E;
constexpr std::uint32_t tool = 77;
constexpr std::uint32_t um = 1000;

firmware::Parameters<float> parameters() {
    firmware::Parameters<float> p;
    p.machine.cnc.acceleration_mm_s2 = 500.0F;
    p.machine.cnc.override_latency_s = 0.05F;
    p.tool.control.entry_feed_per_tooth_mm = 0.02F;
    p.tool.control.contact_force_N = 20.0F;
    return p;
}

/// What a window needs of a tick.
template <typename Scalar>
struct TickOfTest {
    estimation::CutEstimate<Scalar> now{};
    control::WayAhead<Scalar> way{};

    [[nodiscard]] const estimation::CutEstimate<Scalar>& estimate() const { return now; }
    [[nodiscard]] bool has_new_estimate() const { return true; }
    [[nodiscard]] bool feed_is_settled() const { return true; }
    [[nodiscard]] Scalar step_s() const { return estimation::literal<Scalar>(0.001L); }
    [[nodiscard]] Scalar path_speed_mm_s() const { return Scalar(10); }
    [[nodiscard]] Scalar asked_feed_mm_s() const { return Scalar(10); }
    void set_way_ahead(const control::WayAhead<Scalar>& ahead) { way = ahead; }
};

/// A controller's window, and the tool at 10 mm/s in a cut of 300 N.
template <typename Scalar>
struct Chip {
    firmware::WayOverBus<Scalar> window{firmware::parameters_in<Scalar>(parameters()), tool, node};
    TickOfTest<Scalar> tick{};
    std::uint8_t session = 0;
    std::uint8_t number = 0;

    void begin(std::uint8_t run = 0, std::uint32_t of_tool = tool) {
        window.on_frame(encode(begin_frame(++session, run, of_tool), way_frame_id(node)));
        number = 0;
    }
    template <typename Record>
    void give(const Record& record, WayFrameKind kind) {
        const auto bytes = bytes_of(record);
        WayFrame frame{number++, static_cast<std::uint8_t>(kind), session, {}};
        for (std::size_t place = 0; place < bytes.size(); place += payload_bytes) {
            std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(place), payload_bytes, frame.payload.begin());
            window.on_frame(encode(frame, way_frame_id(node)));
            ++frame.kind;
        }
    }
    void give(const StretchRecord& record) { give(record, WayFrameKind::stretch); }
    void give(const BlockRecord& record) { give(record, WayFrameKind::block); }
    /// One cut to 40 mm, then a wall of twice the force, to 60 mm; one block.
    void give_cut() {
        give(BlockRecord{5, 60 * um, 60 * um});
        give(cut_at(0, 10 * um, 300));
        give(cut_at(40, 4 * um, 600));
        give(cut_at(60, 4 * um, 600));
    }
    static StretchRecord cut_at(std::uint32_t begin_mm, std::uint32_t feed_um_s, std::uint32_t force_N) {
        return {.begin_um = begin_mm * um,
                .feed_um_s = feed_um_s,
                .tangential_mN = force_N * um,
                .tooth_per_tangential_e4 = 20'000,
                .feed_per_tangential_e3 = 500};
    }
    void go_to(float path_mm, float end_mm = 60.0F, std::uint32_t line = 5) {
        tick.now.spindle_speed_rad_s = Scalar(400);
        tick.now.feed_mm_s = Scalar(10);
        tick.now.window_s = Scalar(0.05F);
        tick.now.tangential_N = {true, Scalar(300), Scalar(25)};
        hal::ProgramStatus program;
        program.line = line;
        program.distance_to_go_mm = end_mm - path_mm;
        window.look_ahead_of(tick, program);
    }
    void mill(float from_mm, float to_mm) {
        constexpr float step_mm = 0.01F;
        for (int k = 0; from_mm + step_mm * static_cast<float>(k) <= to_mm; ++k) {
            go_to(from_mm + step_mm * static_cast<float>(k));
        }
    }
    WayAnswer asked() {
        window.on_frame(encode(WayFrame{1, static_cast<std::uint8_t>(WayFrameKind::ask), 1, {}}, way_frame_id(node)));
        hal::CanFrame frame;
        WayAnswer answer;
        CHECK(window.take_frame(frame));
        CHECK(decode(frame, way_answer_id(node), answer) == FrameError::none);
        CHECK_FALSE(window.take_frame(frame));
        return answer;
    }
};

}  // namespace

TEST_GROUP(WayOverBus) {
    Chip<float> chip;
};

TEST(WayOverBus, is_silent_until_it_is_asked) {
    hal::CanFrame frame;
    chip.begin();
    chip.give_cut();
    chip.mill(0.0F, 1.0F);
    CHECK_FALSE(chip.window.take_frame(frame));
    const WayAnswer answer = chip.asked();
    CHECK(answer.state == WayState::takes);
    UNSIGNED_LONGS_EQUAL(4, answer.expected);
    UNSIGNED_LONGS_EQUAL(61, answer.room);
}

TEST(WayOverBus, the_way_is_known_once_forces_agree) {
    chip.begin();
    chip.give_cut();
    chip.mill(0.0F, 0.5F);
    CHECK_FALSE(chip.tick.way.known);
    chip.mill(0.5F, 8.0F);
    CHECK(chip.tick.way.known);
    CHECK(chip.tick.way.feed_mm_s > 9.0F);
    chip.mill(8.0F, 38.0F);  // 0.5 mm before the wall is near
    CHECK(chip.tick.way.known);
    CHECK(chip.tick.way.feed_mm_s < 7.0F);
}

TEST(WayOverBus, fixed_point_decides_as_float) {
    Chip<Fixed> fixed;
    chip.begin();
    chip.give_cut();
    fixed.begin();
    fixed.give_cut();
    for (int k = 0; k < 590; ++k) {
        const float path_mm = 0.1F * static_cast<float>(k);
        chip.go_to(path_mm);
        fixed.go_to(path_mm);
        CHECK_EQUAL(chip.tick.way.known, fixed.tick.way.known);
        DOUBLES_EQUAL(static_cast<double>(chip.tick.way.feed_mm_s),
                      static_cast<double>(static_cast<float>(fixed.tick.way.feed_mm_s)), 0.01);
    }
    CHECK_EQUAL(chip.window.is_refuted(), fixed.window.is_refuted());
    const WayAnswer of_float = chip.asked();
    const WayAnswer of_fixed = fixed.asked();
    UNSIGNED_LONGS_EQUAL(of_float.room, of_fixed.room);
    UNSIGNED_LONGS_EQUAL(of_float.digest, of_fixed.digest);
}

TEST(WayOverBus, a_window_that_runs_dry_is_not_known) {
    chip.begin();
    chip.give_cut();
    chip.mill(0.0F, 20.0F);
    CHECK(chip.tick.way.known);
    chip.tick.now.tangential_N.value = 300.0F;
    chip.mill(20.0F, 59.9F);
    chip.go_to(60.5F, 70.0F, 6);
    for (int k = 0; k < 100; ++k) {
        chip.go_to(60.5F, 70.0F, 6);
    }
    CHECK_FALSE(chip.tick.way.known);
    CHECK_FALSE(chip.window.position_mm().has_value());
}

TEST(WayOverBus, before_a_window_ends_the_feed_has_fallen_to_the_blind_one) {
    chip.begin();
    chip.give(BlockRecord{5, 60 * um, 60 * um});
    chip.give(chip.cut_at(0, 10 * um, 300));
    chip.give(chip.cut_at(30, 10 * um, 300));
    chip.mill(0.0F, 10.0F);
    CHECK(chip.tick.way.known);
    CHECK(chip.tick.way.feed_mm_s > 9.0F);
    chip.mill(10.0F, 28.5F);
    const float blind_mm_s = 0.02F * 4.0F * 400.0F / 6.2831853F;
    DOUBLES_EQUAL(static_cast<double>(blind_mm_s), static_cast<double>(chip.tick.way.feed_mm_s), 0.1);
    chip.mill(28.5F, 30.1F);
    CHECK_FALSE(chip.tick.way.known);
    chip.give(chip.cut_at(60, 10 * um, 300));
    chip.mill(30.1F, 31.0F);
    CHECK(chip.tick.way.known);
}

TEST(WayOverBus, what_was_passed_makes_room) {
    chip.begin();
    for (std::uint32_t k = 0; k < 70; ++k) {
        chip.give(BlockRecord{5 + k, (k + 1) * um, um});
    }
    UNSIGNED_LONGS_EQUAL(0, chip.window.room());
    UNSIGNED_LONGS_EQUAL(64, chip.asked().expected);
    for (int k = 0; k < 100; ++k) {
        const auto line = static_cast<std::uint32_t>(k / 10);
        chip.go_to(0.1F * static_cast<float>(k), static_cast<float>(line + 1), 5 + line);
    }
    UNSIGNED_LONGS_EQUAL(7, chip.window.room());  // of 9.9 mm gone, 2 mm are kept behind
}

TEST(WayOverBus, a_stretch_or_block_that_goes_back_ends_the_session) {
    chip.begin();
    chip.give_cut();
    chip.give(chip.cut_at(59, 4 * um, 600));
    CHECK(chip.asked().state == WayState::unsound_record);
    UNSIGNED_LONGS_EQUAL(64, chip.window.room());
    chip.begin();
    chip.give_cut();
    chip.give(BlockRecord{5, 59 * um, um});
    CHECK(chip.asked().state == WayState::unsound_record);
    chip.mill(0.0F, 5.0F);
    CHECK_FALSE(chip.tick.way.known);
}

TEST(WayOverBus, a_place_that_jumps_back_waits_for_a_session) {
    chip.begin();
    chip.give_cut();
    chip.mill(0.0F, 10.0F);
    for (int k = 0; k < 100; ++k) {
        chip.go_to(1.0F);
    }
    CHECK_FALSE(chip.tick.way.known);
    CHECK(chip.asked().state == WayState::waits);
    chip.begin(1);
    chip.give_cut();
    chip.mill(1.0F, 8.0F);
    CHECK(chip.tick.way.known);
}

TEST(WayOverBus, what_the_cut_has_refuted_stays_so_in_this_run_alone) {
    chip.begin();
    chip.give(BlockRecord{5, 60 * um, 60 * um});
    chip.give(chip.cut_at(0, 10 * um, 50));  // 300 N are measured
    chip.give(chip.cut_at(60, 10 * um, 50));
    chip.mill(0.0F, 10.0F);
    CHECK(chip.asked().state == WayState::refuted);
    chip.begin(0);
    chip.give_cut();
    chip.mill(10.0F, 20.0F);
    CHECK(chip.asked().state == WayState::refuted);
    CHECK_FALSE(chip.tick.way.known);
    chip.begin(1);
    chip.give_cut();
    chip.mill(0.0F, 10.0F);
    CHECK(chip.asked().state == WayState::takes);
    CHECK(chip.tick.way.known);
}

TEST(WayOverBus, another_tool_is_refused_and_a_change_of_the_tool_forgets_all) {
    chip.begin(0, tool + 1);
    chip.give_cut();
    CHECK(chip.asked().state == WayState::other_tool);
    chip.mill(0.0F, 8.0F);
    CHECK_FALSE(chip.tick.way.known);
    chip.window.change_tool(firmware::AlongPath(parameters()), tool + 1);
    CHECK(chip.asked().state == WayState::waits);
    chip.begin(0, tool + 1);
    chip.give_cut();
    chip.mill(0.0F, 8.0F);
    CHECK(chip.tick.way.known);
}

TEST(WayOverBus, an_open_and_an_unknown_stretch_arrive_as_such) {
    chip.begin();
    chip.give(BlockRecord{5, 60 * um, 60 * um});
    chip.give(chip.cut_at(0, 10 * um, 300));
    chip.give(StretchRecord{.begin_um = 20 * um, .least_share_percent = StretchRecord::unknown_percent});
    chip.give(chip.cut_at(60, 4 * um, 600));
    chip.mill(0.0F, 10.0F);
    CHECK(chip.tick.way.known);
    chip.mill(10.0F, 25.0F);
    CHECK_FALSE(chip.tick.way.known);
    CHECK_FALSE(chip.window.is_refuted());
}
