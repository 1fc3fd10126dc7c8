// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "firmware/parameters.hpp"

namespace millforce::host {

struct MachineBus;
class TomlFile;

/// Reads machine.toml and tool.toml by the parameter tables: every key has its type and range there; an unknown key is
/// an error that names the nearest known one, a missing required key is named. Standard errors (KEY_se) and what a
/// calibration writes for information are checked and ignored, so that its tables can be copied into the files
/// unchanged. Throws InputError.
firmware::Parameters<float> read_parameters(const std::string& machine_path, const std::string& tool_path);

/// Reads machine.toml alone, by the same rules.
firmware::MachineParameters<float> read_machine_parameters(const std::string& machine_path);

/// Reads tool.toml alone, by the same rules.
firmware::ToolParameters<float> read_tool_parameters(const std::string& tool_path);

/// The same of files that are parsed already, e.g. from text.
firmware::MachineParameters<float> machine_parameters_in(TomlFile file);
firmware::ToolParameters<float> tool_parameters_in(TomlFile file);

/// The [bus] of machine.toml; nothing where no drive has a node id. Throws InputError as above, and where the settings
/// do not fit together.
std::optional<MachineBus> read_machine_bus(const std::string& machine_path);

/// The [cutting] table of a tool.toml, in full precision.
struct CuttingTable {
    estimation::CuttingLaw<double> law;
    std::optional<estimation::CutSide> side;  ///< cut_side of its calibration: down or up
};

/// Reads [cutting] by the same tables and rules; other tables of the file may hold anything. Throws InputError.
CuttingTable read_cutting_table(const std::string& tool_path);

/// The parameter tables as Markdown: per file and table key, unit, default, range and meaning.
std::string parameter_documentation();

}  // namespace millforce::host
