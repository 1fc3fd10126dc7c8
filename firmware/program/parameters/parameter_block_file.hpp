// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "firmware/parameter_block.hpp"

namespace millforce::host {

/// Writes the block that a target keeps in its flash (firmware/parameter_block.hpp) into a file. Throws InputError.
void write_parameter_block(const std::string& path, const firmware::Parameters<float>& parameters);

/// The same with tools by number, in their order; returns its bytes. Throws InputError where they are too many for a
/// block, too.
std::size_t write_tools_block(const std::string& path, const firmware::MachineParameters<float>& machine,
                              std::span<const firmware::NumberedTool> tools);

struct BlockContents {
    firmware::MachineParameters<float> machine{};
    std::vector<firmware::NumberedTool> tools{};  ///< at least one; the number 0 stands for a tool without a number
};

/// Reads such a file, as read back from a flash: what follows the block is ignored. Throws InputError that says why a
/// block is refused.
BlockContents read_parameter_block(const std::string& path);

/// The files as TOML, one after the other, each key of the table with its value.
void write_parameters_as_toml(std::ostream& out, const BlockContents& contents);

}  // namespace millforce::host
