// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "firmware/parameters.hpp"
#include "firmware/tool_source.hpp"

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

/// A tool under the number by which the CNC calls it.
struct NumberedTool {
    std::uint32_t number = 0;
    firmware::ToolParameters<float> parameters{};
};

/// Reads `T<number>.toml` of a folder, each by the rules of tool.toml, in the order of their numbers. Files whose names
/// do not end with ".toml" are left alone. Throws InputError: no folder, no tool in it, a ".toml" with another name, a
/// number that is 0, too large or there twice (T7.toml and T007.toml), a file that is refused as a tool.
[[nodiscard]] std::vector<NumberedTool> read_tool_folder(const std::filesystem::path& folder);

/// The ticks of several tools, ready to be copied: 30 ms of work and 18 KiB each.
class PreparedTools final : public firmware::ToolSource {
  public:
    PreparedTools(const firmware::MachineParameters<float>& machine, const std::vector<NumberedTool>& tools);

    [[nodiscard]] bool has(std::uint32_t number) const override { return ticks_.contains(number); }
    void set_up(std::uint32_t number, firmware::ForceControlTick<float>& tick) const override;

  private:
    std::map<std::uint32_t, firmware::ForceControlTick<float>> ticks_;
};

/// A machine with one tool, or with the tools of a folder.
class ToolSet {
  public:
    /// Reads and checks all files of the choice. Throws InputError.
    ToolSet(const firmware::MachineParameters<float>& machine, const ToolChoice& choice);

    /// With the one tool, or the first of the folder.
    [[nodiscard]] const firmware::Parameters<float>& parameters() const { return parameters_; }
    /// Null: one tool.
    [[nodiscard]] const firmware::ToolSource* source() const { return tools_.empty() ? nullptr : &prepared_; }
    /// Empty: one tool.
    [[nodiscard]] const std::vector<NumberedTool>& tools() const { return tools_; }

  private:
    std::vector<NumberedTool> tools_;
    firmware::Parameters<float> parameters_;
    PreparedTools prepared_;
};

}  // namespace millforce::host
