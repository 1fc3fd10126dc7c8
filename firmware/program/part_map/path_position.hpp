// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "part_map/part_map.hpp"

namespace millforce::host {

/// Where on the map's path a tool is, from what a CNC reports: the line in work and the distance to go to the block's
/// end. If a line is run through more than once (a cycle, a subprogram), the tool's last position decides.
/// Blocks that a CNC has joined, as LinuxCNC does with straight ones in a row, bear the last one's line and are longer
/// than it: they are taken where they go on from the last position. Not thread-safe.
class PathPosition {
  public:
    explicit PathPosition(const PartMap& map);

    /// mm since the program's begin; nothing where the map has no such line, or none whose block is that long. A line
    /// that is only found behind the tool means that the program has begun again. Call once for each sample: a jump is
    /// accepted once it has been reported for 50 samples, and until then the position stays as it was.
    std::optional<double> find(std::uint32_t line, double distance_to_go_mm);

  private:
    struct Block {
        std::size_t line;
        double begin_mm;
        double end_mm;
    };

    [[nodiscard]] std::optional<double> reported_by(std::uint32_t line, double distance_to_go_mm) const;
    [[nodiscard]] std::optional<double> first_from(double lowest_mm, std::uint32_t line,
                                                   double distance_to_go_mm) const;

    std::vector<Block> blocks_;
    double last_mm_ = 0.0;
    bool has_position_ = false;
    int jumps_ = 0;
};

}  // namespace millforce::host
