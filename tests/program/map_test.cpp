// SPDX-License-Identifier: Apache-2.0
#include "csv_rows.hpp"
#include "inputs.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <filesystem>
#include <string>

using namespace millforce::test;

namespace {

/// Air to 8 mm, the cut to 20 mm, air to 30 mm.
const std::string rows =
    "path_mm,block_end_mm,line,rapid,feed_mm_min,spindle_rpm,entry_deg,exit_deg,axial_depth_mm\n"
    "0,30,1,0,1200,4000,,,\n"
    "8,30,1,0,1200,4000,113.578,180,5\n"
    "20,30,1,0,1200,4000,,,\n"
    "30,30,1,0,1200,4000,,,\n";

const std::string rows_of_run =
    "path_mm,block_end_mm,line,rapid,feed_mm_min,spindle_rpm,entry_deg,exit_deg,axial_depth_mm,known,arc_sd_deg,"
    "axial_depth_sd_mm,hardness,hardness_sd,position_sd_mm,contested,least_share\n"
    "0,30,1,0,1200,4000,,,,2,0,0,1.25,0.04,0,0,1\n"
    "8,30,1,0,1200,4000,113.578,180,5,1,0,0,1.25,0.04,0,0,0.5\n"
    "10,30,1,0,1200,4000,113.578,180,5,2,4,0.3,1.25,0.04,0.5,0,1\n"
    "14,30,1,0,1200,4000,,,,0,0,0,1.25,0.04,0,1,1\n"
    "16,30,1,0,1200,4000,,,,0,0,0,1.25,0.04,0,0,1\n"
    "20,30,1,0,1200,4000,,,,2,0,0,1.25,0.04,0,0,1\n"
    "30,30,1,0,1200,4000,,,,2,0,0,1.25,0.04,0,0,1\n";

/// Where the map first says so in column `known`; NaN where it does not.
double first_path_mm_of_known(const std::string& known, const std::string& map) {
    for (const auto& row : csv_rows(map.substr(map.find("path_mm")))) {
        if (row.at("known") == known) {
            return std::stod(row.at("path_mm"));
        }
    }
    return std::nan("");
}

}  // namespace

TEST_GROUP(MapCommand) {
    Inputs inputs;
    std::string origin;

    void setup() override {
        LONGS_EQUAL(0, run_millforce({"preview", inputs.name("scenario.toml"), "-o", inputs.name("a.map")}).exit_code);
        const std::string drawn = inputs.read("a.map");
        const std::size_t begin = drawn.find('\n') + 1;
        origin = drawn.substr(begin, drawn.find("path_mm") - begin);
        inputs.write("a.map", "# millforce part map 1\n" + origin + rows);
    }
    void write_run(const std::string& text) {
        inputs.write("run.map", "# millforce part map 2\n" + origin + text);
    }
    Ended join() const {
        return run_millforce({"map", "join", inputs.name("a.map"), inputs.name("run.map"), "--tool",
                              inputs.name("tool.toml"), "-o", inputs.name("b.map")});
    }
    Ended show(const char* map = "a.map", const char* page = "page.html") const {
        return run_millforce(
            {"map", "show", inputs.name(map), "--tool", inputs.name("tool.toml"), "-o", inputs.name(page)});
    }
    Ended send(std::vector<std::string> more) const {
        std::vector<std::string> words{"map", "send", "no_such_can0", "--machine", inputs.name("machine.toml")};
        words.insert(words.end(), more.begin(), more.end());
        return run_millforce(words);
    }
    void has(const char* part) const {
        CHECK_TEXT(inputs.read("page.html").find(part) != std::string::npos, part);  // the page itself is long
    }
    [[nodiscard]] bool has_not_written(const char* file) const {
        return !std::filesystem::exists(inputs.path(file));
    }
};

TEST(MapCommand, show_says_how_much_of_the_path_is_known_and_the_force_in_the_cut) {
    LONGS_EQUAL(0, show().exit_code);
    has("100 %");
    has("30 mm");
    has("12 mm");
    has("None: the map knows each place of the path.");
    has("0011111");  // air, then the cut
    has("\"tooth_force_limit_N\":700");
}

TEST(MapCommand, show_lists_where_a_run_did_not_know_the_cut_and_why) {
    write_run(rows_of_run);
    LONGS_EQUAL(0, show("run.map").exit_code);
    has("80 %");
    has("14.0 – 16.0 mm</td><td>geometry and run disagree");
    has("16.0 – 20.0 mm</td><td>not known");
    has("1.25 ± 0.04 of the tool");
}

TEST(MapCommand, show_marks_a_force_above_the_tools_limit) {
    LONGS_EQUAL(0, show().exit_code);
    CHECK(inputs.read("page.html").find("stat over") == std::string::npos);
    inputs.write("tool.toml", with(tool_text, "tooth_force_limit_N = 700.0", "tooth_force_limit_N = 20.0"));
    LONGS_EQUAL(0, show().exit_code);
    has("stat over");
}

TEST(MapCommand, show_of_a_program_that_ends_where_it_began_is_a_page_without_a_path) {
    inputs.write("a.map",
                 "# millforce part map 1\n" + origin + rows.substr(0, rows.find('\n') + 1) + "0,0,1,0,1200,4000,,,\n");
    LONGS_EQUAL(0, show().exit_code);
    has("\"buckets\":0");
}

TEST(MapCommand, show_refuses_another_tool_and_to_write_over_what_it_reads) {
    STRCMP_EQUAL("", not_refused(show("a.map", "tool.toml"), {"tool.toml"}).c_str());
    STRCMP_EQUAL(tool_text.c_str(), inputs.read("tool.toml").c_str());
    inputs.write("tool.toml", with(tool_text, "teeth = 4", "teeth = 3"));
    STRCMP_EQUAL("", not_refused(show(), {"a.map", "made for another tool"}).c_str());
    CHECK(has_not_written("page.html"));
}

TEST(MapCommand, of_a_run_doubts_the_air_beside_a_cut_as_far_as_a_blank_may_lie_off) {
    const auto doubted_from_mm = [&](const char* tolerance_mm) {
        const Ended ended =
            run_millforce({"simulate", inputs.name("scenario.toml"), "--hardest", "1", "--learn",
                           inputs.name("run.map"), "--stock-tolerance", tolerance_mm, "--out", inputs.name("out")});
        LONGS_EQUAL(0, ended.exit_code);
        return first_path_mm_of_known("1", inputs.read("run.map"));
    };
    const double at_contact_mm = doubted_from_mm("0");
    DOUBLES_EQUAL(at_contact_mm - 3.0, doubted_from_mm("1.5"), 0.6);
    STRCMP_EQUAL("", not_refused(run_millforce({"simulate", inputs.name("scenario.toml"), "--stock-tolerance", "1"}),
                                 {"--stock-tolerance", "--learn"})
                         .c_str());
}

TEST(MapCommand, join_says_what_it_compared_and_writes_the_map_of_both) {
    write_run(rows_of_run);
    const Ended ended = join();
    LONGS_EQUAL(0, ended.exit_code);
    STRCMP_CONTAINS("mm of cut compared; hardness 1.00 ± 0.01 of the tool's file; 1 first contacts +0.0 ± 0.0 mm",
                    ended.out.c_str());
    CHECK(inputs.read("b.map").starts_with("# millforce part map 2\n"));
}

TEST(MapCommand, join_names_line_and_path_where_both_contradict_each_other) {
    write_run(with(rows_of_run, "10,30,1,0,1200,4000,113.578,180,5,2,4", "10,30,1,0,1200,4000,,,,2,0"));
    const Ended ended = join();
    LONGS_EQUAL(0, ended.exit_code);
    STRCMP_CONTAINS("line 1, path 10.0 to 14.0 mm: geometry has a cut, the run air; taken as not known\n",
                    ended.out.c_str());
    STRCMP_CONTAINS("0 mm of cut compared", ended.out.c_str());
}

TEST(MapCommand, join_refuses_maps_of_two_tools_or_programs) {
    write_run(rows_of_run);
    inputs.write("run.map", with(inputs.read("run.map"), "# program  crc32 00000000", "# program b crc32 00000001"));
    STRCMP_EQUAL("", not_refused(join(), {"run.map", "made for another program"}).c_str());
    write_run(rows_of_run);
    inputs.write("tool.toml", with(tool_text, "diameter_mm = 10.0", "diameter_mm = 12.0"));
    STRCMP_EQUAL("", not_refused(join(), {"a.map", "made for another tool"}).c_str());
    CHECK(has_not_written("b.map"));
}

TEST(MapCommand, send_refuses_what_cannot_be_sent_before_it_opens_the_bus) {
    inputs.write("machine.toml", machine_text + "[bus]\noverride_node_id = 9\nprogram_status_id = 0x121\n");
    const std::string map = inputs.name("a.map");
    STRCMP_EQUAL("", not_refused(send({map}), {"--tool"}).c_str());
    STRCMP_EQUAL("", not_refused(send({map, map, "--tool", inputs.name("tool.toml")}), {"2 maps", "--tools"}).c_str());
    std::filesystem::create_directory(inputs.path("tools"));
    inputs.write("tools/T7.toml", tool_text);
    const Ended twice = send({map, map, "--tools", inputs.name("tools")});
    LONGS_EQUAL(2, twice.exit_code);
    STRCMP_CONTAINS("a.map: a second map for T7, expected one for each tool\n", twice.error.c_str());
    inputs.write("machine.toml", machine_text + "[bus]\noverride_node_id = 9\nprogram_status_id = 0x620\n");
    STRCMP_EQUAL(
        "",
        not_refused(send({map, "--tool", inputs.name("tool.toml")}), {"machine.toml", "program_status_id"}).c_str());
}
