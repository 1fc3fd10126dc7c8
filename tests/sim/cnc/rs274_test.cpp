// SPDX-License-Identifier: Apache-2.0
#include "cnc/rs274.hpp"

#include <filesystem>
#include <fstream>

#include "parsing.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::sim;

namespace {

/// A program in a file of its own.
class ProgramFile {
  public:
    explicit ProgramFile(std::string_view text)
        : name_((std::filesystem::temp_directory_path() / fmt::format("millforce-{}.ngc", ::getpid())).string()) {
        std::ofstream(name_) << text;
    }
    ~ProgramFile() { std::filesystem::remove(name_); }
    ProgramFile(const ProgramFile&) = delete;
    ProgramFile& operator=(const ProgramFile&) = delete;
    [[nodiscard]] const std::string& name() const { return name_; }

  private:
    std::string name_;
};

std::string refusal_by_rs274(std::string_view text) {
    const ProgramFile file(text);
    try {
        read_by_rs274(file.name());
    } catch (const millforce::host::InputError& error) {
        return error.what();
    }
    return "";
}

bool contains(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

double way_mm(const GcodeProgram& program, MoveKind kind) {
    double sum = 0.0;
    for (const Move& move : program.moves) {
        sum += move.kind == kind ? length_mm(move) : 0.0;
    }
    return sum;
}

}  // namespace

TEST_GROUP(Canonical){};

TEST(Canonical, commands_become_moves_with_feed_speed_and_units) {
    const GcodeProgram program = moves_of_canonical(
        "    7 N..... SET_FEED_RATE(600.0000)\n    8 N..... SET_SPINDLE_SPEED(0, 3000.0000)\n    9 N..... "
        "START_SPINDLE_CLOCKWISE(0)\n   11 N..... STRAIGHT_TRAVERSE(0.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
        "   12 N10 STRAIGHT_FEED(7.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n   25 N..... ARC_FEED(9.0000, "
        "2.0000, "
        "7.0000, 2.0000, 1, 4.0000, 0.0000, 0.0000, 0.0000)\n   26 N..... DWELL(0.5000)\n   27 N..... "
        "USE_LENGTH_UNITS(CANON_UNITS_INCHES)\n   28 N..... STRAIGHT_FEED(1.0000, 0.0000, 0.0000, 0, 0, 0)\n",
        "part.ngc", {.start_mm = {0.0, 0.0, 50.0}});
    LONGS_EQUAL(5, program.moves.size());
    CHECK(program.moves[0].kind == MoveKind::rapid);
    DOUBLES_EQUAL(10.0, program.moves[1].feed_mm_s, 1e-12);
    DOUBLES_EQUAL(314.159, program.moves[1].spindle_speed_rad_s, 0.001);
    CHECK(program.moves[2].kind == MoveKind::arc_ccw);
    DOUBLES_EQUAL(4.0, program.moves[2].end_mm.z(), 0.0);
    DOUBLES_EQUAL(std::hypot(2.0 * 3.14159265 / 2.0, 1.0), length_mm(program.moves[2]), 1e-6);
    DOUBLES_EQUAL(0.5, program.moves[3].dwell_s, 0.0);
    DOUBLES_EQUAL(25.4, program.moves[4].end_mm.x(), 1e-12);
}

TEST(Canonical, what_the_plant_does_not_have_and_rubbish_are_refused_or_skipped) {
    const auto refusal = [](std::string_view text) {
        try {
            moves_of_canonical(text, "part.ngc");
        } catch (const millforce::host::InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(contains(refusal("1 N..... STRAIGHT_FEED(1, 0, 0, 0, 0, 0)"), "a feed move without F"));
    CHECK(contains(refusal("1 N..... START_SPINDLE_COUNTERCLOCKWISE(0)"), "expected M3"));
    CHECK(contains(refusal("1 N..... STRAIGHT_TRAVERSE(1, x, 0)"), "expected a number as argument 2"));
    CHECK(contains(refusal("1 N..... STRAIGHT_TRAVERSE(1)"), "expected a number as argument 2"));
    CHECK(contains(refusal("1 N..... STRAIGHT_TRAVERSE(1e9, 0, 0)"), "beyond 100000 mm"));
    CHECK(contains(refusal("1 N..... RIGID_TAP(1, 0, 0)"), "RIGID_TAP"));
    CHECK(contains(refusal("1 N..... SET_FEED_RATE(1e308)"), "a feed of 1e+308 mm/min"));
    CHECK(contains(refusal("1 N..... CHANGE_TOOL(1e30)"), "expected one from 0 to 4294967295"));
    CHECK(contains(refusal("1 N..... CHANGE_TOOL(-1)"), "tool -1"));
    CHECK(contains(refusal("1 N..... SET_SPINDLE_SPEED(0, 1e7)"), "a spindle speed of 10000000 rev/min"));
    CHECK(contains(refusal("1 N..... DWELL(-1)"), "a dwell of -1 s"));
    CHECK(contains(refusal("1 N..... DWELL(1e9)"), "a dwell of 1000000000 s"));
    CHECK(contains(refusal("1 N..... STRAIGHT_FEED(\x1b[31m)"), "STRAIGHT_FEED(?[31m)"));
    for (const char* rubbish : {"", "(", ")(", "COMMENT(\"STRAIGHT_FEED(1\")", "\x01\xFF\n\n  )", "executing"}) {
        STRCMP_EQUAL("", refusal(rubbish).c_str());
    }
}

TEST_GROUP(Rs274){};

TEST(Rs274, reads_subroutines_and_variables) {
    if (!has_rs274()) {
        return;  // LinuxCNC is not installed: its cases are those of the tier `linuxcnc`
    }
    const ProgramFile file(
        "o100 sub\nG1 X[#1*2] F300\no100 endsub\nG21 G90 S2000 M3\nG0 X0 Y0 Z5\n#5=3\no100 call [#5]\no100 call "
        "[7]\nM2\n");
    const GcodeProgram program = read_by_rs274(file.name());
    DOUBLES_EQUAL(14.0, way_mm(program, MoveKind::feed_line), 1e-9);
    CHECK(contains(program.notes.at(0), "read by LinuxCNC's interpreter, rs274, without line numbers"));
}

TEST(Rs274, comes_to_the_same_moves_as_our_own_reader) {
    if (!has_rs274()) {
        return;
    }
    for (const char* text :
         {"G21 G90 S2000 M3 F300\nG0 X0 Y0 Z5\nG1 Z-1\nX20\nG2 X30 Y-10 I0 J-10\nG3 X40 Y-20 R10\nG0 Z5\nM2\n",
          "G21 G90 S2000 M3 F300\nG0 X0 Y0 Z10\nG99 G81 X5 Y5 Z-4 R2\nX15\nG98 G83 X20 Z-6 R2 Q3\nG80\nM2\n",
          "G21 G90 S2000 M3 F300\nG0 X0 Y0 Z5\nG18 G2 X3 Z2 K-3\nG3 X0 Y2 Z5 I-3\nG19 G3 Y5 Z2 J0 K-3\nG17\nM2\n",
          "G20 G90 S2000 M3\nF10\nG0 X0 Y0 Z0.5\nG91 G1 Z-0.5\nX1.5\nG90 G0 Z1\nM30\n"}) {
        const ProgramFile file(text);
        const GcodeProgram theirs = read_by_rs274(file.name());
        const GcodeProgram ours = read_gcode(text, "part.ngc");
        for (const MoveKind kind : {MoveKind::feed_line, MoveKind::arc_cw, MoveKind::arc_ccw}) {
            DOUBLES_EQUAL(way_mm(ours, kind), way_mm(theirs, kind), 0.01);
        }
        DOUBLES_EQUAL(0.0, (ours.moves.back().end_mm - theirs.moves.back().end_mm).norm(), 0.01);
    }
}

TEST(Rs274, knows_every_tool_and_shifts_no_path_by_one) {
    if (!has_rs274()) {
        return;
    }
    const ProgramFile file("T321 M6 G43 H321\n#1=5\nS2000 M3 F300\nG0 X0 Y0 Z5\nG1 Z-1\nX#1\nM2\n");
    const GcodeProgram program = read_by_rs274(file.name());
    DOUBLES_EQUAL(11.0, way_mm(program, MoveKind::feed_line), 1e-9);
    CHECK(contains(refusal_by_rs274("T1 M6\nS100 M3 F1\n(not this G42)\ng 41 D1\nG1 X10\nM2\n"), ":4: found 'G41'"));
}

TEST(Rs274, passes_on_the_words_with_which_it_refuses) {
    if (!has_rs274()) {
        return;
    }
    CHECK(contains(refusal_by_rs274("G1 X[\n"), "rs274 refuses it: "));
    CHECK(contains(refusal_by_rs274("T1 M6\nS100 M3 F1\nG1 X1\nT2 M6\nM2\n"), "a scenario has one"));
}
