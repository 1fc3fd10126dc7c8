// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace millforce::host {

/// What a run saw along its path: the blocks of its program, and sums over the estimates that belong to each piece of
/// the path.
struct RunMemory {
    static constexpr double bin_mm = 0.5;

    struct Block {
        std::size_t tool = 0;
        std::uint32_t line = 0;
        bool rapid = false;
        double begin_mm = 0.0;
        double end_mm = 0.0;
        float feed_mm_s = 0.0F;
        float spindle_speed_rad_s = 0.0F;
    };
    /// Sums over the estimates that belong to a piece of the path.
    struct Bin {
        std::uint16_t air = 0;
        std::uint16_t contact = 0;
        std::uint16_t cut = 0;  ///< of the contacts: with an engagement
        std::uint16_t up = 0;   ///< of the cuts in up milling
        float immersion = 0.0F;
        float immersion_variance = 0.0F;
        float depth_mm = 0.0F;
        float depth_variance_mm2 = 0.0F;
        float highest_N = 0.0F;  ///< F_at in contact, and the feed there
        float feed_per_tooth_mm = 0.0F;
        float hidden_N_s_per_mm = 0.0F;  ///< of the air: the force that it may have hidden, over the feed there
    };

    std::vector<Block> blocks;
    std::vector<Bin> bins;
    std::size_t used = 0;  ///< bins
    double path_mm = 0.0;  ///< farthest

    /// Of the bin that holds this place.
    [[nodiscard]] static std::size_t bin_at(double path_mm) {
        return static_cast<std::size_t>(std::max(path_mm, 0.0) / bin_mm);
    }
};

}  // namespace millforce::host
