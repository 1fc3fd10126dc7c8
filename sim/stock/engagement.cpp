#include "stock/engagement.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace millforce::sim {

namespace {

struct Direction {
    double sine;
    double cosine;
};

const std::array<Direction, EngagementMap::bin_count>& bin_directions() {
    static const auto table = [] {
        std::array<Direction, EngagementMap::bin_count> directions{};
        for (std::size_t k = 0; k < directions.size(); ++k) {
            const double phi = (static_cast<double>(k) + 0.5) * EngagementMap::bin_rad;
            directions[k] = {std::sin(phi), std::cos(phi)};
        }
        return directions;
    }();
    return table;
}

EngagementMap::Bin flat_bin(const HeightMap& map, const Cutter& cutter, const Eigen::Vector3d& point) {
    const HeightMap::Material material = map.material_above(point.z(), point.x(), point.y());
    EngagementMap::Bin bin;
    // The share of material passes one half where the wall is: a ramp about that point, narrower than a cell, neither
    // widens nor narrows the cut, and a clean wall beside the tool stays out of it.
    const float covered = std::clamp((material.share - 0.5F) * 3.0F + 0.5F, 0.0F, 1.0F);
    if (covered > 0.0F) {
        bin.covered = covered;
        bin.top_mm =
            std::min(material.top_mm - static_cast<float>(point.z()), static_cast<float>(cutter.flute_length_mm));
    }
    return bin;
}

// Of the heights of a ball's edge that lie in material, the lowest and the highest bound the bin.
EngagementMap::Bin ball_bin(const HeightMap& map, const Cutter& cutter, const Eigen::Vector3d& ahead,
                            const Eigen::Vector2d& outward) {
    constexpr int heights = 24;
    const double radius = 0.5 * cutter.diameter_mm;
    EngagementMap::Bin bin;
    for (int k = 0; k < heights; ++k) {
        const double z = radius * (k + 0.5) / heights;
        const double r = std::sqrt(radius * radius - (radius - z) * (radius - z));
        const Eigen::Vector2d point = ahead.head<2>() + outward * r;
        const HeightMap::Material material = map.material_above(ahead.z() + z, point.x(), point.y());
        if (material.share < 0.5F) {
            continue;
        }
        if (bin.covered <= 0.0F) {
            bin.bottom_mm = static_cast<float>(radius * k / heights);
        }
        bin.covered = 1.0F;
        bin.top_mm =
            std::min(static_cast<float>(radius * (k + 1) / heights), material.top_mm - static_cast<float>(ahead.z()));
    }
    return bin;
}

/// Width of a bin's material across the feed, in radii: cos φ_st − cos φ_ex as a product, as bins are narrow.
double width_in_radii(const EngagementMap& map, std::size_t k) {
    const CoveredPart part = covered_part(map, k);
    const double middle = static_cast<double>(k) + 0.5 * (part.low + part.high);
    return std::sin(middle * EngagementMap::bin_rad) * (part.high - part.low) * part.weight * EngagementMap::bin_rad;
}

/// Clears the stretches of material that are narrower than a given width.
void remove_grain(EngagementMap& map, double narrowest_in_radii) {
    constexpr std::size_t end = EngagementMap::bin_count / 2;
    for (std::size_t begin = 0; begin < end; ++begin) {
        double width = 0.0;
        std::size_t k = begin;
        for (; k < end && holds_material(map.bins[k]); ++k) {
            width += width_in_radii(map, k);
        }
        if (width < narrowest_in_radii) {
            std::fill(map.bins.begin() + static_cast<std::ptrdiff_t>(begin),
                      map.bins.begin() + static_cast<std::ptrdiff_t>(k), EngagementMap::Bin{});
        }
        begin = k;
    }
}

}  // namespace

EngagementMap engagement_at(const HeightMap& map, const Cutter& cutter, const Eigen::Vector3d& tip_mm,
                            const Eigen::Vector3d& direction) {
    EngagementMap result;
    const double along = direction.head<2>().norm();
    if (!(along > 1e-6)) {
        return result;
    }
    const Eigen::Vector2d t = direction.head<2>() / along;
    const Eigen::Vector2d n(-t.y(), t.x());
    const double radius = 0.5 * cutter.diameter_mm;
    const double epsilon = 0.5 * map.cell_mm();
    const double margin = map.cell_mm();
    const double furthest = 6.0 * map.cell_mm();
    const double rise =
        std::max(0.0, (2.0 * radius * margin + margin * margin - furthest * furthest) / (2.0 * furthest));
    const double widest = std::sqrt(std::max(0.0, radius * radius - rise * rise));
    const Eigen::Vector3d ahead = tip_mm + Eigen::Vector3d(t.x(), t.y(), 0.0) * epsilon;
    for (std::size_t k = 0; k < EngagementMap::bin_count / 2; ++k) {
        const Direction& u = bin_directions()[k];
        const Eigen::Vector2d outward = t * u.sine + n * u.cosine;
        if (cutter.type == CutterType::ball_end_mill) {
            result.bins[k] = ball_bin(map, cutter, ahead, outward);
        } else {
            // At the same height beside the axis, on a circle that clears the removed one by most of a cell; at the
            // very sides, where that would look far ahead, at the height where it looks `furthest` ahead.
            const double beside = std::clamp(radius * u.cosine, -widest, widest);
            const double in_front = std::sqrt((radius + margin) * (radius + margin) - beside * beside);
            const Eigen::Vector2d point = tip_mm.head<2>() + t * in_front + n * beside;
            result.bins[k] = flat_bin(map, cutter, {point.x(), point.y(), tip_mm.z()});
        }
    }
    remove_grain(result, 0.25 * map.cell_mm() / radius);
    return result;
}

TrueEngagement summarise(const EngagementMap& map) {
    TrueEngagement truth;
    double weighted_depth = 0.0;
    bool inside = false;
    for (std::size_t k = 0; k < EngagementMap::bin_count / 2; ++k) {
        const EngagementMap::Bin& bin = map.bins[k];
        if (!holds_material(bin)) {
            inside = false;
            continue;
        }
        const CoveredPart part = covered_part(map, k);
        const double low = (static_cast<double>(k) + part.low) * EngagementMap::bin_rad;
        const double high = (static_cast<double>(k) + part.high) * EngagementMap::bin_rad;
        const double width = width_in_radii(map, k);
        truth.entry_rad = truth.cutting ? truth.entry_rad : low;
        truth.exit_rad = high;
        truth.cutting = true;
        truth.intervals += inside ? 0 : 1;
        inside = true;
        truth.radial_immersion += width;
        weighted_depth += width * static_cast<double>(bin.top_mm - bin.bottom_mm);
    }
    truth.axial_depth_mm = truth.radial_immersion > 0.0 ? weighted_depth / truth.radial_immersion : 0.0;
    return truth;
}

}  // namespace millforce::sim
