// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parameters/tool_set.hpp"

namespace millforce::host {

/// What parameter_notes() and check_parameters() say of a machine with each of its tools, one line
/// each. In a folder of tools, what all of them show stands there once, and the rest after the tool's number.
[[nodiscard]] std::vector<std::string> start_check(const ToolSet& tools);

/// Prints start_check() on standard error: for the start of `run` and `serve`.
void show_start_check(const ToolSet& tools);

}  // namespace millforce::host
