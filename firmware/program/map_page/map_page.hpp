// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "firmware/parameters.hpp"
#include "part_map/part_map_file.hpp"

namespace millforce::host {

/// The page of a part map, in one file that needs no network: arcs, depth and predicted tooth force along the path, how
/// well each place is known, and where geometry and run disagree. `title`: the map's file name, as text. Cost: some 100
/// single-tooth forces for each change of the cut.
[[nodiscard]] std::string map_page_html(const PartMapFile& map, const std::string& title,
                                        const firmware::ToolParameters<float>& tool);

}  // namespace millforce::host
