// SPDX-License-Identifier: Apache-2.0
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

/// `cells_across`: how many cells wide the bin is across the feed.
EngagementMap::Bin flat_bin(const HeightMap& map, const Cutter& cutter, const Eigen::Vector3d& point,
                            double cells_across) {
    const HeightMap::Material material = map.material_above(point.z(), point.x(), point.y());
    EngagementMap::Bin bin;
    // The share of material passes one half where a wall is and changes by one over a cell: so as much of the bin is
    // covered as the wall lies beside its middle.
    const auto steepness = static_cast<float>(std::max(1.0, 1.0 / cells_across));
    const float covered = std::clamp((material.share - 0.5F) * steepness + 0.5F, 0.0F, 1.0F);
    if (covered > 0.0F) {
        bin.covered = covered;
        bin.top_mm =
            std::min(material.top_mm - static_cast<float>(point.z()), static_cast<float>(cutter.flute_length_mm));
    }
    return bin;
}

/// Where to look for the material that the periphery is about to meet.
class LookAhead {
  public:
    LookAhead(const HeightMap& map, const Eigen::Vector3d& tip_mm, const Eigen::Vector2d& feed)
        : tip_mm_(tip_mm), feed_(feed), left_(-feed.y(), feed.x()), margin_mm_(map.cell_mm()) {}

    /// Sets the radius and the height over the tip. The points lie on a circle that clears the removed one; at the very
    /// sides, where that would look further ahead than `furthest`, as far beside the axis as it does not.
    void set_circle(double radius_mm, double height_mm) {
        const double furthest = 6.0 * margin_mm_;
        const double clearance = 2.0 * radius_mm * margin_mm_ + margin_mm_ * margin_mm_;
        const double rise = std::max(0.0, (clearance - furthest * furthest) / (2.0 * furthest));
        radius_mm_ = radius_mm;
        reach_squared_mm2_ = radius_mm * radius_mm + clearance;
        widest_mm_ = std::sqrt(std::max(0.0, radius_mm * radius_mm - rise * rise));
        height_mm_ = tip_mm_.z() + height_mm;
    }

    [[nodiscard]] Eigen::Vector3d point(const Direction& u) const {
        const double beside = std::clamp(radius_mm_ * u.cosine, -widest_mm_, widest_mm_);
        const double in_front = std::sqrt(reach_squared_mm2_ - beside * beside);
        const Eigen::Vector2d place = tip_mm_.head<2>() + feed_ * in_front + left_ * beside;
        return {place.x(), place.y(), height_mm_};
    }

  private:
    Eigen::Vector3d tip_mm_;
    Eigen::Vector2d feed_;
    Eigen::Vector2d left_;
    double margin_mm_;
    double radius_mm_ = 0.0;
    double reach_squared_mm2_ = 0.0;
    double widest_mm_ = 0.0;
    double height_mm_ = 0.0;
};

// Of the heights of a ball's edge that lie in material, the lowest and the highest bound the bin.
EngagementMap::Bin ball_bin(const HeightMap& map, const Cutter& cutter, LookAhead& ahead, const Direction& u) {
    constexpr int heights = 24;
    const double radius = 0.5 * cutter.diameter_mm;
    EngagementMap::Bin bin;
    for (int k = 0; k < heights; ++k) {
        const double z = radius * (k + 0.5) / heights;
        ahead.set_circle(local_radius_mm(cutter, z), z);
        const Eigen::Vector3d point = ahead.point(u);
        const HeightMap::Material material = map.material_above(point.z(), point.x(), point.y());
        if (material.share < 0.5F) {
            continue;
        }
        if (bin.covered <= 0.0F) {
            bin.bottom_mm = static_cast<float>(radius * k / heights);
        }
        bin.covered = 1.0F;
        bin.top_mm = std::min(static_cast<float>(radius * (k + 1) / heights),
                              material.top_mm - static_cast<float>(point.z() - z));
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
    const double radius = 0.5 * cutter.diameter_mm;
    LookAhead ahead(map, tip_mm, direction.head<2>() / along);
    ahead.set_circle(radius, 0.0);
    const double bin_in_cells = radius * EngagementMap::bin_rad / map.cell_mm();
    for (std::size_t k = 0; k < EngagementMap::bin_count / 2; ++k) {
        const Direction& u = bin_directions()[k];
        result.bins[k] = cutter.type == CutterType::ball_end_mill
                             ? ball_bin(map, cutter, ahead, u)
                             : flat_bin(map, cutter, ahead.point(u), bin_in_cells * u.sine);
    }
    remove_grain(result, 0.25 * map.cell_mm() / radius);
    return result;
}

namespace {

/// Of the thickest bin's height: what is thinner is the floor's own skin, which a tool pressed down by some micrometres
/// scrapes off with its end, and no wall.
constexpr float skin_share = 0.02F;

float thickest_mm(const EngagementMap& map) {
    float thickest = 0.0F;
    for (std::size_t k = 0; k < EngagementMap::bin_count / 2; ++k) {
        const EngagementMap::Bin& bin = map.bins[k];
        thickest = holds_material(bin) ? std::max(thickest, bin.top_mm - bin.bottom_mm) : thickest;
    }
    return thickest;
}

}  // namespace

TrueEngagement summarise(const EngagementMap& map) {
    TrueEngagement truth;
    double weighted_depth = 0.0;
    bool inside = false;
    const float skin_mm = skin_share * thickest_mm(map);
    for (std::size_t k = 0; k < EngagementMap::bin_count / 2; ++k) {
        const EngagementMap::Bin& bin = map.bins[k];
        if (!holds_material(bin) || bin.top_mm - bin.bottom_mm < skin_mm) {
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
