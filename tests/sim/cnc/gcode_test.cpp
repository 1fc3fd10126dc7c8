// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "parsing.hpp"

// Behind Eigen: it replaces operator new by a macro.
#include <CppUTest/TestHarness.h>

using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;

void check_near(const Eigen::Vector3d& expected, const Eigen::Vector3d& found) {
    DOUBLES_EQUAL(0.0, (expected - found).norm(), 1e-9);
}

double way_of(const std::vector<Move>& moves, std::size_t from) {
    double way_mm = 0.0;
    for (std::size_t k = from; k < moves.size(); ++k) {
        way_mm += length_mm(moves[k]);
    }
    return way_mm;
}

}  // namespace

TEST_GROUP(Gcode){};

TEST(Gcode, rapids_and_feeds_are_modal_and_moves_join) {
    const auto moves = parse_body("G0 X1 Y2 Z3\nX4\nG1 Z-1\nX0 Y0");
    LONGS_EQUAL(4, moves.size());
    CHECK(moves[1].kind == MoveKind::rapid);
    CHECK(moves[3].kind == MoveKind::feed_line);
    check_near({1, 2, 3}, moves[0].end_mm);
    check_near({4, 2, 3}, moves[1].end_mm);
    check_near({4, 2, -1}, moves[2].end_mm);
    check_near({0, 0, -1}, moves[3].end_mm);
    DOUBLES_EQUAL(0.0, moves[1].feed_mm_s, 0.0);
    DOUBLES_EQUAL(10.0, moves[3].feed_mm_s, 1e-12);
    LONGS_EQUAL(5, moves[3].line);
}

TEST(Gcode, the_tool_starts_where_the_settings_say) {
    const auto moves = parse_gcode("G0 X1\nM2", "part.ngc");
    check_near({0, 0, 50}, moves[0].start_mm);
    check_near({1, 0, 50}, moves[0].end_mm);
}

TEST(Gcode, arcs_turn_clockwise_with_g2_and_counter_clockwise_with_g3) {
    const auto moves = parse_body("G1 X10\nG3 X0 Y10 I-10 J0\nG2 X10 Y0 I0 J-10");
    CHECK(moves[1].kind == MoveKind::arc_ccw);
    CHECK(moves[2].kind == MoveKind::arc_cw);
    for (const std::size_t k : {1U, 2U}) {
        check_near({0, 0, 0}, {moves[k].centre_mm.x(), moves[k].centre_mm.y(), 0.0});
        DOUBLES_EQUAL(pi / 2.0, arc_sweep_rad(moves[k]), 1e-12);
        check_near({10.0 * std::sqrt(0.5), 10.0 * std::sqrt(0.5), 0.0},
                   position_at(moves[k], 0.5 * length_mm(moves[k])));
    }
    check_near({0, 1, 0}, direction_at(moves[1], 0.0));
    check_near({1, 0, 0}, direction_at(moves[2], 0.0));
}

TEST(Gcode, an_arc_that_ends_where_it_starts_is_a_full_circle) {
    const auto moves = parse_body("G2 I5");
    LONGS_EQUAL(1, moves.size());
    DOUBLES_EQUAL(10.0 * pi, length_mm(moves[0]), 1e-9);
}

TEST(Gcode, a_full_circle_stays_one_where_relative_sums_do_not_close_exactly) {
    const auto moves = parse_body("G91\nG1 X0.1\nX0.2\nG90 G3 X0.3 I2");
    DOUBLES_EQUAL(4.0 * pi, length_mm(moves.back()), 1e-6);
}

TEST(Gcode, a_radius_takes_the_short_way_and_a_negative_one_the_long) {
    const auto moves = parse_body("G2 X10 Y10 R10\nG0 X0 Y0\nG2 X10 Y10 R-10\nG0 X0 Y0\nG3 X10 Y10 R10");
    DOUBLES_EQUAL(pi / 2.0, arc_sweep_rad(moves[0]), 1e-9);
    DOUBLES_EQUAL(1.5 * pi, arc_sweep_rad(moves[2]), 1e-9);
    DOUBLES_EQUAL(pi / 2.0, arc_sweep_rad(moves[4]), 1e-9);
    check_near({10, 0, 0}, {moves[0].centre_mm.x(), moves[0].centre_mm.y(), 0.0});
    check_near({0, 10, 0}, {moves[2].centre_mm.x(), moves[2].centre_mm.y(), 0.0});
    check_near({0, 10, 0}, {moves[4].centre_mm.x(), moves[4].centre_mm.y(), 0.0});
}

TEST(Gcode, an_arc_with_z_is_a_helix) {
    const auto moves = parse_body("G3 X0 Y0 Z-2 I3 J4");
    LONGS_EQUAL(1, moves.size());
    DOUBLES_EQUAL(std::hypot(10.0 * pi, 2.0), length_mm(moves[0]), 1e-9);
    check_near({6, 8, -1}, position_at(moves[0], 0.5 * length_mm(moves[0])));
}

TEST(Gcode, an_arc_in_an_upright_plane_is_lines_that_keep_to_it) {
    // Seen from where the third axis points to: z to x and y to z are counter-clockwise.
    const std::array programs{"G1 X0 Y0 Z3\nG18 G3 X3 Z0 K-3", "G1 X0 Y0 Z3\nG18 G3 X3 Z0 R3",
                              "G1 X0 Y0 Z3\nG19 G2 Y3 Z0 J0 K-3"};
    for (const char* program : programs) {
        const auto moves = parse_body(program);
        double way = 0.0;
        for (std::size_t k = 1; k < moves.size(); ++k) {
            CHECK(moves[k].kind == MoveKind::feed_line);
            check_near(moves[k - 1].end_mm, moves[k].start_mm);
            DOUBLES_EQUAL(3.0, moves[k].end_mm.norm(), 1e-9);
            DOUBLES_EQUAL(3.0, position_at(moves[k], 0.5 * length_mm(moves[k])).norm(), 0.001);
            way += length_mm(moves[k]);
        }
        DOUBLES_EQUAL(1.5 * pi, way, 0.01);
        DOUBLES_EQUAL(0.0, moves.back().end_mm.z(), 1e-9);
    }
    DOUBLES_EQUAL(4.5 * pi, way_of(parse_body("G1 X0 Y0 Z3\nG18 G2 X3 Z0 K-3"), 1), 0.01);
}

TEST(Gcode, an_upright_arc_may_be_a_full_circle_or_a_helix) {
    const auto moves = parse_body("G1 X0 Y0 Z3\nG18 G2 X0 Y4 Z3 K-3");
    DOUBLES_EQUAL(std::hypot(6.0 * pi, 4.0), way_of(moves, 1), 0.01);
    check_near({0, 4, 3}, moves.back().end_mm);
}

TEST(Gcode, positions_and_tangents_along_every_kind_of_move_agree) {
    const auto moves = parse_body("G1 X3 Y1 Z-1\nG2 X8 Y1 I2.5\nG3 X3 Y6 Z2 R5\nG2 X3.003 Y6 I4");
    for (const Move& move : moves) {
        const double length = length_mm(move);
        check_near(move.start_mm, position_at(move, 0.0));
        check_near(move.start_mm, position_at(move, -1.0));
        CHECK(move.end_mm == position_at(move, length));
        CHECK(move.end_mm == position_at(move, length + 1.0));
        for (const double share : {0.1, 0.5, 0.9}) {
            const double s = share * length;
            const Eigen::Vector3d chord = (position_at(move, s + 1e-5) - position_at(move, s - 1e-5)) / 2e-5;
            DOUBLES_EQUAL(0.0, (chord - direction_at(move, s)).norm(), 1e-3);
            DOUBLES_EQUAL(1.0, chord.norm(), 1e-3);
        }
    }
}

TEST(Gcode, dwells_take_seconds) {
    const auto moves = parse_body("G4 P0.25\nG1 X1\nG4 P0\nG4 P2");
    LONGS_EQUAL(3, moves.size());
    CHECK(moves[0].kind == MoveKind::dwell);
    DOUBLES_EQUAL(0.25, moves[0].dwell_s, 0.0);
    DOUBLES_EQUAL(0.0, length_mm(moves[0]), 0.0);
    check_near({1, 0, 0}, moves[2].start_mm);
}

TEST(Gcode, inches_act_on_the_block_that_names_them_feed_included) {
    const auto moves = parse_body("G1 X25.4\nG20 X2 F60\nG21 X0\nG20.0 X1 F1");
    check_near({50.8, 0, 0}, moves[1].end_mm);
    DOUBLES_EQUAL(25.4, moves[1].feed_mm_s, 1e-12);
    check_near({0, 0, 0}, moves[2].end_mm);
    check_near({25.4, 0, 0}, moves[3].end_mm);
}

TEST(Gcode, a_code_within_rounding_of_its_number_means_that_number) {
    const auto moves = parse_body("G20.00000001 G1 X1\nG91.00000001 X1");
    check_near({25.4, 0, 0}, moves[0].end_mm);
    check_near({50.8, 0, 0}, moves[1].end_mm);
}

TEST(Gcode, relative_moves_add_up_and_absolute_ones_do_not) {
    const auto moves = parse_body("G91 G1 X1 Y1\nX1\nG90 X0\nG91 G2 X2 I1");
    check_near({2, 1, 0}, moves[1].end_mm);
    check_near({0, 1, 0}, moves[2].end_mm);
    check_near({2, 1, 0}, moves[3].end_mm);
}

TEST(Gcode, codes_without_effect_have_none) {
    const auto moves = parse_body("G17 G21 G40 G49 G54 G80 G90 G94 G1 X1");
    LONGS_EQUAL(1, moves.size());
    check_near({1, 0, 0}, moves[0].end_mm);
}

TEST(Gcode, feed_and_spindle_act_before_the_motion_whatever_the_order_of_the_words) {
    const auto moves = parse("X1 G1 F120 S1200 M3\nM5 G0 X2\nM30");
    DOUBLES_EQUAL(2.0, moves[0].feed_mm_s, 1e-12);
    DOUBLES_EQUAL(40.0 * pi, moves[0].spindle_speed_rad_s, 1e-9);
    DOUBLES_EQUAL(0.0, moves[1].spindle_speed_rad_s, 0.0);
}

TEST(Gcode, what_follows_the_end_is_not_read) {
    for (const char* end : {"M2\n?? rubbish (\n", "M30\n?? rubbish (", "%\n?? rubbish (", "m2"}) {
        const auto moves = parse(fmt::format("G0 X1\n{}", end));
        LONGS_EQUAL(1, moves.size());
    }
    LONGS_EQUAL(1, parse("%\nG0 X1\n%\n?").size());
    LONGS_EQUAL(2, parse("%\nG0 X1\nG0 X2 M2\n?").size());
}

TEST(Gcode, numbers_comments_deleted_blocks_blanks_and_cases_are_no_matter) {
    const auto expected = parse_body("G1 X1.5 Y-2");
    for (const char* body :
         {"N10 G1 X1.5 Y-2", "g1x1.5y-2", "  G 1\tX +1.5 Y -2 ", "G01 X01.50 Y-02.", "(a) G1 (b) X1.5 Y-2 ; c (",
          "/G1 X99\nG1 X1.5 Y-2", "G1 X1.5 Y-2 ( \x01\xFF )", "\n\n  \n;\nG1 X1.5 Y-2", "N999999999G1X1.5Y-2"}) {
        const auto moves = parse_body(body);
        LONGS_EQUAL(1, moves.size());
        CHECK(moves[0].end_mm == expected[0].end_mm);
    }
}

TEST(Gcode, a_byte_order_mark_and_crlf_are_skipped) {
    const auto moves = parse("\xEF\xBB\xBF%\r\nG0 X1\r\nG1 F60 S1 M3 X2\r\nM2\r\n");
    LONGS_EQUAL(2, moves.size());
    LONGS_EQUAL(3, moves[1].line);
}

TEST(Gcode, path_modes_and_the_switch_of_the_override_change_nothing) {
    for (const char* body : {"G64 P0.01\nM52 P1\nG1 X1", "G61\nM52\nG1 X1", "G64\nG1 X1", "G64 P0.01 G1 X1"}) {
        const auto moves = parse_body(body);
        LONGS_EQUAL(1, moves.size());
        CHECK(moves[0].end_mm == Eigen::Vector3d(1.0, 0.0, 0.0));
    }
}

TEST(Gcode, moves_without_length_are_left_out) {
    LONGS_EQUAL(0, parse_body("G1 X0 Y0\nG0 Z0").size());
}

TEST(Gcode, a_stream_reads_the_same_as_a_text) {
    std::string text = "G0 X1\n";
    for (int k = 0; k < 20000; ++k) {
        text += fmt::format("X{} Y{}\n", k % 7, k);
    }
    text += "M2\n";
    std::istringstream stream(text);
    const auto from_stream = read_gcode(stream, "part.ngc").moves;
    const auto from_text = parse_gcode(text, "part.ngc");
    LONGS_EQUAL(20001, from_stream.size());
    LONGS_EQUAL(from_text.size(), from_stream.size());
    CHECK(from_text.back().end_mm == from_stream.back().end_mm);
}
