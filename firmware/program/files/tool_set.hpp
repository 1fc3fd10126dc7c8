// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "firmware/parameters.hpp"
#include "firmware/tool_magazine.hpp"

namespace millforce::host {

/// The tools that a command was given: one file (--tool), or a folder of them (--tools).
struct ToolChoice {
    std::string file;
    std::string folder;

    [[nodiscard]] bool is_folder() const { return !folder.empty(); }
    /// Throws InputError where neither was given, or both.
    void require_one() const;
    /// All that are read. Throws InputError as read_tool_folder().
    [[nodiscard]] std::vector<std::filesystem::path> files() const;
};

/// Reads `T<number>.toml` of a folder, each by the rules of tool.toml, in the order of their numbers. Files whose names
/// do not end with ".toml" are left alone. Throws InputError: no folder, no tool in it, a ".toml" with another name, a
/// number that is 0, too large or there twice (T7.toml and T007.toml), a file that is refused as a tool.
[[nodiscard]] std::vector<firmware::NumberedTool> read_tool_folder(const std::filesystem::path& folder);

/// A machine with one tool, or with a magazine of them.
class ToolSet {
  public:
    /// Reads and checks all files. Throws InputError.
    ToolSet(const std::string& machine_file, const ToolChoice& choice);
    ToolSet(const ToolSet&) = delete;
    ToolSet& operator=(const ToolSet&) = delete;

    /// With the one tool, or the first of the folder.
    [[nodiscard]] const firmware::Parameters<float>& parameters() const { return parameters_; }
    /// Null: one tool.
    [[nodiscard]] const firmware::ToolMagazine* magazine() const { return tools_.empty() ? nullptr : &magazine_; }
    /// Empty: one tool.
    [[nodiscard]] const std::vector<firmware::NumberedTool>& tools() const { return tools_; }

  private:
    std::vector<firmware::NumberedTool> tools_;
    firmware::ToolMagazine magazine_;
    firmware::Parameters<float> parameters_;
};

}  // namespace millforce::host
