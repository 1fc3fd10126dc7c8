// SPDX-License-Identifier: Apache-2.0
#include "check/start_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "check/check_parameters.hpp"
#include "files/console.hpp"
#include "parameters/parameter_notes.hpp"

namespace millforce::host {

namespace {

using Lines = std::vector<std::string>;

Lines lines_of(const firmware::Parameters<float>& parameters) {
    Lines lines;
    for (const std::string& note : parameter_notes(parameters)) {
        lines.push_back("note: " + note);
    }
    for (const Finding& finding : check_parameters(parameters)) {
        lines.push_back(line_of(finding));
    }
    return lines;
}

bool all_have(const std::vector<Lines>& tools, const std::string& line) {
    return std::all_of(tools.begin(), tools.end(),
                       [&](const Lines& lines) { return std::find(lines.begin(), lines.end(), line) != lines.end(); });
}

}  // namespace

std::vector<std::string> start_check(const ToolSet& tools) {
    if (tools.tools().empty()) {
        return lines_of(tools.parameters());
    }
    std::vector<Lines> of_tools;
    for (const NumberedTool& tool : tools.tools()) {
        of_tools.push_back(lines_of({tools.parameters().machine, tool.parameters}));
    }
    Lines common;
    Lines numbered;
    for (std::size_t k = 0; k < of_tools.size(); ++k) {
        for (const std::string& line : of_tools[k]) {
            if (!all_have(of_tools, line)) {
                numbered.push_back(fmt::format("tool {}: {}", tools.tools()[k].number, line));
            } else if (k == 0) {
                common.push_back(line);
            }
        }
    }
    common.insert(common.end(), numbered.begin(), numbered.end());
    return common;
}

void show_start_check(const ToolSet& tools) {
    for (const std::string& line : start_check(tools)) {
        print_line(stderr, "millforce: " + line);
    }
}

}  // namespace millforce::host
