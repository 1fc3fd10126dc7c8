// SPDX-License-Identifier: Apache-2.0
#include "preview/preview.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "files/input_error.hpp"
#include "temporary_folder.hpp"

using namespace millforce::sim;
using millforce::firmware::NumberedTool;
using millforce::host::EngagedArc;
using millforce::host::InputError;
using millforce::host::MapPlace;
using millforce::host::PartMap;

namespace {

/// 7 mills a slot 3 mm deep. 12, which is narrower, follows it at the same depth, and on the way back 2 mm deeper.
const std::string slot_by_two = R"(G21 G90 G94
T7 M6
S4000 M3
G0 X-8 Z-3
G1 X30 F600
G0 Z5
T12 M6
G0 X-8
G0 Z-3
G1 X30
G0 Z-5
G1 X-8
M5
M30
)";

/// To 1 mm from the walls and the floor by 7, of Ø10 mm; the floor and two walls by 12, of Ø6 mm.
const std::string pocket_by_two = R"(G21 G90 G94
T7 M6
S4000 M3
G0 X6 Y-4
G1 Z-4 F600
G1 X24
G1 Y4
G1 X6
G1 Y-4
G0 Z5
T12 M6
G0 X15 Y0
G1 Z-5
G1 Y-7
G1 X27
G1 Y7
M5
M30
)";

std::string block_of(int min_x_mm, int max_x_mm) {
    return "[stock]\nmin_x_mm = " + std::to_string(min_x_mm) +
           "\nmin_y_mm = -15\nmax_x_mm = " + std::to_string(max_x_mm) +
           "\nmax_y_mm = 15\ntop_mm = 0\ncell_mm = 0.1\nstart_x_mm = -20\nstart_y_mm = 0\nstart_z_mm = 5\n";
}

NumberedTool tool(std::uint32_t number, float diameter_mm) {
    NumberedTool tool{number, {}};
    tool.parameters.teeth = 4;
    tool.parameters.diameter_mm = diameter_mm;
    tool.parameters.flute_length_mm = 22.0F;
    return tool;
}

/// A place of a line, by its share of the line's length.
MapPlace place_at(const PartMap& map, std::size_t line, double share) {
    std::vector<MapPlace> places;
    std::ranges::copy_if(map, std::back_inserter(places), [line](const MapPlace& place) { return place.line == line; });
    return places.at(static_cast<std::size_t>(share * static_cast<double>(places.size())));
}

/// How much of the radius is cut at this depth.
double immersion_at_depth(const MapPlace& place, double depth_mm) {
    double immersion = 0.0;
    for (const EngagedArc& arc : place.cut) {
        if (std::abs(arc.axial_depth_mm - depth_mm) < 1e-3) {
            immersion += std::cos(arc.entry_rad) - std::cos(arc.exit_rad);
        }
    }
    return immersion;
}

/// What the line has of cut: of its widest place.
MapPlace widest_in(const PartMap& map, std::size_t line) {
    MapPlace widest;
    for (const MapPlace& place : map) {
        if (place.line == line && immersion_of(place) > immersion_of(widest)) {
            widest = place;
        }
    }
    return widest;
}

}  // namespace

TEST_GROUP(PreviewOfTools) {
    millforce::test::TemporaryFolder folder;

    const std::vector<NumberedTool> both{tool(7, 10.0F), tool(12, 6.0F)};

    [[nodiscard]] Scenario part(const std::string& program, const std::vector<NumberedTool>& tools,
                                const std::string& block = block_of(0, 20)) const {
        return read_part_of_tools(folder.write("part.ngc", program).string(),
                                  folder.write("stock.toml", block).string(), tools);
    }
};

TEST(PreviewOfTools, each_meets_what_the_others_have_left_along_its_own_path) {
    for (const double tolerance_mm : {0.0, 0.3}) {
        const std::vector<MapOfTool> maps = preview_of_tools(part(slot_by_two, both), tolerance_mm);
        CHECK_EQUAL(2U, maps.size());
        CHECK_EQUAL(7U, maps[0].number);
        CHECK_EQUAL(12U, maps[1].number);
        const PartMap& wide = maps[0].map;
        const PartMap& narrow = maps[1].map;
        DOUBLES_EQUAL(2.0, immersion_of(widest_in(wide, 5)), 0.02);
        DOUBLES_EQUAL(3.0, widest_in(wide, 5).cut.front().axial_depth_mm, 1e-3);
        CHECK_TRUE(widest_in(narrow, 10).cut.empty());
        DOUBLES_EQUAL(2.0, immersion_of(widest_in(narrow, 12)), 0.02);
        DOUBLES_EQUAL(2.0, widest_in(narrow, 12).cut.front().axial_depth_mm, 1e-3);
        DOUBLES_EQUAL(0.0, narrow.front().path_mm, 0.0);
        DOUBLES_EQUAL(38.0 + 8.0 + 38.0 + 2.0 + 38.0, narrow.back().path_mm, 1e-6);
        CHECK_TRUE(narrow.back().cut.empty());
    }
}

TEST(PreviewOfTools, where_one_alone_is_used_it_has_the_map_of_that_tool) {
    const std::string program = "T7 M6\nS4000 M3\nG0 X-8 Z-3\nG1 X30 F600\nM30\n";
    const std::vector<MapOfTool> maps = preview_of_tools(part(program, both), 0.5);
    CHECK_EQUAL(1U, maps.size());
    Scenario alone = part(program, both);
    alone.cutter = alone.numbered_cutters.front().cutter;
    const PartMap map = preview_within(alone, 0.5);
    CHECK_EQUAL(map.size(), maps.front().map.size());
    for (std::size_t k = 0; k < map.size(); ++k) {
        CHECK_TRUE(map[k].cut == maps.front().map[k].cut);
    }
}

TEST(PreviewOfTools, finishing_meets_what_roughing_has_left_in_a_pocket) {
    const std::vector<MapOfTool> maps = preview_of_tools(part(pocket_by_two, both, block_of(-5, 35)), 0.0);
    CHECK_EQUAL(2U, maps.size());
    const PartMap& roughing = maps[0].map;
    const PartMap& finishing = maps[1].map;
    DOUBLES_EQUAL(2.0, immersion_at_depth(place_at(roughing, 6, 0.5), 4.0), 0.02);
    DOUBLES_EQUAL(2.0, immersion_at_depth(place_at(finishing, 14, 0.3), 1.0), 0.02);  // of the floor, in the middle
    const MapPlace wall = place_at(finishing, 15, 0.4);
    DOUBLES_EQUAL(1.0 / 3.0, immersion_at_depth(wall, 5.0), 0.04);
    DOUBLES_EQUAL(5.0 / 3.0, immersion_at_depth(wall, 1.0), 0.04);
    DOUBLES_EQUAL(2.0, immersion_of(wall), 0.02);
}

TEST(PreviewOfTools, a_tool_that_is_not_among_them_is_refused_with_its_line_unless_its_cut_is_to_be_left_standing) {
    const Scenario narrow_alone = part(slot_by_two, {tool(12, 6.0F)});
    const auto refusal = [&](const Scenario& scenario, const std::vector<std::uint32_t>& left_standing) {
        return millforce::test::message_of<InputError>([&] { require_tools_of(scenario, left_standing); });
    };
    STRCMP_CONTAINS("part.ngc:5: a feed of T7, which has no file", refusal(narrow_alone, {}).c_str());
    STRCMP_EQUAL("", refusal(narrow_alone, {7}).c_str());
    const std::vector<MapOfTool> maps = preview_of_tools(narrow_alone, 0.0);
    CHECK_EQUAL(1U, maps.size());
    DOUBLES_EQUAL(3.0, widest_in(maps.front().map, 10).cut.front().axial_depth_mm, 1e-3);
    STRCMP_EQUAL("", refusal(part(slot_by_two, both), {}).c_str());
    STRCMP_EQUAL("", refusal(part("T99 M6\nG0 X5\nT7 M6\nM30\n", both), {}).c_str());
    STRCMP_CONTAINS("part.ngc:2: a feed without a tool",
                    refusal(part("S4000 M3\nG1 X5 F600\nM30\n", both), {}).c_str());
}
