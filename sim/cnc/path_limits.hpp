// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "cnc/move.hpp"

namespace millforce::sim {

struct CncSettings;

/// What a program's geometry allows on its own, whatever the override: computed once, before the first step.
///
/// A corner of angle θ between two blocks (θ = 180°: straight on) may be passed at
///     v² = a δ sin(θ/2) / (1 − sin(θ/2)),
/// the speed on a circle that touches both blocks and stays within the junction deviation δ. Where blocks are so short
/// that the corners together make a curve, the curve rules as on an arc: v² ≤ a/κ, with κ = 2 tan((π − θ)/2) over the
/// mean length of both blocks. An arc of radius r may be run at v² = a r. The tool stops at a dwell, at a change of the
/// spindle speed and at the end.
/// Backwards through the program, v² may grow by 2 a over each mm: so the speed at the end of each block is known from
/// which every limit ahead can be met, however many blocks it is away.
class PathLimits {
  public:
    struct Block {
        double length_mm = 0.0;
        double end_mm = 0.0;        ///< path from the program's start to the block's end
        double most_mm_s = 0.0;     ///< on the block: arc radius, machine's largest feed
        double exit_mm_s = 0.0;     ///< at its end, so that all that follows can be met; 0: the tool stops there
        std::size_t next_feed = 0;  ///< the next block whose programmed feed is another
    };

    /// Throws InputError for moves that no machine can run: not finite, or a feed move without a feed.
    PathLimits(const CncSettings& settings, const std::vector<Move>& moves);

    [[nodiscard]] const Block& operator[](std::size_t index) const { return blocks_[index]; }
    [[nodiscard]] std::size_t size() const { return blocks_.size(); }
    [[nodiscard]] double total_mm() const { return blocks_.back().end_mm; }

  private:
    std::vector<Block> blocks_;
};

}  // namespace millforce::sim
