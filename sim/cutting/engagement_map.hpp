// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cutting/angle_units.hpp"

#include <array>
#include <cstddef>

namespace millforce::sim {

/// Where around the cutter there is material, and how high: the workpiece as the cutting force sees it.
///
/// Bin k covers angles φ in [k, k + 1)·2π/bin_count, φ from the normal to the feed (+y), clockwise, x = feed
/// direction: a point of the periphery at φ lies at (x, y) = R (sin φ, cos φ). An edge element at angle φ and height z
/// above the tool's tip is in material where bottom_mm ≤ z < top_mm of the bin. top_mm ≤ bottom_mm: nothing there.
/// The first and last bin of each interval may be covered in part: `covered` is the share of the bin's angle that
/// holds material, so that an engagement's width does not jump by whole bins.
struct EngagementMap {
    static constexpr std::size_t bin_count = 720;
    static constexpr double bin_rad = turn / static_cast<double>(bin_count);

    struct Bin {
        float bottom_mm = 0.0F;
        float top_mm = 0.0F;
        float covered = 0.0F;
    };

    std::array<Bin, bin_count> bins{};
};

/// Whether the bin holds any material. A NaN anywhere in it counts as none.
inline bool holds_material(const EngagementMap::Bin& bin) {
    return bin.covered > 0.0F && bin.top_mm > bin.bottom_mm;
}

/// Bounds of the material: all of it lies in bins [first, end), and none is higher than `top_mm`. Found once where
/// many loads follow.
struct EngagementBounds {
    std::size_t first = 0;
    std::size_t end = 0;
    double top_mm = 0.0;

    /// How many bins back from a bin (against φ, around the turn) the last one is that may hold material; 0: itself.
    [[nodiscard]] std::size_t bins_back_from(std::size_t bin) const {
        if (bin >= first && bin < end) {
            return 0;
        }
        const std::size_t last = end - 1;
        return bin > last ? bin - last : bin + EngagementMap::bin_count - last;
    }
};

inline EngagementBounds bounds_of(const EngagementMap& map) {
    EngagementBounds bounds;
    for (std::size_t k = 0; k < EngagementMap::bin_count; ++k) {
        if (!holds_material(map.bins[k])) {
            continue;
        }
        bounds.first = bounds.end == 0 ? k : bounds.first;
        bounds.end = k + 1;
        const auto top_mm = static_cast<double>(map.bins[k].top_mm);
        bounds.top_mm = top_mm > bounds.top_mm ? top_mm : bounds.top_mm;
    }
    return bounds;
}

/// Where in a bin its material is: from `low` to `high`, both 0…1 of the bin's angle, with `weight` of it filled.
struct CoveredPart {
    double low = 0.0;
    double high = 1.0;
    double weight = 1.0;
};

/// The part of bin `index` (< bin_count) that `covered` stands for. A partly covered bin with material on one side only
/// is the end of an interval, and its material is on that side. So the entry and exit angles of a cut are known far
/// better than to one bin. If the neighbours do not decide (both or none), the material is spread evenly.
inline CoveredPart covered_part(const EngagementMap& map, std::size_t index) {
    constexpr std::size_t count = EngagementMap::bin_count;
    const double covered = static_cast<double>(map.bins[index].covered);
    if (covered >= 1.0) {
        return {};
    }
    const bool before = holds_material(map.bins[index == 0 ? count - 1 : index - 1]);
    const bool after = holds_material(map.bins[index == count - 1 ? 0 : index + 1]);
    if (before == after) {
        return {.low = 0.0, .high = 1.0, .weight = covered};
    }
    return before ? CoveredPart{.low = 0.0, .high = covered, .weight = 1.0}
                  : CoveredPart{.low = 1.0 - covered, .high = 1.0, .weight = 1.0};
}

/// The same axial depth from entry to exit angle, as in a straight cut.
inline EngagementMap uniform_engagement(double entry_rad, double exit_rad, double axial_depth_mm) {
    EngagementMap map;
    for (std::size_t k = 0; k < EngagementMap::bin_count; ++k) {
        const double low = static_cast<double>(k) * EngagementMap::bin_rad;
        const double high = low + EngagementMap::bin_rad;
        const double overlap = (exit_rad < high ? exit_rad : high) - (entry_rad > low ? entry_rad : low);
        if (overlap > 0.0) {
            map.bins[k] = {0.0F, static_cast<float>(axial_depth_mm),
                           static_cast<float>(overlap / EngagementMap::bin_rad)};
        }
    }
    return map;
}

}  // namespace millforce::sim
