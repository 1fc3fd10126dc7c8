#pragma once

#include <string>

#include "firmware/parameter_table.hpp"

namespace millforce::sim {

/// Reads machine.toml and tool.toml by the parameter table: every key has its range and default there; an unknown key
/// is an error that names the nearest known one, a missing required key is named. Throws InputError.
firmware::Parameters<float> read_parameters(const std::string& machine_path, const std::string& tool_path);

/// The parameter table as a text that a reader can use: a Markdown table of file, key, unit, default, range, meaning.
std::string parameter_documentation();

}  // namespace millforce::sim
