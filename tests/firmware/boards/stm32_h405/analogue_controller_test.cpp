// SPDX-License-Identifier: Apache-2.0
#include "firmware/boards/stm32_h405/board_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using emergency::Reason;
using stm32_h405::StartReport;

TEST_GROUP(AnalogueController){};

TEST(AnalogueController, says_boot_up_and_its_reset_first) {
    BoardBench board({hal::ResetCause::pin, firmware::BlockError::none, false, 0});
    board.run(2);
    const auto emergency = board.emergency(Reason::started);
    CHECK_TRUE(emergency.has_value());
    UNSIGNED_LONGS_EQUAL(0, BoardBench::code_of(*emergency));
    UNSIGNED_LONGS_EQUAL(hal::ResetCause::pin, BoardBench::detail_of(*emergency));
    bool has_boot_up = false;
    for (const auto& frame : board.frames) {
        has_boot_up = has_boot_up || (frame.id == 0x77E && frame.length == 1 && frame.data[0] == 0);
    }
    CHECK_TRUE(has_boot_up);
}

TEST(AnalogueController, a_reset_by_watchdog_brown_out_or_fault_is_an_error) {
    struct Case {
        StartReport report;
        Reason reason;
        std::uint32_t code, detail;
    };
    const Case cases[] = {
        {{hal::ResetCause::watchdog}, Reason::started, 0x6010, 5},
        {{hal::ResetCause::brown_out}, Reason::started, 0x3200, 2},
        {{hal::ResetCause::unknown}, Reason::started, 0x1000, 0},
        {{hal::ResetCause::software, firmware::BlockError::none, true, 0x0800'1234},
         Reason::processor_fault,
         0x6100,
         0x0800'1234},
    };
    for (const Case& c : cases) {
        BoardBench board(c.report);
        board.run(3);
        const auto emergency = board.emergency(c.reason);
        CHECK_TRUE(emergency.has_value());
        UNSIGNED_LONGS_EQUAL(c.code, BoardBench::code_of(*emergency));
        UNSIGNED_LONGS_EQUAL(c.detail, BoardBench::detail_of(*emergency));
    }
}

TEST(AnalogueController, the_CNC_gets_an_override_that_lives) {
    BoardBench board;
    board.run(30);
    CHECK_TRUE(board.seen_by_cnc().is_alive);
    CHECK_FALSE(board.seen_by_cnc().hold);
    CHECK_TRUE(board.seen_by_cnc().ratio > 0.0F);
    LONGS_EQUAL(0, board.seen_by_cnc().fault);
    UNSIGNED_LONGS_EQUAL(hal::all_present, board.controller->sample().present);
    UNSIGNED_LONGS_EQUAL(0, board.controller->late_ticks());
}

TEST(AnalogueController, measures_what_the_pins_carry) {
    BoardBench board;
    board.currents_A = {12.5F, -3.0F, 2.0F, 0.5F};
    board.run_period();
    for (unsigned k = 0; k < 40; ++k) {
        board.x_count += 20.0F;
        board.run_period();
    }
    const hal::DriveSample& sample = board.controller->sample();
    constexpr double of_one_bit_A = 3.3 / 4096 * 20;
    DOUBLES_EQUAL(12.5, sample.spindle_current_A, of_one_bit_A);
    DOUBLES_EQUAL(-3.0, sample.axis_current_A[0], of_one_bit_A);
    DOUBLES_EQUAL(2.0, sample.axis_current_A[1], of_one_bit_A);
    DOUBLES_EQUAL(0.5, sample.axis_current_A[2], of_one_bit_A);
    DOUBLES_EQUAL(20.0, sample.axis_velocity_mm_s[0], 1e-3);
    CHECK_EQUAL(0.0F, sample.axis_velocity_mm_s[1]);
}

TEST(AnalogueController, a_cut_is_estimated_and_answered_as_by_the_tick_alone) {
    BoardBench board;
    BoardBench::AnalogueController::Tick alone(board.parameters);
    bool was_in_cut = false;
    bool was_solved = false;
    for (int k = 0; k < instructions::fast_widening_cut.samples(); ++k) {
        board.run_cut(1);
        const hal::FeedOverride expected = alone.step(board.controller->sample(), {});
        firmware::finish_work(alone);
        CHECK_EQUAL(expected.ratio, board.controller->output().ratio);
        LONGS_EQUAL(expected.state, board.controller->output().state);
        CHECK_EQUAL(expected.hold, board.controller->output().hold);
        was_solved = was_solved || alone.estimate().engagement.immersion_valid;
        was_in_cut = was_in_cut || expected.state == static_cast<std::uint8_t>(control::CutState::in_cut);
    }
    CHECK_TRUE(was_in_cut);
    CHECK_TRUE(was_solved);
    DOUBLES_EQUAL(board.controller->output().ratio, board.seen_by_cnc().ratio, 1e-4);
}

TEST(AnalogueController, without_parameters_the_feed_is_held_and_the_bus_knows_why) {
    BoardBench board({hal::ResetCause::power_on, firmware::BlockError::bad_values, false, 0});
    board.run(50);
    CHECK_TRUE(board.seen_by_cnc().is_alive);
    CHECK_TRUE(board.seen_by_cnc().hold);
    LONGS_EQUAL(control::Fault::bad_configuration, board.seen_by_cnc().fault);
    const auto emergency = board.emergency(Reason::no_parameters);
    CHECK_TRUE(emergency.has_value());
    UNSIGNED_LONGS_EQUAL(0x6300, BoardBench::code_of(*emergency));
    UNSIGNED_LONGS_EQUAL(firmware::BlockError::bad_values, BoardBench::detail_of(*emergency));
    UNSIGNED_LONGS_EQUAL(0, board.watchdog.kr);  // nothing to guard
}

TEST(AnalogueController, each_tick_feeds_the_watchdog_and_nothing_else_does) {
    BoardBench board;
    board.run(5);
    UNSIGNED_LONGS_EQUAL(159, board.watchdog.rlr);
    board.watchdog.kr = 0;
    board.controller->poll(board.now_us);
    board.controller->poll(board.now_us);
    UNSIGNED_LONGS_EQUAL(0, board.watchdog.kr);
    board.run_period();
    UNSIGNED_LONGS_EQUAL(0xAAAA, board.watchdog.kr);
}

TEST(AnalogueController, a_converter_that_stops_ends_in_a_held_feed_told_twice) {
    BoardBench board;
    board.run(30);
    board.converter_runs = false;
    board.watchdog.kr = 0;
    board.run(100);
    CHECK_TRUE(board.seen_by_cnc().hold);
    LONGS_EQUAL(control::Fault::stale_input, board.seen_by_cnc().fault);
    const auto missing = board.emergency(Reason::inputs_missing);
    CHECK_TRUE(missing.has_value());
    UNSIGNED_LONGS_EQUAL(0x5000, BoardBench::code_of(*missing));
    UNSIGNED_LONGS_EQUAL(hal::mask(hal::Present::spindle_count), BoardBench::detail_of(*missing));
    const auto fault = board.emergency(Reason::tick_fault);
    CHECK_TRUE(fault.has_value());
    UNSIGNED_LONGS_EQUAL(0xFF00, BoardBench::code_of(*fault));
    UNSIGNED_LONGS_EQUAL(control::Fault::stale_input, BoardBench::detail_of(*fault));
    UNSIGNED_LONGS_EQUAL(0xAAAA, board.watchdog.kr);  // a reset would not bring the converter back
}

TEST(AnalogueController, one_current_at_the_rail_is_a_missing_input) {
    BoardBench board;
    board.run(30);
    board.currents_A[2] = -17.0F;  // 0 V and below
    board.wiring.currents.channels[2].zero_V = 1.7F;
    board.run(100);
    CHECK_TRUE(board.seen_by_cnc().hold);
    const auto missing = board.emergency(Reason::inputs_missing);
    CHECK_TRUE(missing.has_value());
    UNSIGNED_LONGS_EQUAL(hal::all_present & ~hal::mask(hal::Present::y_axis), BoardBench::detail_of(*missing));
}

TEST(AnalogueController, an_encoder_that_loses_counts_is_found_by_its_index) {
    BoardBench board;
    board.run(100);
    CHECK_FALSE(board.emergency(Reason::inputs_missing).has_value());
    board.lines_lost = 0.1F;
    board.run(100);
    const auto missing = board.emergency(Reason::inputs_missing);
    CHECK_TRUE(missing.has_value());
    UNSIGNED_LONGS_EQUAL(hal::all_present & ~hal::mask(hal::Present::spindle_count), BoardBench::detail_of(*missing));
    CHECK_TRUE(board.seen_by_cnc().hold);
}

TEST(AnalogueController, a_low_supply_holds_the_feed_at_once_and_is_told) {
    BoardBench board;
    board.run(30);
    board.pwr.csr = 1U << 2U;
    board.run(2);
    CHECK_TRUE(board.seen_by_cnc().hold);
    UNSIGNED_LONGS_EQUAL(0x3200, BoardBench::code_of(*board.emergency(Reason::supply_low)));
    board.pwr.csr = 0;
    board.run(4);
    CHECK_FALSE(board.seen_by_cnc().hold);
    UNSIGNED_LONGS_EQUAL(0, BoardBench::code_of(*board.emergency(Reason::supply_low)));
}

TEST(AnalogueController, bus_off_is_silence_and_told_when_it_is_over) {
    BoardBench board;
    board.run(30);
    board.can.registers.esr = 7;
    board.run(40);
    const std::size_t before = board.frames.size();
    board.run(40);
    LONGS_EQUAL(before, board.frames.size());
    CHECK_FALSE(board.seen_by_cnc().is_alive);
    CHECK_TRUE(board.seen_by_cnc().hold);
    board.can.registers.esr = 0;
    board.run(30);
    CHECK_TRUE(board.seen_by_cnc().is_alive);
    const auto emergency = board.emergency(Reason::bus_was_off);
    CHECK_TRUE(emergency.has_value());
    UNSIGNED_LONGS_EQUAL(0x8140, BoardBench::code_of(*emergency));
    UNSIGNED_LONGS_EQUAL(1, BoardBench::detail_of(*emergency));
}

TEST(AnalogueController, final_frames_end_the_CNCs_trust_at_once) {
    BoardBench board;
    board.run(30);
    CHECK_TRUE(board.seen_by_cnc().is_alive);
    CHECK_TRUE(board.controller->give_up(Reason::processor_fault, 0x0800'4321, [&board] {
        board.carry();
        return true;
    }));
    CHECK_FALSE(board.seen_by_cnc().is_alive);
    CHECK_TRUE(board.seen_by_cnc().hold);
    const auto emergency = board.emergency(Reason::processor_fault);
    CHECK_TRUE(emergency.has_value());
    UNSIGNED_LONGS_EQUAL(0x0800'4321, BoardBench::detail_of(*emergency));
}

TEST(AnalogueController, final_frames_to_a_dead_bus_end) {
    BoardBench board;
    board.run(30);
    int looks = 0;
    CHECK_FALSE(board.controller->give_up(Reason::processor_fault, 0, [&looks] { return ++looks < 100; }));
    CHECK_TRUE(looks >= 100);
}

TEST(AnalogueController, without_the_crystals_clock_nothing_more_is_sent) {
    BoardBench board;
    board.run(30);
    board.controller->fall_silent();
    UNSIGNED_LONGS_EQUAL(1, board.can.registers.mcr);  // INRQ
    const std::size_t before = board.frames.size();
    board.run(30);
    LONGS_EQUAL(before, board.frames.size());
}

TEST(AnalogueController, the_CNC_holds_the_feed_and_falls_silent) {
    BoardBench board;
    program_status::ProgramStatusFrame status;
    status.program.programmed_feed_mm_s = 20.0F;
    for (unsigned k = 0; k < 30; ++k) {
        ++status.counter;
        board.tell_program(status);
        board.run_period();
    }
    CHECK_FALSE(board.seen_by_cnc().hold);
    board.run(130);
    CHECK_TRUE(board.seen_by_cnc().hold);
    CHECK_TRUE(board.seen_by_cnc().is_alive);
}

TEST(AnalogueController, a_fault_is_reset_by_the_CNC_at_rest) {
    BoardBench board;
    board.run(30);
    board.converter_runs = false;
    board.run(100);
    LONGS_EQUAL(control::Fault::stale_input, board.seen_by_cnc().fault);
    board.converter_runs = true;
    program_status::ProgramStatusFrame status;
    for (unsigned k = 0; k < 40; ++k) {
        ++status.counter;
        status.reset_fault = k >= 20;
        board.tell_program(status);
        board.run_period();
        if (k == 19) {
            LONGS_EQUAL(control::Fault::stale_input, board.seen_by_cnc().fault);  // latched
        }
    }
    LONGS_EQUAL(control::Fault::none, board.seen_by_cnc().fault);
    CHECK_FALSE(board.seen_by_cnc().hold);
    UNSIGNED_LONGS_EQUAL(0, BoardBench::code_of(*board.emergency(Reason::tick_fault)));
}

TEST(AnalogueController, a_late_tick_is_counted_and_not_made_up_for) {
    BoardBench board;
    board.run(10);
    const std::uint32_t before = board.controller->output().heartbeat;
    board.now_us += 7'000;
    board.controller->poll(board.now_us);
    board.controller->poll(board.now_us);
    UNSIGNED_LONGS_EQUAL(before + 1, board.controller->output().heartbeat);
    UNSIGNED_LONGS_EQUAL(1, board.controller->late_ticks());
}
