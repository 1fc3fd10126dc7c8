// SPDX-License-Identifier: Apache-2.0
#include "faults/campaign.hpp"

#include <CppUTest/TestHarness.h>

#include <array>

#include "control/cut_state.hpp"

using namespace millforce::faults;

TEST_GROUP(SignalFaults) {
    const std::array<Part, 3> parts{part_named("slot_entry"), part_named("depth_ramp"),
                                    part_named("width_step:spindle")};
};

TEST(SignalFaults, break_no_tooth_whenever_they_begin) {
    std::uint64_t seed = 0;
    for (int k = 1; k < signal_faults; ++k) {
        const auto fault = static_cast<SignalFault>(k);
        for (const Part& part : parts) {
            const Outcome outcome = mill_with(part, Path::tick, fault, ++seed);
            CHECK_TEXT(is_unseen(fault, part) || outcome.run.figures.teeth_broken == 0, name_of(fault));
        }
    }
}

TEST(SignalFaults, that_look_like_another_cut_break_no_tooth_where_the_depth_may_step) {
    const std::array<Part, 2> undeclared{part_named("depth_ramp:undeclared"), part_named("slot_entry:undeclared")};
    for (const SignalFault fault : {SignalFault::spindle_fair, SignalFault::currents_halved, SignalFault::spindle_fades,
                                    SignalFault::spindle_drifts, SignalFault::x_drifts}) {
        for (const Part& part : undeclared) {
            for (std::uint64_t seed = 70'010; seed < 70'015; ++seed) {
                const Outcome outcome = mill_with(part, Path::tick, fault, seed);
                LONGS_EQUAL_TEXT(0, outcome.run.figures.teeth_broken, name_of(fault));
            }
        }
    }
}

TEST(SignalFaults, stop_the_feed_within_a_tenth_of_a_second_where_there_is_no_force_left) {
    for (const SignalFault fault : {SignalFault::spindle_weak, SignalFault::spindle_dead, SignalFault::spindle_frozen,
                                    SignalFault::spindle_absent, SignalFault::encoder_double,
                                    SignalFault::encoder_absent, SignalFault::not_a_number, SignalFault::time_frozen}) {
        const Outcome outcome = mill_with(parts[1], Path::tick, fault, 3);  // begins in the cut
        CHECK_TEXT(outcome.reaction.has_reacted && outcome.reaction.after_s < 0.1, name_of(fault));
    }
}

TEST(SignalFaults, of_a_load_that_stands_still_in_the_cut_are_found_by_a_question_within_four_seconds) {
    struct InTheCut {
        const char* part;
        std::uint64_t seed;
    };
    for (const InTheCut& run : {InTheCut{"slot_entry:vfd", 8}, {"depth_ramp:vfd", 1}, {"width_step:vfd", 3}}) {
        const Part part = part_named(run.part);
        const Outcome outcome = mill_with(part, Path::tick, SignalFault::spindle_frozen, run.seed);
        CHECK_TEXT(outcome.reaction.has_reacted && outcome.reaction.after_s < 4.0, run.part);
        LONGS_EQUAL_TEXT(millforce::control::Fault::signal_stuck, outcome.reaction.fault, run.part);
        CHECK_FALSE_TEXT(mill_with(part, Path::tick, SignalFault::none, run.seed).reaction.has_reacted, run.part);
    }
}

TEST(SignalFaults, of_a_bus_or_a_link_break_no_tooth_and_leave_no_feed_free_where_nothing_is_known) {
    std::uint64_t seed = 500;
    for (const Path path : {Path::can, Path::link}) {
        for (const Fault& fault : faults_on(path, parts[0])) {
            if (std::holds_alternative<SignalFault>(fault)) {
                continue;
            }
            Tally tally;
            tally.add(mill_with(parts[0], path, fault, ++seed));
            LONGS_EQUAL_TEXT(0, tally.violations(), name_of(fault));
        }
    }
}

TEST(SignalFaults, are_not_seen_where_there_are_none) {
    for (const Part& part : parts) {
        for (std::uint64_t seed = 100; seed < 104; ++seed) {
            const Outcome outcome = mill_with(part, Path::tick, SignalFault::none, seed);
            CHECK(outcome.run.figures.peak_over_limit > 0.5);
            CHECK_FALSE(outcome.reaction.has_reacted);
        }
    }
}

TEST(SignalFaults, that_are_put_right_let_the_part_go_on_after_the_reset) {
    constexpr bool is_repaired = true;
    std::uint64_t seed = 700;
    for (const Path path : {Path::tick, Path::can, Path::link}) {
        for (const SignalFault fault : {SignalFault::spindle_dead, SignalFault::spindle_weak, SignalFault::y_tenfold,
                                        SignalFault::velocities_huge, SignalFault::encoder_half,
                                        SignalFault::encoder_frozen, SignalFault::rapid_stuck}) {
            Tally tally;
            tally.add(mill_with(parts[1], path, fault, ++seed, is_repaired));
            CHECK_EQUAL_TEXT(tally.repaired, tally.milled_on, name_of(fault));
            LONGS_EQUAL_TEXT(0, tally.violations(), name_of(fault));
        }
    }
}

TEST(SignalFaults, such_as_a_feed_hold_leave_the_force_at_its_limit_once_it_is_released) {
    constexpr bool is_released = true;
    for (const Part& part : {parts[1], parts[2]}) {
        Tally tally;
        for (std::uint64_t seed = 800; seed < 820; ++seed) {
            tally.add(mill_with(part, Path::tick, SignalFault::hold_stuck, seed, is_released));
        }
        CHECK(tally.runs > 10);
        LONGS_EQUAL(tally.runs, tally.milled_on);
        CHECK_COMPARE(tally.largest_peak, <, 1.15);
    }
}
