// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string>

#include "firmware/parameter_block.hpp"

namespace millforce::host {

/// Writes the block that a target keeps in its flash (firmware/parameter_block.hpp) into a file. Throws InputError.
void write_parameter_block(const std::string& path, const firmware::Parameters<float>& parameters);

/// Reads such a file, as read back from a flash: what follows the block is ignored. Throws InputError that says why a
/// block is refused.
firmware::Parameters<float> read_parameter_block(const std::string& path);

/// Both files as TOML, one after the other, each key of the table with its value.
void write_parameters_as_toml(std::ostream& out, const firmware::Parameters<float>& parameters);

}  // namespace millforce::host
