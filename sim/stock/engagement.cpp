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
        bin.top_mm = std::min(material.top_mm - static_cast<float>(point.z()),
                              static_cast<float>(cutter.flute_length_mm));
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
        bin.top_mm = std::min(static_cast<float>(radius * (k + 1) / heights),
                              material.top_mm - static_cast<float>(ahead.z()));
    }
    return bin;
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
    const double margin = 0.8 * map.cell_mm();
    const double furthest = 6.0 * map.cell_mm();
    const double rise = std::max(0.0, (2.0 * radius * margin + margin * margin - furthest * furthest) / (2.0 * furthest));
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
        const double begin_rad = static_cast<double>(k) * EngagementMap::bin_rad;
        const double low = begin_rad + part.low * EngagementMap::bin_rad;
        const double high = begin_rad + part.high * EngagementMap::bin_rad;
        // cos φ_st − cos φ_ex as a product: the bins are narrow.
        const double width = std::sin(0.5 * (low + high)) * (high - low) * part.weight;
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
