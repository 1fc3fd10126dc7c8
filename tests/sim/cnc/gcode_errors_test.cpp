// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <sstream>
#include <string>
#include <utility>

#include "parsing.hpp"

// Behind Eigen: it replaces operator new by a macro.
#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::sim;

namespace {

/// The refusal of a body whose first line is line 2 of the program.
void check_refusal(const char* body, const char* expected) {
    STRCMP_EQUAL(expected, refusal_of_body(body).c_str());
}

}  // namespace

TEST_GROUP(GcodeErrors){};

TEST(GcodeErrors, unknown_words_and_codes) {
    check_refusal("G1 X1 U2", "part.ngc:2:7: found 'U2', expected one of the words F G H I J K L M N P Q R S T X Y Z");
    check_refusal("G5 X1", "part.ngc:2:1: found 'G5', expected a code of the table in sim/cnc/README.md");
    check_refusal("G1.5 X1", "part.ngc:2:1: found 'G1.5', expected a code of the table in sim/cnc/README.md");
    CHECK(!refusal_of_body("G-1 X1").empty());
    CHECK(!refusal_of_body("G1.04 X1").empty());
    CHECK(!refusal_of_body("G99999999999999999999 X1").empty());
    check_refusal("G18\nG2 X2 J1", "part.ngc:3:7: found 'J1', expected a centre in I, K, the arc's plane");
    check_refusal("G2 X2 K1", "part.ngc:2:7: found 'K1', expected a centre in I, J, the arc's plane");
    check_refusal("G41", "part.ngc:2:1: found 'G41', expected G40: let the CAM system compensate the cutter's radius");
    check_refusal("G93", "part.ngc:2:1: found 'G93', expected G94: a feed in mm or inches per minute");
    check_refusal(
        "M98 P2",
        "part.ngc:2:1: found 'M98', expected a program without subprograms: let the CAM system post it whole");
    check_refusal("G54 G0 X1\nG55 X2",
                  "part.ngc:3:1: found 'G55', expected G54: one system of coordinates in a program");
    check_refusal("T1 M6\nG1 X1\nT2 M6",
                  "part.ngc:4:4: found 'M6', expected no other tool than T1: a scenario has one; split the program at "
                  "the change (its maps: preview --tools)");
    check_refusal("M4", "part.ngc:2:1: found 'M4', expected M3: the cutter is right-handed and cuts clockwise only");
    check_refusal("M48", "part.ngc:2:1: found 'M48', expected one of M0 M1 M2 M3 M5 M6 M7 M8 M9 M30 M52");
    check_refusal("M3.5", "part.ngc:2:1: found 'M3.5', expected one of M0 M1 M2 M3 M5 M6 M7 M8 M9 M30 M52");
    check_refusal("O100 G1",
                  "part.ngc:2:1: found 'O100', expected a program without O-words: let the CAM system post it whole");
}

TEST(GcodeErrors, an_arc_whose_way_lies_further_out_than_its_ends) {
    const auto refusal_of = [](const char* arc) { return refusal_of_body(std::string("G0 X99999\n") + arc); };
    const std::string outwards = refusal_of("G18 G2 Z8 K4");
    const std::string inwards = refusal_of("G18 G3 Z8 K4");
    CHECK_TRUE(outwards.empty() != inwards.empty());
    CHECK_TRUE((outwards + inwards).find("a way within 100000 mm of the origin") != std::string::npos);
}

TEST(GcodeErrors, two_words_of_one_group) {
    check_refusal("G0 G1 X1", "part.ngc:2:4: found 'G1', expected no second word of the group of 'G0' in one block");
    check_refusal("G1 X1 X2", "part.ngc:2:7: found 'X2', expected no second word of the group of 'X1' in one block");
    check_refusal("M3 M5", "part.ngc:2:4: found 'M5', expected no second word of the group of 'M3' in one block");
    check_refusal("G20 G21", "part.ngc:2:5: found 'G21', expected no second word of the group of 'G20' in one block");
}

TEST(GcodeErrors, words_that_are_none) {
    check_refusal("G1 X", "part.ngc:2:4: found 'X', expected a decimal number after X");
    check_refusal("G1 X Y1", "part.ngc:2:4: found 'X Y', expected a decimal number after X");
    check_refusal("G1 X-.", "part.ngc:2:4: found 'X-.', expected a decimal number after X");
    check_refusal("G1 X1 = 2", "part.ngc:2:7: found '=', expected a word: a letter followed by a number");
    check_refusal("G1 X1 \xC3\xA4", "part.ngc:2:7: found '\\xC3', expected a word: a letter followed by a number");
    check_refusal("G1 X1e5", "part.ngc:2:6: found 'e5', expected one of the words F G H I J K L M N P Q R S T X Y Z");
    check_refusal("G1 Xnan", "part.ngc:2:4: found 'Xn', expected a decimal number after X");
    check_refusal("G1 X111111111111111111111111111111111",
                  "part.ngc:2:4: found 'X111111111111111111111111111111111', expected a number of at most 32 "
                  "characters");
    check_refusal("G1 (X1", "part.ngc:2:4: found '(X1', expected a comment closed with ')' on the same line");
    check_refusal("G1 (X(1)", "part.ngc:2:6: found '(', expected ')' before another '(': comments do not nest");
    check_refusal("% X1", "part.ngc:2:3: found 'X1', expected nothing after %");
}

TEST(GcodeErrors, block_numbers) {
    check_refusal("G1 N10 X1", "part.ngc:2:4: found 'N10', expected the block number at the begin of the block");
    check_refusal("N-1 X1", "part.ngc:2:1: found 'N-1', expected a block number from 0 to 999999999");
    check_refusal("N1.5 X1", "part.ngc:2:1: found 'N1.5', expected a block number from 0 to 999999999");
}

TEST(GcodeErrors, cutting_without_feed_or_spindle) {
    STRCMP_EQUAL("part.ngc:1:12: found 'G1', expected a feed F before the first feed move",
                 refusal_of("G21 M3 S60 G1 X1\nM2").c_str());
    STRCMP_EQUAL("part.ngc:1:5: found 'G1', expected a turning spindle (M3 and S above 0) before a feed move",
                 refusal_of("F60 G1 X1\nM2").c_str());
    STRCMP_EQUAL("part.ngc:2:1: found 'X2', expected a turning spindle (M3 and S above 0) before a feed move",
                 refusal_of("F60 M3 S60 G1 X1\nX2 M5\nM2").c_str());
    check_refusal("F0", "part.ngc:2:1: found 'F0', expected a feed above 0 and at most 10000000 mm/min");
    check_refusal("F-5", "part.ngc:2:1: found 'F-5', expected a feed above 0 and at most 10000000 mm/min");
    check_refusal("F10000001", "part.ngc:2:1: found 'F10000001', expected a feed above 0 and at most 10000000 mm/min");
    check_refusal("S-1", "part.ngc:2:1: found 'S-1', expected a spindle speed from 0 to 1000000 rev/min");
}

TEST(GcodeErrors, motion_without_mode_or_out_of_reach) {
    check_refusal("X1", "part.ngc:2:1: found 'X1', expected G0, G1, G2 or G3 before it");
    check_refusal("G0 X100001", "part.ngc:2:4: found 'X100001', expected a position within 100000 mm of the origin");
    check_refusal("G20 G0 X3938", "part.ngc:2:8: found 'X3938', expected a position within 100000 mm of the origin");
    check_refusal("G0 X99999\nG91 X2", "part.ngc:3:5: found 'X2', expected a position within 100000 mm of the origin");
    check_refusal("G1 X1 I2", "part.ngc:2:7: found 'I2', expected I, J, K and R with an arc (G2, G3) only");
}

TEST(GcodeErrors, arcs_that_are_none) {
    check_refusal("G2 X1",
                  "part.ngc:2:1: found 'G2', expected an arc with a centre (I, J) or a radius (R) in the same "
                  "block");
    check_refusal("G2 X1 I1 R1",
                  "part.ngc:2:10: found 'R1', expected either a radius R or a centre I, J, not both ('I1')");
    check_refusal("G2 X10 I4",
                  "part.ngc:2:8: found 'I4', expected the same radius at the arc's start (4.0000 mm) and "
                  "end (6.0000 mm) within 0.005 mm");
    check_refusal("G2 X10 R4",
                  "part.ngc:2:8: found 'R4', expected an arc radius of at least half the distance from "
                  "start to end (5.0000 mm)");
    check_refusal("G2 X0 Y0 R4",
                  "part.ngc:2:10: found 'R4', expected an end away from the start: a full circle needs its centre as "
                  "I, J");
    check_refusal("G2 X1 R0", "part.ngc:2:7: found 'R0', expected an arc radius above 0.005 mm");
    check_refusal("G2 I0.001", "part.ngc:2:4: found 'I0.001', expected an arc radius above 0.005 mm");
    check_refusal("G2 X1 I1000001",
                  "part.ngc:2:7: found 'I1000001', expected an arc's centre or radius within 100000 mm");
}

TEST(GcodeErrors, dwells_that_are_none) {
    check_refusal("G4", "part.ngc:2:1: found 'G4', expected G4 with P, the dwell in seconds");
    check_refusal("G4 P-1", "part.ngc:2:4: found 'P-1', expected a dwell from 0 to 3600 s");
    check_refusal("G4 P3601", "part.ngc:2:4: found 'P3601', expected a dwell from 0 to 3600 s");
    check_refusal("G4 P1 X1", "part.ngc:2:7: found 'X1', expected no motion in a block with G4");
    check_refusal("G1 X1 P1", "part.ngc:2:7: found 'P1', expected P in a block with G4, G64 or M52 only");
}

TEST(GcodeErrors, a_program_that_switches_the_override_off_or_gives_no_tolerance) {
    check_refusal("M52 P0", "part.ngc:2:5: found 'P0', expected M52 P1: the override always acts here");
    check_refusal("G64 P-1", "part.ngc:2:5: found 'P-1', expected a tolerance of 0 or more");
    check_refusal("G61 P1", "part.ngc:2:5: found 'P1', expected P in a block with G4, G64 or M52 only");
}

TEST(GcodeErrors, a_truncated_file_is_told_from_a_finished_one) {
    STRCMP_EQUAL("part.ngc:3:1: found '', expected the closing % of the program", refusal_of("%\nG0 X1\n").c_str());
    STRCMP_EQUAL("part.ngc:1:1: found '', expected the closing % of the program", refusal_of("").c_str());
    const std::string whole = "%\r\nM3 S600 F600\r\nG1 X1 Y2\r\nG2 X3 Y2 I1\r\nG0 Z5\r\nM30\r\n";
    const std::size_t end = whole.find("30\r\n");
    for (std::size_t length = 0; length < end + 1; ++length) {
        CHECK(!refusal_of(whole.substr(0, length)).empty());
    }
    CHECK(read_gcode("G0 X1", "part.ngc").notes.at(0).ends_with("no M2 or M30"));  // no %: none is awaited
    STRCMP_EQUAL("", refusal_of(whole.substr(0, end + 2)).c_str());
}

TEST(GcodeErrors, programs_beyond_the_largest_number_of_moves) {
    const auto count_of = [](std::size_t max_moves) {
        try {
            const GcodeSettings settings{.start_mm = Eigen::Vector3d::Zero(), .max_moves = max_moves};
            parse_gcode("G0 X1\nX2\nX3\nM2", "part.ngc", settings);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    STRCMP_EQUAL("", count_of(3).c_str());
    STRCMP_EQUAL("part.ngc:3:1: found 'X3', expected a program of at most 2 moves", count_of(2).c_str());
}

TEST(GcodeErrors, a_stream_that_breaks_is_refused) {
    std::istringstream stream("G0 X1\nM2\n");
    stream.setstate(std::ios::badbit);
    try {
        read_gcode(stream, "part.ngc");
        FAIL("expected a refusal");
    } catch (const InputError& error) {
        STRCMP_EQUAL("part.ngc: found a read error, expected a readable part program", error.what());
    }
}

TEST(GcodeErrors, drilling_cycles_that_are_none) {
    check_refusal("G81 X1 Z-2", "part.ngc:2:5: found 'X1', expected Z and R with the first hole of a cycle");
    check_refusal("G81 X1 Z2 R1", "part.ngc:2:5: found 'X1', expected R above Z");
    check_refusal("G83 X1 Z-2 R1", "part.ngc:2:5: found 'X1', expected a peck Q above 0 with G73 and G83");
    check_refusal("G81 X1 Z-2 R1 L3", "part.ngc:2:15: found 'L3', expected L1: one hole for each block");
    check_refusal("G81 X1 Z-2 R1\nG80\nX2", "part.ngc:4:1: found 'X2', expected G0, G1, G2 or G3 before it");
}
