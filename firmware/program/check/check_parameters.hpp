// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check/finding.hpp"
#include "firmware/parameters.hpp"

namespace millforce::host {

/// What machine.toml and tool.toml show by themselves: wrong units and contradictions. What the reader of the files
/// refuses is not repeated, nor what parameter_notes() says.
Findings check_parameters(const firmware::Parameters<float>& parameters);

}  // namespace millforce::host
