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

/// Width of a bin's material across the feed, in radii: cos φ_st − cos φ_ex as a product, as bins are narrow.
double width_in_radii(const EngagementMap& map, std::size_t k) {
    if (map.bins[k].covered >= 1.0F) {
        return bin_directions()[k].sine * EngagementMap::bin_rad;
    }
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

LookAhead::LookAhead(const Cutter& cutter, double cell_mm) : cell_mm_(cell_mm), cutter_(cutter) {
    constexpr std::size_t ball_heights = 24;
    const bool ball = cutter.type == CutterType::ball_end_mill;
    rings_.reserve(ball ? ball_heights : 1);
    if (!ball) {
        rings_.push_back(ring(0.0, 0.5 * cutter.diameter_mm));
    }
    for (std::size_t k = 0; ball && k < ball_heights; ++k) {
        const double height_mm = 0.5 * cutter.diameter_mm * (static_cast<double>(k) + 0.5) / ball_heights;
        rings_.push_back(ring(height_mm, local_radius_mm(cutter, height_mm)));
    }
}

/// The points lie on a circle that clears the removed one; at the very sides, where that would look further ahead than
/// `furthest`, as far from the axis as keeps within it.
LookAhead::Ring LookAhead::ring(double height_mm, double radius_mm) const {
    const double furthest_mm = 6.0 * cell_mm_;
    const double clearance_mm2 = 2.0 * radius_mm * cell_mm_ + cell_mm_ * cell_mm_;
    const double rise_mm = std::max(0.0, (clearance_mm2 - furthest_mm * furthest_mm) / (2.0 * furthest_mm));
    const double widest_mm = std::sqrt(std::max(0.0, radius_mm * radius_mm - rise_mm * rise_mm));
    Ring ring{.height_mm = height_mm, .points_mm = {}};
    for (std::size_t k = 0; k < ring.points_mm.size(); ++k) {
        const double beside_mm = std::clamp(radius_mm * bin_directions()[k].cosine, -widest_mm, widest_mm);
        const double in_front_mm = std::sqrt(radius_mm * radius_mm + clearance_mm2 - beside_mm * beside_mm);
        ring.points_mm[k] = {in_front_mm, beside_mm};
    }
    return ring;
}

EngagementMap LookAhead::engagement(const HeightMap& map, const Eigen::Vector3d& tip_mm,
                                    const Eigen::Vector3d& direction) const {
    EngagementMap result;
    const double along = direction.head<2>().norm();
    if (!(along > 1e-6)) {
        return result;
    }
    const Eigen::Vector2d feed = direction.head<2>() / along;
    const Eigen::Vector2d left(-feed.y(), feed.x());
    const auto material_at = [&](const Ring& ring, std::size_t k) {
        const Eigen::Vector2d& ahead_mm = ring.points_mm[k];
        const Eigen::Vector2d place_mm = tip_mm.head<2>() + feed * ahead_mm.x() + left * ahead_mm.y();
        return map.material_above(tip_mm.z() + ring.height_mm, place_mm.x(), place_mm.y());
    };
    for (std::size_t k = 0; k < EngagementMap::bin_count / 2; ++k) {
        if (cutter_.type == CutterType::ball_end_mill) {
            result.bins[k] = ball_bin([&](const Ring& ring) { return material_at(ring, k); }, tip_mm.z());
        } else {
            result.bins[k] = flat_bin(material_at(rings_.front(), k), tip_mm.z(), bin_directions()[k].sine);
        }
    }
    remove_grain(result, 0.25 * cell_mm_ / (0.5 * cutter_.diameter_mm));
    return result;
}

EngagementMap::Bin LookAhead::flat_bin(const HeightMap::Material& material, double tip_z_mm, double sine) const {
    EngagementMap::Bin bin;
    bin.covered = material.share;
    if (material.share > 0.0F && material.share < 1.0F) {
        // The share of material passes one half where a wall is and changes by one over a cell: so the covered part of
        // the bin follows from the wall's distance from its middle.
        const double cells_across = 0.5 * cutter_.diameter_mm * EngagementMap::bin_rad / cell_mm_ * sine;
        const auto steepness = static_cast<float>(std::max(1.0, 1.0 / cells_across));
        bin.covered = std::clamp((material.share - 0.5F) * steepness + 0.5F, 0.0F, 1.0F);
    }
    if (bin.covered > 0.0F) {
        bin.top_mm =
            std::min(material.top_mm - static_cast<float>(tip_z_mm), static_cast<float>(cutter_.flute_length_mm));
    }
    return bin;
}

// Of the heights of a ball's edge that lie in material, the lowest and the highest bound the bin.
template <typename MaterialAt>
EngagementMap::Bin LookAhead::ball_bin(const MaterialAt& material_at, double tip_z_mm) const {
    const double half_spacing_mm = 0.25 * cutter_.diameter_mm / static_cast<double>(rings_.size());
    EngagementMap::Bin bin;
    for (const Ring& ring : rings_) {
        const HeightMap::Material material = material_at(ring);
        if (material.share < 0.5F) {
            continue;
        }
        if (bin.covered <= 0.0F) {
            bin.bottom_mm = static_cast<float>(ring.height_mm - half_spacing_mm);
        }
        bin.covered = 1.0F;
        bin.top_mm = std::min(static_cast<float>(ring.height_mm + half_spacing_mm),
                              material.top_mm - static_cast<float>(tip_z_mm));
    }
    return bin;
}

namespace {

/// Share of the thickest bin's height: what is thinner is not a wall but the skin of the floor, which a tool pressed
/// down by some micrometres scrapes off with its end.
constexpr float skin_share = 0.02F;

float thickest_mm(const EngagementMap& map) {
    float thickest = 0.0F;
    for (std::size_t k = 0; k < EngagementMap::bin_count / 2; ++k) {
        const EngagementMap::Bin& bin = map.bins[k];
        thickest = holds_material(bin) ? std::max(thickest, bin.top_mm - bin.bottom_mm) : thickest;
    }
    return thickest;
}

/// A bin's material but for the skin.
struct EngagedPart {
    double low_rad;
    double high_rad;
    double width;  // in radii
    double height_mm;
    bool follows;  // the bin before is engaged as well
};

template <typename Visit>
void for_each_engaged(const EngagementMap& map, const Visit& visit) {
    bool follows = false;
    const float skin_mm = skin_share * thickest_mm(map);
    for (std::size_t k = 0; k < EngagementMap::bin_count / 2; ++k) {
        const EngagementMap::Bin& bin = map.bins[k];
        if (!holds_material(bin) || bin.top_mm - bin.bottom_mm < skin_mm) {
            follows = false;
            continue;
        }
        const CoveredPart part = covered_part(map, k);
        visit(EngagedPart{.low_rad = (static_cast<double>(k) + part.low) * EngagementMap::bin_rad,
                          .high_rad = (static_cast<double>(k) + part.high) * EngagementMap::bin_rad,
                          .width = width_in_radii(map, k),
                          .height_mm = static_cast<double>(bin.top_mm - bin.bottom_mm),
                          .follows = follows});
        follows = true;
    }
}

}  // namespace

TrueEngagement summarise(const EngagementMap& map) {
    TrueEngagement truth;
    double weighted_depth = 0.0;
    for_each_engaged(map, [&](const EngagedPart& part) {
        truth.entry_rad = truth.cutting ? truth.entry_rad : part.low_rad;
        truth.exit_rad = part.high_rad;
        truth.cutting = true;
        truth.intervals += part.follows ? 0 : 1;
        truth.radial_immersion += part.width;
        weighted_depth += part.width * part.height_mm;
    });
    truth.axial_depth_mm = truth.radial_immersion > 0.0 ? weighted_depth / truth.radial_immersion : 0.0;
    return truth;
}

std::vector<UniformArc> uniform_arcs(const EngagementMap& map) {
    constexpr double same_height = 0.1;
    std::vector<UniformArc> arcs;
    double width = 0.0;
    for_each_engaged(map, [&](const EngagedPart& part) {
        const bool goes_on =
            part.follows && std::abs(part.height_mm - arcs.back().height_mm) <= same_height * arcs.back().height_mm;
        if (!goes_on) {
            arcs.push_back({part.low_rad, part.high_rad, part.height_mm});
            width = part.width;
            return;
        }
        UniformArc& arc = arcs.back();
        arc.exit_rad = part.high_rad;
        arc.height_mm = (arc.height_mm * width + part.height_mm * part.width) / (width + part.width);
        width += part.width;
    });
    return arcs;
}

}  // namespace millforce::sim
