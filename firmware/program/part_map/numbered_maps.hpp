// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/parameter_block.hpp"
#include "part_map/part_map_file.hpp"

namespace millforce::host {

/// Number of the tool that a map was made for, out of a folder: the one of the map's name, T7 for 7. Where the folder
/// has no such number, the only one with its geometry. Throws InputError where the tool of its name has another
/// geometry, or where none or more than one has it. `map_file` and `folder` are for its text.
[[nodiscard]] std::uint32_t number_of_map(const std::string& map_file, const MapOrigin& origin,
                                          const std::string& folder, const std::vector<firmware::NumberedTool>& tools);

}  // namespace millforce::host
