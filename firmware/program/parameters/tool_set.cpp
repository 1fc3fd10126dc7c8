// SPDX-License-Identifier: Apache-2.0
#include "parameters/tool_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>

#include "files/input_error.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::host {

namespace {

/// 0: no such name.
std::uint32_t number_in(const std::string& name) {
    const std::string_view stem = std::string_view(name).substr(0, name.size() - std::string_view(".toml").size());
    if (stem.size() < 2 || stem.front() != 'T') {
        return 0;
    }
    std::uint32_t number = 0;
    const char* end = stem.data() + stem.size();
    const auto [rest, error] = std::from_chars(stem.data() + 1, end, number);
    return error == std::errc{} && rest == end ? number : 0;
}

/// By number.
std::map<std::uint32_t, std::filesystem::path> tool_files(const std::filesystem::path& folder) {
    std::error_code error;
    std::vector<std::filesystem::path> paths;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        paths.push_back(entry->path());
    }
    if (error) {
        throw InputError(fmt::format("{}: {}, expected a folder of tool files", folder.string(), error.message()));
    }
    std::sort(paths.begin(), paths.end());  // the same error whatever the file system's order
    std::map<std::uint32_t, std::filesystem::path> files;
    for (const std::filesystem::path& path : paths) {
        const std::string name = path.filename().string();
        if (!name.ends_with(".toml")) {
            continue;
        }
        const std::uint32_t number = number_in(name);
        if (number == 0) {
            throw InputError(
                fmt::format("{}: expected a name as T7.toml, with a number from 1 to {}", path.string(), UINT32_MAX));
        }
        if (const auto [known, is_new] = files.emplace(number, path); !is_new) {
            throw InputError(fmt::format("{}: tool {} is in {}, too; expected one file for each number", path.string(),
                                         number, known->second.filename().string()));
        }
    }
    if (files.empty()) {
        throw InputError(fmt::format("{}: no tool file, expected T1.toml, T2.toml, …", folder.string()));
    }
    return files;
}

}  // namespace

void ToolChoice::require_one() const {
    if (file.empty() == folder.empty()) {
        throw InputError(fmt::format("--tool, --tools: {}, expected one of the two",
                                     file.empty() ? "neither was given" : "both were given"));
    }
}

std::vector<std::filesystem::path> ToolChoice::files() const {
    if (!is_folder()) {
        return {file};
    }
    std::vector<std::filesystem::path> paths;
    for (const auto& [number, path] : tool_files(folder)) {
        paths.push_back(path);
    }
    return paths;
}

std::vector<NumberedTool> read_tool_folder(const std::filesystem::path& folder) {
    std::vector<NumberedTool> tools;
    for (const auto& [number, path] : tool_files(folder)) {
        tools.push_back({number, read_tool_parameters(path.string())});
    }
    return tools;
}

PreparedTools::PreparedTools(const firmware::MachineParameters<float>& machine,
                             const std::vector<NumberedTool>& tools) {
    for (const NumberedTool& tool : tools) {
        ticks_.emplace(tool.number, firmware::Parameters<float>{machine, tool.parameters});
    }
}

void PreparedTools::set_up(std::uint32_t number, firmware::ForceControlTick<float>& tick) const {
    const auto found = ticks_.find(number);
    tick = (found != ticks_.end() ? found : ticks_.begin())->second;
}

ToolSet::ToolSet(const firmware::MachineParameters<float>& machine, const ToolChoice& choice)
    : tools_(choice.is_folder() ? read_tool_folder(choice.folder) : std::vector<NumberedTool>()),
      parameters_{machine, tools_.empty() ? read_tool_parameters(choice.file) : tools_.front().parameters},
      prepared_(machine, tools_) {}

}  // namespace millforce::host
