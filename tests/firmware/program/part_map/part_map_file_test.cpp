// SPDX-License-Identifier: Apache-2.0
#include "part_map/part_map_file.hpp"

#include <CppUTest/TestHarness.h>

#include <numbers>
#include <string>
#include <string_view>

#include "files/input_error.hpp"
#include "temporary_folder.hpp"

using namespace millforce::host;
using namespace millforce::test;
using millforce::firmware::ToolParameters;

namespace {

constexpr double rad_per_deg = std::numbers::pi / 180.0;

const std::string head =
    "# millforce part map 1\n"
    "# program a part.ngc crc32 5f3a09c1\n"
    "# tool mill crc32 0b77e2d4\n"
    "path_mm,block_end_mm,line,rapid,feed_mm_min,spindle_rpm,entry_deg,exit_deg,axial_depth_mm\n";

/// Air, a slot, two sides of a slot that is left, the end.
PartMapFile example() {
    PartMapFile file;
    file.origin = {"a part.ngc", 0x5f3a09c1, "mill", 0x0b77e2d4};
    MapPlace place;
    place.block_end_mm = 10.5;
    place.line = 4;
    place.rapid = true;
    place.programmed_feed_mm_s = 250.0;
    place.spindle_speed_rad_s = 4000.0 * std::numbers::pi / 30.0;
    file.map.push_back(place);
    place = {10.5, 50.0, 5, false, 25.0, place.spindle_speed_rad_s, {{0.0, std::numbers::pi, 5.0}}};
    file.map.push_back(place);
    place.path_mm = 40.25;
    place.cut = {{0.0, 60.0 * rad_per_deg, 5.0}, {120.0 * rad_per_deg, std::numbers::pi, 4.5}};
    file.map.push_back(place);
    place.path_mm = 50.0;
    place.cut.clear();
    file.map.push_back(place);
    return file;
}

std::string error_of(std::string_view text) {
    const TemporaryFolder folder;
    const auto file = folder.write("t.map", text);
    const std::string message = message_of<InputError>([&] { (void)read_part_map(file); });
    const std::string place = file.string();
    return message.starts_with(place) ? message.substr(place.size()) : message;
}

std::string error_of_rows(const std::string& rows) {
    return error_of(head + rows);
}

/// Without a line end.
std::string head_of_version_2() {
    std::string of_runs = head;
    of_runs.replace(of_runs.find("map 1"), 5, "map 2");
    of_runs.pop_back();
    return of_runs + ",known,arc_sd_deg,axial_depth_sd_mm,hardness,hardness_sd,position_sd_mm,contested";
}

}  // namespace

TEST_GROUP(PartMapFile){};

TEST(PartMapFile, what_was_written_is_read) {
    const TemporaryFolder folder;
    const PartMapFile written = example();
    write_part_map(folder.path("t.map"), written);
    const PartMapFile read = read_part_map(folder.path("t.map"));
    STRCMP_EQUAL("a part.ngc", read.origin.program.c_str());
    LONGS_EQUAL(0x5f3a09c1, read.origin.program_crc32);
    STRCMP_EQUAL("mill", read.origin.tool.c_str());
    LONGS_EQUAL(0x0b77e2d4, read.origin.tool_crc32);
    LONGS_EQUAL(4, read.map.size());
    for (std::size_t k = 0; k < 4; ++k) {
        const MapPlace& was = written.map[k];
        const MapPlace& is = read.map[k];
        DOUBLES_EQUAL(was.path_mm, is.path_mm, 1e-9);
        DOUBLES_EQUAL(was.block_end_mm, is.block_end_mm, 1e-9);
        LONGS_EQUAL(was.line, is.line);
        CHECK_EQUAL(was.rapid, is.rapid);
        DOUBLES_EQUAL(was.programmed_feed_mm_s, is.programmed_feed_mm_s, 1e-9);
        DOUBLES_EQUAL(was.spindle_speed_rad_s, is.spindle_speed_rad_s, 1e-9);
        LONGS_EQUAL(was.cut.size(), is.cut.size());
        for (std::size_t i = 0; i < was.cut.size(); ++i) {
            DOUBLES_EQUAL(was.cut[i].entry_rad, is.cut[i].entry_rad, 1e-5);
            DOUBLES_EQUAL(was.cut[i].exit_rad, is.cut[i].exit_rad, 1e-5);
            DOUBLES_EQUAL(was.cut[i].axial_depth_mm, is.cut[i].axial_depth_mm, 1e-9);
        }
    }
}

TEST(PartMapFile, a_place_or_an_arc_shorter_than_its_digits_is_left_out) {
    const TemporaryFolder folder;
    PartMapFile written = example();
    MapPlace& behind_begin = written.map[1];
    behind_begin.path_mm = 0.0003;
    written.map[2].cut.front().exit_rad = 0.0004 * rad_per_deg;
    written.map[2].cut.back().axial_depth_mm = 0.0004;
    written.map[3].path_mm = 40.2504;
    write_part_map(folder.path("t.map"), written);
    const PartMap read = read_part_map(folder.path("t.map")).map;
    LONGS_EQUAL(2, read.size());
    DOUBLES_EQUAL(0.0, read[0].path_mm, 1e-9);
    LONGS_EQUAL(behind_begin.line, read[0].line);
    DOUBLES_EQUAL(40.25, read[1].path_mm, 1e-9);
    CHECK(read[1].cut.empty());
}

TEST(PartMapFile, is_written_as_its_header_says) {
    const TemporaryFolder folder;
    write_part_map(folder.path("t.map"), example());
    const std::string expected = head +
                                 "0,10.5,4,1,15000,4000,,,\n"
                                 "10.5,50,5,0,1500,4000,0,180,5\n"
                                 "40.25,50,5,0,1500,4000,0,60,5\n"
                                 "40.25,50,5,0,1500,4000,120,180,4.5\n"
                                 "50,50,5,0,1500,4000,,,\n";
    STRCMP_EQUAL(expected.c_str(), folder.read("t.map").c_str());
}

TEST(PartMapFile, what_a_run_says_of_its_doubt_is_read_as_it_was_written) {
    PartMapFile written = example();
    MapPlace& place = written.map[1];
    place.known = Known::at_most;
    place.least_share = 0.4;
    place.arc_sd_rad = 5.0 * rad_per_deg;
    place.axial_depth_sd_mm = 0.25;
    place.hardness = 1.125;
    place.hardness_sd = 0.04;
    place.position_sd_mm = 0.5;
    written.map[2].known = Known::nothing;
    written.map[2].is_contested = true;
    const TemporaryFolder folder;
    write_part_map(folder.path("t.map"), written);
    CHECK_TRUE(folder.read("t.map").starts_with("# millforce part map 2\n"));
    const PartMap read = read_part_map(folder.path("t.map")).map;
    CHECK_TRUE(read[0].known == Known::cut && read[1].known == Known::at_most && read[2].known == Known::nothing);
    DOUBLES_EQUAL(0.4, read[1].least_share, 1e-9);
    DOUBLES_EQUAL(place.arc_sd_rad, read[1].arc_sd_rad, 1e-5);
    DOUBLES_EQUAL(0.25, read[1].axial_depth_sd_mm, 1e-9);
    DOUBLES_EQUAL(1.125, read[1].hardness, 1e-9);
    DOUBLES_EQUAL(0.04, read[1].hardness_sd, 1e-9);
    DOUBLES_EQUAL(0.5, read[1].position_sd_mm, 1e-9);
    CHECK_FALSE(read[1].is_contested);
    CHECK_TRUE(read[2].is_contested);
}

TEST(PartMapFile, a_doubt_that_cannot_be_is_refused_with_its_column) {
    const std::string head_of_runs = head_of_version_2() + "\n";
    const auto error = [&](const std::string& doubt) {
        return error_of(head_of_runs + "5,9,1,0,60,1000,10,20,1," + doubt + "\n9,9,1,0,60,1000,,,,2,0,0,1,0,0,0\n");
    };
    STRCMP_EQUAL("", error("2,0,0,1,0,0,0").c_str());
    STRCMP_CONTAINS(":5: column 'known'", error("3,0,0,1,0,0,0").c_str());
    STRCMP_CONTAINS(":5: column 'arc_sd_deg'", error("2,-1,0,1,0,0,0").c_str());
    STRCMP_CONTAINS(":5: column 'axial_depth_sd_mm'", error("2,0,nan,1,0,0,0").c_str());
    STRCMP_CONTAINS(":5: column 'hardness'", error("2,0,0,0,0,0,0").c_str());
    STRCMP_CONTAINS(":5: column 'hardness_sd'", error("2,0,0,1,,0,0").c_str());
    STRCMP_CONTAINS(":5: column 'position_sd_mm'", error("2,0,0,1,0,-1,0").c_str());
    STRCMP_CONTAINS(":5: column 'contested'", error("2,0,0,1,0,0,2").c_str());
}

TEST(PartMapFile, the_least_share_of_a_cut_may_be_missing_but_not_be_wrong) {
    const std::string head_of_runs = head_of_version_2() + ",least_share\n";
    const auto error = [&](const std::string& share) {
        return error_of(head_of_runs + "5,9,1,0,60,1000,10,20,1,1,0,0,1,0,0,0," + share +
                        "\n9,9,1,0,60,1000,,,,2,0,0,1,0,0,0,1\n");
    };
    STRCMP_EQUAL("", error("0.3").c_str());
    for (const char* wrong : {"1.5", "-0.1", "", "nan"}) {
        STRCMP_CONTAINS(":5: column 'least_share'", error(wrong).c_str());
    }
}

TEST(PartMapFile, places_at_which_nothing_changes_are_not_written) {
    PartMapFile file = example();
    MapPlace between = file.map[1];
    between.path_mm = 20.0;
    file.map.insert(file.map.begin() + 2, between);
    const TemporaryFolder folder;
    write_part_map(folder.path("a.map"), file);
    write_part_map(folder.path("b.map"), example());
    STRCMP_EQUAL(folder.read("b.map").c_str(), folder.read("a.map").c_str());
}

TEST(PartMapFile, a_place_at_which_one_thing_changes_is_written_and_so_is_the_last_one) {
    const auto places_of = [](const auto& change) {
        PartMapFile file = example();
        file.map[1].cut.clear();  // as in air the end is like the place before it
        MapPlace between = file.map[1];
        between.path_mm = 20.0;
        change(between);
        file.map = {file.map[1], between};
        MapPlace end = between;
        end.path_mm = 50.0;
        file.map.push_back(end);
        const TemporaryFolder folder;
        write_part_map(folder.path("t.map"), file);
        return read_part_map(folder.path("t.map")).map.size();
    };
    LONGS_EQUAL(2, places_of([](MapPlace&) {}));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.line = 6; }));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.rapid = true; }));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.programmed_feed_mm_s = 26.0; }));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.spindle_speed_rad_s = 400.0; }));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.known = Known::nothing; }));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.arc_sd_rad = 0.1; }));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.axial_depth_sd_mm = 0.1; }));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.hardness = 1.1; }));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.hardness_sd = 0.1; }));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.position_sd_mm = 0.1; }));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.is_contested = true; }));
    LONGS_EQUAL(3, places_of([](MapPlace& place) { place.least_share = 0.5; }));
}

TEST(PartMapFile, is_that_of_a_run_where_any_place_has_something_of_a_run) {
    const auto begins_with = [](const auto& change) {
        PartMapFile file = example();
        change(file.map[1]);
        const TemporaryFolder folder;
        write_part_map(folder.path("t.map"), file);
        return folder.read("t.map").substr(0, 23);
    };
    const char* const of_geometry = "# millforce part map 1\n";
    const char* const of_run = "# millforce part map 2\n";
    STRCMP_EQUAL(of_geometry, begins_with([](MapPlace&) {}).c_str());
    STRCMP_EQUAL(of_run, begins_with([](MapPlace& place) { place.known = Known::at_most; }).c_str());
    STRCMP_EQUAL(of_run, begins_with([](MapPlace& place) { place.arc_sd_rad = 0.1; }).c_str());
    STRCMP_EQUAL(of_run, begins_with([](MapPlace& place) { place.axial_depth_sd_mm = 0.1; }).c_str());
    STRCMP_EQUAL(of_run, begins_with([](MapPlace& place) { place.hardness = 1.1; }).c_str());
    STRCMP_EQUAL(of_run, begins_with([](MapPlace& place) { place.hardness_sd = 0.1; }).c_str());
    STRCMP_EQUAL(of_run, begins_with([](MapPlace& place) { place.position_sd_mm = 0.1; }).c_str());
    STRCMP_EQUAL(of_run, begins_with([](MapPlace& place) { place.is_contested = true; }).c_str());
}

TEST(PartMapFile, another_file_or_version_is_refused) {
    STRCMP_CONTAINS("expected '# millforce part map 1'", error_of("path_mm,line\n1,2\n").c_str());
    STRCMP_CONTAINS("expected '# millforce part map 1'", error_of("# millforce part map 3\npath_mm\n1\n").c_str());
    STRCMP_CONTAINS("no line '# program NAME crc32 HEX'",
                    error_of("# millforce part map 1\n" + head.substr(head.find("path_mm"))).c_str());
    std::string broken = head;
    broken.replace(broken.find("0b77e2d4"), 8, "0b77e2dg");
    STRCMP_CONTAINS("no line '# tool NAME crc32 HEX'", error_of(broken).c_str());
    for (const char* origin : {"tool mill", "tool crc32 xyz", "tool mill crc32 123456789"}) {
        broken = head;
        broken.replace(broken.find("tool mill crc32 0b77e2d4"), 24, origin);
        STRCMP_CONTAINS("no line '# tool NAME crc32 HEX'", error_of(broken).c_str());
    }
}

TEST(PartMapFile, rows_that_cannot_be_are_refused_with_their_line) {
    STRCMP_CONTAINS("the last row is not the program's end", error_of_rows("").c_str());
    STRCMP_CONTAINS("the last row is not the program's end", error_of_rows("0,9,1,0,60,1000,0,90,1\n").c_str());
    STRCMP_CONTAINS(":6: column 'path_mm': the path goes back",
                    error_of_rows("5,9,1,0,60,1000,,,\n4,9,1,0,60,1000,,,\n").c_str());
    STRCMP_CONTAINS(":5: column 'exit_deg'", error_of_rows("5,9,1,0,60,1000,90,80,1\n").c_str());
    STRCMP_CONTAINS(":5: column 'entry_deg'", error_of_rows("5,9,1,0,60,1000,-1,80,1\n").c_str());
    STRCMP_CONTAINS(":5: column 'exit_deg'", error_of_rows("5,9,1,0,60,1000,10,,1\n").c_str());
    STRCMP_CONTAINS(":5: column 'axial_depth_mm'", error_of_rows("5,9,1,0,60,1000,10,20,0\n").c_str());
    STRCMP_CONTAINS(":5: column 'feed_mm_min'", error_of_rows("5,9,1,0,-60,1000,,,\n").c_str());
    STRCMP_CONTAINS(":5: column 'feed_mm_min': no feed in a cut", error_of_rows("5,9,1,0,0,1000,10,20,1\n").c_str());
    STRCMP_CONTAINS(":5: column 'feed_mm_min': no feed in a cut", error_of_rows("5,9,1,0,1e-9,1000,10,20,1\n").c_str());
    STRCMP_CONTAINS(":5: column 'exit_deg'", error_of_rows("5,9,1,0,60,1000,10.0001,10.0002,1\n").c_str());
    STRCMP_CONTAINS(":5: column 'block_end_mm'", error_of_rows("5,4,1,0,60,1000,,,\\n").c_str());
    STRCMP_CONTAINS(":5: column 'path_mm'", error_of_rows("nan,9,1,0,60,1000,,,\n").c_str());
    STRCMP_CONTAINS(":6: column 'entry_deg': a second row",
                    error_of_rows("5,9,1,0,60,1000,10,50,1\n5,9,1,0,60,1000,,,\n").c_str());
    STRCMP_CONTAINS(":6: column 'entry_deg': a second row",
                    error_of_rows("5,9,1,0,60,1000,,,\n5,9,1,0,60,1000,40,90,1\n").c_str());
    STRCMP_CONTAINS(":6: column 'entry_deg': a second row for this place",
                    error_of_rows("5,9,1,0,60,1000,10,50,1\n5,9,1,0,60,1000,40,90,1\n").c_str());
}

TEST(PartMapFile, belongs_to_the_programs_bytes_but_not_to_its_line_ends) {
    const TemporaryFolder folder;
    const ToolParameters<float> tool;
    const auto crc = [&](std::string_view text) {
        return origin_of(folder.write("p.ngc", text), "t", tool).program_crc32;
    };
    LONGS_EQUAL(crc("G0 X1\nM2\n"), crc("G0 X1\r\nM2\r\n"));
    CHECK(crc("G0 X1\nM2\n") != crc("G0 X2\nM2\n"));
    STRCMP_CONTAINS("no such file",
                    message_of<InputError>([&] { (void)origin_of(folder.path("none.ngc"), "t", tool); }).c_str());
}

TEST(PartMapFile, belongs_to_the_tools_geometry_but_not_to_its_calibration) {
    ToolParameters<float> tool;
    const std::uint32_t crc = origin_of({}, "t", tool).tool_crc32;
    tool.law.k_s_N_per_mm2 *= 2.0F;
    LONGS_EQUAL(crc, origin_of({}, "t", tool).tool_crc32);
    tool.diameter_mm += 0.1F;
    CHECK(crc != origin_of({}, "t", tool).tool_crc32);
}

TEST(PartMapFile, a_map_of_another_program_or_tool_is_refused) {
    const MapOrigin mine = example().origin;
    require_same_origin("a.map", mine, mine);
    MapOrigin other = mine;
    other.program_crc32 ^= 1U;
    STRCMP_CONTAINS("a.map: made for another program",
                    message_of<InputError>([&] { require_same_origin("a.map", mine, other); }).c_str());
    other = mine;
    other.tool_crc32 ^= 1U;
    STRCMP_CONTAINS("made for another tool",
                    message_of<InputError>([&] { require_same_origin("a.map", mine, other); }).c_str());
}
