// SPDX-License-Identifier: Apache-2.0
#include "part_map/numbered_maps.hpp"

#include "files/input_error.hpp"
#include "parameters/parameter_files.hpp"

#include <CppUTest/TestHarness.h>

#include <string>
#include <vector>

using namespace millforce;
using namespace millforce::host;

namespace {

firmware::ToolParameters<float> endmill() {
    return read_tool_parameters(MILLFORCE_SOURCE_DIR "/sim/scenarios/tools/endmill_10mm.toml");
}

std::vector<firmware::NumberedTool> tools_of(const std::vector<std::uint32_t>& numbers, std::uint8_t teeth = 4) {
    std::vector<firmware::NumberedTool> tools;
    tools.reserve(numbers.size());
    for (const std::uint32_t number : numbers) {
        tools.push_back({number, endmill()});
        tools.back().parameters.teeth = teeth;
    }
    return tools;
}

MapOrigin origin_with(const std::string& name) {
    return origin_of({}, name, endmill());
}

std::string refusal(const std::string& name, const std::vector<firmware::NumberedTool>& tools) {
    try {
        static_cast<void>(number_of_map("part.map", origin_with(name), "tools", tools));
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST_GROUP(NumberOfMap){};

TEST(NumberOfMap, is_that_of_its_name_else_of_the_only_tool_with_its_geometry) {
    UNSIGNED_LONGS_EQUAL(12, number_of_map("part.map", origin_with("T12"), "tools", tools_of({7, 12, 15})));
    std::vector<firmware::NumberedTool> tools = tools_of({7});
    tools.push_back({12, tools_of({12}, 3).front().parameters});
    UNSIGNED_LONGS_EQUAL(7, number_of_map("part.map", origin_with("endmill"), "tools", tools));
    UNSIGNED_LONGS_EQUAL(7, number_of_map("part.map", origin_with("T15"), "tools", tools));
}

TEST(NumberOfMap, is_not_that_of_another_tool_where_the_one_of_its_name_has_become_another) {
    std::vector<firmware::NumberedTool> tools = tools_of({7});
    tools.push_back({12, tools_of({12}, 3).front().parameters});
    STRCMP_CONTAINS("part.map: made for another tool ('T12') than those of tools", refusal("T12", tools).c_str());
}

TEST(NumberOfMap, is_refused_in_words_where_no_tool_or_more_than_one_may_be_meant) {
    STRCMP_CONTAINS("part.map: made for another tool ('T7') than those of tools",
                    refusal("T7", tools_of({7, 12}, 3)).c_str());
    STRCMP_CONTAINS("part.map: made for 'endmill', which may be T7, T12 of tools",
                    refusal("endmill", tools_of({7, 12})).c_str());
}
