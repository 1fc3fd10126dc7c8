// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "estimation/number/finite.hpp"

namespace millforce::firmware {

/// A block of a program, with its place on the program's path.
template <typename Scalar>
struct PathBlock {
    std::uint32_t line = 0;
    Scalar begin_mm{0};
    Scalar end_mm{0};
};

/// Where on a path a tool is, from what a CNC reports: the line in work and the distance to go to the block's end.
/// If a line is run through more than once (a cycle, a subprogram), the tool's last position decides.
/// Blocks that a CNC has joined, as LinuxCNC does with straight ones in a row, bear the last one's line and are longer
/// than it: they are taken where they go on from the last position. Not thread-safe.
template <typename Scalar>
class PathPosition {
  public:
    /// So long line and distance to go may belong to different blocks while a CNC blends from one into the next.
    static constexpr int samples_of_change = 50;

    explicit PathPosition(int patience_samples = samples_of_change) : patience_samples_(patience_samples) {}

    /// mm since the program's begin; nothing where there is no such line among the blocks, or none that is that long. A
    /// line that is only found behind the tool means that the program has begun again. Call once for each sample: a
    /// jump is accepted once it has been reported for `patience_samples`, and until then the position stays as it was.
    /// `blocks`: size() and [], PathBlocks in the order of the path. Cost: that of a binary search.
    template <typename Blocks>
    std::optional<Scalar> find(const Blocks& blocks, std::uint32_t line, Scalar distance_to_go_mm) {
        const std::optional<Scalar> reported = reported_by(blocks, line, distance_to_go_mm);
        const bool goes_on = reported && is_near_last(*reported);
        jumps_ = goes_on ? 0 : (jumps_ < patience_samples_ ? jumps_ + 1 : jumps_);
        if (jumps_ > 0 && jumps_ < patience_samples_ && has_position_) {
            return last_mm_;
        }
        has_position_ = reported.has_value();
        last_mm_ = reported.value_or(last_mm_);
        return reported;
    }

  private:
    /// A path that is blended round corners is shorter than the programmed one.
    static constexpr Scalar slack_mm{1};

    [[nodiscard]] bool is_near_last(Scalar path_mm) const {
        return path_mm - last_mm_ <= slack_mm && last_mm_ - path_mm <= slack_mm;
    }

    template <typename Blocks>
    [[nodiscard]] std::optional<Scalar> reported_by(const Blocks& blocks, std::uint32_t line,
                                                    Scalar distance_to_go_mm) const {
        if (line == 0 || !estimation::is_finite(distance_to_go_mm) || distance_to_go_mm < Scalar(0)) {
            return std::nullopt;
        }
        const std::optional<Scalar> ahead = first_from(blocks, last_mm_ - slack_mm, line, distance_to_go_mm);
        return ahead ? ahead : first_from(blocks, Scalar(0), line, distance_to_go_mm);
    }

    template <typename Blocks>
    [[nodiscard]] std::optional<Scalar> first_from(const Blocks& blocks, Scalar lowest_mm, std::uint32_t line,
                                                   Scalar distance_to_go_mm) const {
        for (std::size_t i = first_that_ends_from(blocks, lowest_mm); i < blocks.size(); ++i) {
            const PathBlock<Scalar>& block = blocks[i];
            const Scalar path_mm = block.end_mm - distance_to_go_mm;
            const bool is_in_block = path_mm >= block.begin_mm - slack_mm;
            const bool goes_on = is_near_last(path_mm);
            if (block.line == line && path_mm >= lowest_mm && (is_in_block || goes_on)) {
                return goes_on || path_mm > block.begin_mm ? path_mm : block.begin_mm;
            }
        }
        return std::nullopt;
    }

    template <typename Blocks>
    [[nodiscard]] static std::size_t first_that_ends_from(const Blocks& blocks, Scalar lowest_mm) {
        std::size_t first = 0;
        std::size_t count = blocks.size();
        while (count > 0) {
            const std::size_t half = count / 2;
            if (blocks[first + half].end_mm < lowest_mm) {
                first += half + 1;
                count -= half + 1;
            } else {
                count = half;
            }
        }
        return first;
    }

    int patience_samples_;
    Scalar last_mm_{0};
    bool has_position_ = false;
    int jumps_ = 0;
};

}  // namespace millforce::firmware
