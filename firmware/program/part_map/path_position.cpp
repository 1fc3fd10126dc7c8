// SPDX-License-Identifier: Apache-2.0
#include "part_map/path_position.hpp"

namespace millforce::host {

std::vector<firmware::PathBlock<double>> path_blocks(const PartMap& map) {
    std::vector<firmware::PathBlock<double>> blocks;
    for (const MapPlace& place : map) {
        const auto line = static_cast<std::uint32_t>(place.line);
        const bool is_new = blocks.empty() || blocks.back().line != line || blocks.back().end_mm != place.block_end_mm;
        if (is_new) {
            blocks.push_back({line, place.path_mm, place.block_end_mm});
        }
    }
    return blocks;
}

}  // namespace millforce::host
