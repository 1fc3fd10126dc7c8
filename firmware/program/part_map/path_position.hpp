// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/path_position.hpp"
#include "part_map/part_map.hpp"

namespace millforce::host {

/// The blocks of a map's program, in the order of the path.
[[nodiscard]] std::vector<firmware::PathBlock<double>> path_blocks(const PartMap& map);

/// Where on a whole map's path a tool is, from what a CNC reports. Not thread-safe.
class PathPosition {
  public:
    explicit PathPosition(const PartMap& map, int patience_samples = firmware::PathPosition<double>::samples_of_change)
        : blocks_(path_blocks(map)), position_(patience_samples) {}

    /// As firmware::PathPosition::find().
    std::optional<double> find(std::uint32_t line, double distance_to_go_mm) {
        return position_.find(blocks_, line, distance_to_go_mm);
    }

  private:
    std::vector<firmware::PathBlock<double>> blocks_;
    firmware::PathPosition<double> position_;
};

}  // namespace millforce::host
