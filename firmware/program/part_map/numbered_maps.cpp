// SPDX-License-Identifier: Apache-2.0
#include "part_map/numbered_maps.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "files/input_error.hpp"

namespace millforce::host {

namespace {

std::string names_of(const std::vector<std::uint32_t>& numbers) {
    std::string text;
    for (const std::uint32_t number : numbers) {
        text += fmt::format("{}T{}", text.empty() ? "" : ", ", number);
    }
    return text;
}

}  // namespace

std::uint32_t number_of_map(const std::string& map_file, const MapOrigin& origin, const std::string& folder,
                            const std::vector<firmware::NumberedTool>& tools) {
    std::vector<std::uint32_t> of_geometry;
    for (const firmware::NumberedTool& tool : tools) {
        if (origin_of({}, {}, tool.parameters).tool_crc32 == origin.tool_crc32) {
            of_geometry.push_back(tool.number);
        }
    }
    const auto named = std::find_if(of_geometry.begin(), of_geometry.end(),
                                    [&](std::uint32_t number) { return origin.tool == fmt::format("T{}", number); });
    if (named != of_geometry.end()) {
        return *named;
    }
    const bool has_name = std::ranges::any_of(
        tools, [&](const firmware::NumberedTool& tool) { return origin.tool == fmt::format("T{}", tool.number); });
    if (has_name || of_geometry.empty()) {
        throw InputError(
            fmt::format("{}: made for another tool ('{}') than those of {}", map_file, origin.tool, folder));
    }
    if (of_geometry.size() > 1) {
        throw InputError(
            fmt::format("{}: made for '{}', which may be {} of {}; make it again with 'millforce preview' "
                        "and the tool's file of that folder",
                        map_file, origin.tool, names_of(of_geometry), folder));
    }
    return of_geometry.front();
}

}  // namespace millforce::host
