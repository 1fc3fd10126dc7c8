// SPDX-License-Identifier: Apache-2.0
#include "parsing.hpp"

#include <CppUTest/TestHarness.h>

#include <numbers>

/// Programs as the posts of CAM systems write them, and what they must come to.

using namespace millforce::sim;

namespace {

struct Sums {
    double cut_mm = 0.0;     ///< way at a feed
    double lowest_mm = 1e9;  ///< at a feed
    double rapid_lowest_mm = 1e9;
    int plunges = 0;  ///< feeds straight down
    Eigen::Vector3d end_mm = Eigen::Vector3d::Zero();
};

Sums sums_of(const GcodeProgram& program) {
    Sums sums;
    for (const Move& move : program.moves) {
        const double low_mm = std::min(move.start_mm.z(), move.end_mm.z());
        if (move.kind == MoveKind::rapid) {
            sums.rapid_lowest_mm = std::min(sums.rapid_lowest_mm, low_mm);
        } else if (move.kind != MoveKind::dwell) {
            sums.cut_mm += length_mm(move);
            sums.lowest_mm = std::min(sums.lowest_mm, low_mm);
            const Eigen::Vector3d way = move.end_mm - move.start_mm;
            sums.plunges += way.head<2>().norm() < 1e-9 && way.z() < 0.0 ? 1 : 0;
        }
        sums.end_mm = move.end_mm;
    }
    return sums;
}

GcodeProgram read(const char* text) {
    return read_gcode(text, "part.ngc");
}

bool has_note(const GcodeProgram& program, std::string_view part) {
    for (const std::string& note : program.notes) {
        if (note.find(part) != std::string::npos) {
            return true;
        }
    }
    return false;
}

constexpr double pi = std::numbers::pi;

}  // namespace

TEST_GROUP(GcodePosts){};

TEST(GcodePosts, a_general_linuxcnc_post_with_tool_change_and_length_offset) {
    const GcodeProgram program = read(
        "(begin preamble)\nG17 G54 G40 G49 G80 G90\nG21\n(begin toolchange: T1)\nM5\nM6 T1\nG43 H1\nM3 S8000\n"
        "G0 Z5.000\nG0 X0.000 Y0.000\nG1 Z-2.000 F120.000\nG1 X40.000 F600\nG1 Y20.000\nG0 Z5\nM5\nG17 G54 G90 G80 "
        "G40\nM2\n");
    const Sums sums = sums_of(program);
    DOUBLES_EQUAL(7.0 + 40.0 + 20.0, sums.cut_mm, 1e-9);
    DOUBLES_EQUAL(-2.0, sums.lowest_mm, 0.0);
    CHECK(has_note(program, "part.ngc:6: M6: the tool is the scenario's"));
    CHECK(has_note(program, "G43: coordinates are those of the tool's tip"));
}

TEST(GcodePosts, one_with_arc_modes_machine_coordinates_coolant_and_a_retract) {
    const GcodeProgram program = read(
        "%\n(1001)\n(T1 D=10 CR=0 - ZMIN=-3 - flat end mill)\nG90 G94 G17 G91.1\nG21\nG53 G0 Z0\n\n(2D Contour1)\nM9\n"
        "T1 M6\nS6000 M3\nG54\nM8\nG0 X10 Y0\nG43 Z15 H1\nG0 Z5\nG1 Z-3 F300\nG18 G1 X20 F900\nG17 G3 X30 Y10 I0 J10\n"
        "G1 Z15\nM9\nG53 G0 Z0\nM30\n%\n");
    const Sums sums = sums_of(program);
    DOUBLES_EQUAL(8.0 + 10.0 + std::hypot(10.0, 0.0) * pi / 2.0 + 18.0, sums.cut_mm, 1e-9);
    DOUBLES_EQUAL(50.0, sums.end_mm.z(), 0.0);  // the height of the start
    CHECK(has_note(program, "part.ngc:6: G28, G30, G53: a rapid straight up"));
    CHECK(has_note(program, "coolant is not simulated"));
}

TEST(GcodePosts, one_for_small_controllers_without_an_end) {
    const GcodeProgram program =
        read("G90\nG21\nM3 S10000\nG0 X0Y0\nG0 Z2\nG1 Z-1 F200\nG1 X10 F400\nG1 Y10\nG0 Z5\nM5\n");
    DOUBLES_EQUAL(3.0 + 20.0, sums_of(program).cut_mm, 1e-9);
    LONGS_EQUAL(1, program.notes.size());
    CHECK(has_note(program, "part.ngc:10: the program ends with its file"));
}

TEST(GcodePosts, holes_are_drilled_one_for_each_block_and_the_tool_returns_to_R_between_them) {
    const GcodeProgram program = read(
        "%\nO2002 (DRILLING)\nN10 G00 G17 G40 G49 G80 G90\nN20 T1 M06\nN30 G54 G90 S2000 M03\nN40 G43 H01 Z25. M08\n"
        "N50 X10. Y10.\nN60 G99 G81 Z-8. R2. F150.\nN70 X30.\nN80 Y30.\nN90 G80\nN100 G00 Z25. M09\nN110 G91 G28 Z0\n"
        "N120 M30\n%\n");
    const Sums sums = sums_of(program);
    LONGS_EQUAL(3, sums.plunges - 0);
    DOUBLES_EQUAL(30.0, sums.cut_mm, 1e-9);
    DOUBLES_EQUAL(50.0, sums.end_mm.z(), 0.0);
    std::size_t at_R = 0;
    for (const Move& move : program.moves) {
        at_R += move.kind == MoveKind::rapid && move.end_mm.z() == 2.0 && move.start_mm.z() == -8.0 ? 1U : 0U;
    }
    LONGS_EQUAL(3, at_R);
}

TEST(GcodePosts, a_peck_cycle_lifts_to_R_and_a_chip_breaker_a_little) {
    for (const char* cycle : {"G83", "G73"}) {
        const std::string text =
            fmt::format("G21 G90 S2000 M3 F100\nG0 X5 Y5 Z10\nG98 {} Z-10 R1 Q4\nG80\nM2\n", cycle);
        const GcodeProgram program = read(text.c_str());
        const Sums sums = sums_of(program);
        LONGS_EQUAL(3, sums.plunges);                       // 1 → −3 → −7 → −10
        DOUBLES_EQUAL(11.0 + 2 * 0.25, sums.cut_mm, 1e-9);  // the two lifts are cut again at the feed
        DOUBLES_EQUAL(10.0, sums.end_mm.z(), 0.0);
    }
}

TEST(GcodePosts, a_dwell_at_the_bottom_takes_its_time) {
    const GcodeProgram program = read("S2000 M3 F100\nG0 Z5\nG82 X1 Y1 Z-2 R1 P0.5\nG80\nM2\n");
    double dwell_s = 0.0;
    for (const Move& move : program.moves) {
        dwell_s += move.dwell_s;
    }
    DOUBLES_EQUAL(0.5, dwell_s, 0.0);
}

TEST(GcodePosts, relative_cycles_count_R_from_the_tool_and_Z_from_R) {
    const GcodeProgram program = read("S2000 M3 F100\nG0 X0 Y0 Z10\nG91 G81 X5 Z-6 R-8\nX5\nG80 G90\nM2\n");
    const Sums sums = sums_of(program);
    LONGS_EQUAL(2, sums.plunges);
    DOUBLES_EQUAL(-4.0, sums.lowest_mm, 1e-12);
    DOUBLES_EQUAL(10.0, sums.end_mm.x(), 1e-12);
}

TEST(GcodePosts, a_helical_ramp_in_inches) {
    const GcodeProgram program =
        read("G20 G90 G17\nT3 M6\nS4000 M3\nG0 X0.5 Y0 Z0.1\nG1 Z0 F10\nG2 X0.5 Y0 Z-0.05 I-0.5 J0 F20\nG0 Z1\nM30\n");
    const Sums sums = sums_of(program);
    DOUBLES_EQUAL(-0.05 * 25.4, sums.lowest_mm, 1e-9);
    DOUBLES_EQUAL(2.54 + 25.4 * std::hypot(pi, 0.05), sums.cut_mm, 1e-6);
}

TEST(GcodePosts, a_roughing_path_of_short_lines_in_relative_coordinates) {
    std::string text = "G21 G90 S5000 M3 F1000\nG0 X0 Y0 Z1\nG1 Z-1\nG91\n";
    for (int k = 0; k < 100; ++k) {
        text += fmt::format("G1 X0.5 Y{}\n", k % 2 == 0 ? "0.2" : "-0.2");
    }
    const GcodeProgram program = read((text + "G90 G0 Z5\nM30\n").c_str());
    DOUBLES_EQUAL(2.0 + 100.0 * std::hypot(0.5, 0.2), sums_of(program).cut_mm, 1e-9);
}

TEST(GcodePosts, leads_in_and_out_on_upright_arcs) {
    const GcodeProgram program = read(
        "%\n(ADAPTIVE WITH VERTICAL LEADS)\nG90 G94 G17 G91.1\nG21\nT1 M6\nS8000 M3\nG54\nG0 X10 Y5\nZ5\nG1 Z2 F500\n"
        "G18 G2 X11 Z1 I1 K0\nG1 X30\nG17 G3 X32 Y7 I0 J2\nG1 Y20\nG19 G3 Y21 Z2 J0 K1\nG0 Z15\nG17\nM30\n%\n");
    const Sums sums = sums_of(program);
    DOUBLES_EQUAL(1.0, sums.lowest_mm, 1e-9);
    DOUBLES_EQUAL(3.0 + 0.5 * pi + 19.0 + pi + 13.0 + 0.5 * pi, sums.cut_mm, 0.01);
}

TEST(GcodePosts, an_optional_stop_and_a_work_offset_other_than_the_first) {
    const GcodeProgram program =
        read("O0001\nG21\nG55 G90 G0 X0 Y0 Z5\nM1\nS3000 M3\nG1 Z-1 F100\nX10\nM0\nG55 G0 Z5\nM2\n");
    DOUBLES_EQUAL(16.0, sums_of(program).cut_mm, 1e-9);
    CHECK(has_note(program, "M0, M1: the program goes on at once"));
}

TEST(GcodePosts, the_same_tool_called_for_again_is_no_change) {
    const GcodeProgram program = read("T4 M6\nS3000 M3 F100\nG0 Z1\nG1 Z-1\nG0 Z5\nT4 M6\nG1 Z-2\nT5\nG0 Z5\nM2\n");
    DOUBLES_EQUAL(2.0 + 7.0, sums_of(program).cut_mm, 1e-9);
}
