// SPDX-License-Identifier: Apache-2.0
#include "part_map/memory_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "estimation/cutting/cutting_law.hpp"

namespace millforce::host {

namespace {

/// R_r = 1 − cos θ. The larger of both sides: near a slot, and near nothing, the arc's end answers to R_r by a root.
double arc_sd_rad(double immersion, double immersion_sd) {
    const auto angle = [](double radial) { return std::acos(1.0 - std::clamp(radial, 0.0, 2.0)); };
    const double middle = angle(immersion);
    return std::max(angle(immersion + immersion_sd) - middle, middle - angle(immersion - immersion_sd));
}

double depth_mm(const MapPlace& place) {
    return place.cut.front().axial_depth_mm;
}

MapPlace at_most(MapPlace place) {
    place.known = place.known == Known::cut ? Known::at_most : place.known;
    place.least_share = 0.0;
    return place;
}

/// The cuts on both sides of a row of pieces without an engagement.
struct Neighbours {
    const MapPlace* cut = nullptr;  // of the larger section
    bool is_same_block = true;      // the row and that cut: the path does not turn between them
};

Neighbours neighbours_of(const std::vector<MapPlace>& places, std::size_t k, std::size_t reach) {
    Neighbours found;
    const auto section = [](const MapPlace& place) { return immersion_of(place) * depth_mm(place); };
    const auto look = [&](std::size_t at) {
        found.is_same_block = found.is_same_block && (is_air(places[at]) || places[at].line == places[k].line);
        if (is_seen_cut(places[at]) && (found.cut == nullptr || section(*found.cut) < section(places[at]))) {
            found.cut = &places[at];
        }
        return is_air(places[at]) || is_seen_cut(places[at]);
    };
    for (std::size_t at = k; at < std::min(places.size(), k + reach) && !look(at); ++at) {
    }
    for (std::size_t at = k; at + reach > k && !look(at) && at > 0; --at) {
    }
    return found;
}

/// The deepest cut of the same block that was seen within `reach` pieces of the cut in piece k.
const MapPlace& deepest_around(const std::vector<MapPlace>& places, std::size_t k, std::size_t reach) {
    const MapPlace* deepest = &places[k];
    const std::size_t end = std::min(places.size(), k + reach + 1);
    for (std::size_t at = k > reach ? k - reach : 0; at < end; ++at) {
        const bool is_deeper =
            is_seen_cut(places[at]) && places[at].line == places[k].line && depth_mm(places[at]) > depth_mm(*deepest);
        deepest = is_deeper ? &places[at] : deepest;
    }
    return *deepest;
}

/// Estimates differ from one piece of the path to the next by their noise; a cut that stays the same is one place.
class Smoother {
  public:
    explicit Smoother(PartMap& map) : map_(map) {}

    void add(const MapPlace& place) {
        if (!map_.empty() && may_join(map_.back(), place)) {
            join(map_.back(), place);
            return;
        }
        joined_ = 1;
        map_.push_back(place);
    }

  private:
    [[nodiscard]] static bool may_join(const MapPlace& a, const MapPlace& b) {
        constexpr double alike_immersion = 0.05;
        constexpr double alike_depth = 0.04;
        if (a.block_end_mm != b.block_end_mm || a.known != b.known || a.cut.size() != b.cut.size()) {
            return false;
        }
        if (a.cut.empty()) {
            return true;
        }
        const bool is_same_side = (a.cut.front().entry_rad > 0.0) == (b.cut.front().entry_rad > 0.0);
        return is_same_side && std::abs(immersion_of(a) - immersion_of(b)) <= alike_immersion &&
               std::abs(depth_mm(a) - depth_mm(b)) <= alike_depth * depth_mm(a);
    }

    void join(MapPlace& a, const MapPlace& b) {
        joined_ += 1;
        const double share = 1.0 / joined_;
        const auto mix = [share](double& value, double with) { value += share * (with - value); };
        for (std::size_t k = 0; k < a.cut.size(); ++k) {
            mix(a.cut[k].entry_rad, b.cut[k].entry_rad);
            mix(a.cut[k].exit_rad, b.cut[k].exit_rad);
            mix(a.cut[k].axial_depth_mm, b.cut[k].axial_depth_mm);
        }
        mix(a.arc_sd_rad, b.arc_sd_rad);
        mix(a.axial_depth_sd_mm, b.axial_depth_sd_mm);
    }

    PartMap& map_;
    double joined_ = 0.0;
};

class MemoryMap {
  public:
    MemoryMap(const RunMemory& run, std::size_t tool, const firmware::Parameters<float>& parameters,
              double stock_tolerance_mm)
        : run_(run),
          tool_(tool),
          parameters_(parameters),
          next_blank_off_(RunMemory::bin_at(2.0 * stock_tolerance_mm)) {}

    [[nodiscard]] PartMap map() const;

  private:
    [[nodiscard]] std::vector<MapPlace> seen() const;
    [[nodiscard]] MapPlace seen_in(const RunMemory::Bin& bin) const;
    [[nodiscard]] bool is_surely_air(const RunMemory::Bin& bin, const RunMemory::Block& block) const;
    [[nodiscard]] bool carries(const std::vector<EngagedArc>& cut, const RunMemory::Bin& bin) const;
    [[nodiscard]] std::size_t reach() const {
        return RunMemory::bin_at(2.0 * static_cast<double>(parameters_.tool.diameter_mm));
    }
    void bound_by(const std::vector<MapPlace>& seen, std::size_t k, MapPlace& place) const;
    void doubt_depth(const std::vector<MapPlace>& seen, std::size_t k, MapPlace& place) const;
    [[nodiscard]] std::vector<MapPlace> doubted_beside_cuts(const std::vector<MapPlace>& places) const;
    void set_at_most(const MapPlace& cut, bool arc_is_known, const RunMemory::Bin& bin, MapPlace& place) const;
    [[nodiscard]] double end_of(std::size_t block) const;

    const RunMemory& run_;
    std::size_t tool_;
    const firmware::Parameters<float>& parameters_;
    std::size_t next_blank_off_;  // pieces by which another blank may lie elsewhere
};

MapPlace MemoryMap::seen_in(const RunMemory::Bin& bin) const {
    constexpr int by_noise = 4;  // of so many estimates in air one may seem to be in contact
    MapPlace seen;
    if (bin.air > by_noise * bin.contact) {
        return seen;
    }
    if (bin.cut == 0 || 2 * bin.cut < bin.contact) {
        seen.known = bin.contact > 0 ? Known::at_most : Known::nothing;
        return seen;
    }
    const auto count = static_cast<float>(bin.cut);
    const bool is_centred = parameters_.tool.side == estimation::CutSide::centred;
    const estimation::CutSide up_or_down = 2 * bin.up > bin.cut ? estimation::CutSide::up : estimation::CutSide::down;
    const float immersion = bin.immersion / count;
    const auto angles = estimation::engagement_angles(is_centred ? estimation::CutSide::centred : up_or_down, immersion,
                                                      firmware::estimator_settings(parameters_).centre_offset_in_radii);
    seen.cut = {{static_cast<double>(angles.entry_rad), static_cast<double>(angles.exit_rad),
                 static_cast<double>(bin.depth_mm / count)}};
    seen.arc_sd_rad =
        arc_sd_rad(static_cast<double>(immersion), static_cast<double>(std::sqrt(bin.immersion_variance / count)));
    seen.axial_depth_sd_mm = static_cast<double>(std::sqrt(bin.depth_variance_mm2 / count));
    return seen;
}

/// Of each bin; what is at most a neighbour's cut bears that cut.
std::vector<MapPlace> MemoryMap::seen() const {
    std::vector<MapPlace> seen(run_.used);
    std::transform(run_.bins.begin(), run_.bins.begin() + static_cast<std::ptrdiff_t>(run_.used), seen.begin(),
                   [this](const RunMemory::Bin& bin) { return seen_in(bin); });
    for (const RunMemory::Block& block : run_.blocks) {
        for (std::size_t k = RunMemory::bin_at(block.begin_mm);
             k < std::min(RunMemory::bin_at(block.end_mm) + 1, seen.size()); ++k) {
            seen[k].line = block.line;
            if (is_air(seen[k]) && !is_surely_air(run_.bins[k], block)) {
                seen[k].known = Known::nothing;
            }
        }
    }
    std::vector<MapPlace> completed = seen;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        if (seen[k].known == Known::at_most) {
            bound_by(seen, k, completed[k]);
        } else if (is_seen_cut(seen[k])) {
            doubt_depth(seen, k, completed[k]);
        }
    }
    return doubted_beside_cuts(completed);
}

/// What was hidden is a force at the feed of that time, and grows with it.
bool MemoryMap::is_surely_air(const RunMemory::Bin& bin, const RunMemory::Block& block) const {
    constexpr float tooth_per_tangential = 4.0F;  // of a narrow cut, its runout included
    const float air_mm_s = block.feed_mm_s * parameters_.machine.cnc.override_max;
    return block.rapid ||
           tooth_per_tangential * bin.hidden_N_s_per_mm * air_mm_s < parameters_.tool.tooth_force_limit_N;
}

/// F_at of the cut is not below that which was measured there, but for the noise.
bool MemoryMap::carries(const std::vector<EngagedArc>& cut, const RunMemory::Bin& bin) const {
    constexpr float noise = 1.1F;
    float tangential_N = 0.0F;
    for (const EngagedArc& arc : cut) {
        const estimation::EngagementAngles<float> angles{static_cast<float>(arc.entry_rad),
                                                         static_cast<float>(arc.exit_rad)};
        tangential_N += estimation::average_forces(parameters_.tool.law,
                                                   estimation::CutConditions<float>{
                                                       bin.feed_per_tooth_mm, static_cast<float>(arc.axial_depth_mm),
                                                       angles, static_cast<float>(parameters_.tool.teeth)})
                            .tangential_N;
    }
    return bin.highest_N <= noise * tangential_N;
}

/// Where the tool goes straight on, the arc of an entry or exit is a part of its neighbour's; elsewhere only the depth
/// is known.
void MemoryMap::bound_by(const std::vector<MapPlace>& seen, std::size_t k, MapPlace& place) const {
    const Neighbours neighbours = neighbours_of(seen, k, reach());
    place.known = Known::nothing;
    if (neighbours.cut != nullptr) {
        set_at_most(*neighbours.cut, neighbours.is_same_block, run_.bins[k], place);
    }
}

/// Over a hole, or along a slot, a tooth cuts deep on both sides of a gap: its means are those of a wide and shallow
/// cut.
void MemoryMap::doubt_depth(const std::vector<MapPlace>& seen, std::size_t k, MapPlace& place) const {
    constexpr double much_shallower = 0.6;
    const MapPlace& deepest = deepest_around(seen, k, reach());
    if (depth_mm(seen[k]) < much_shallower * depth_mm(deepest)) {
        set_at_most(deepest, true, run_.bins[k], place);
    }
}

/// Where this blank had air, the next one may have stock.
std::vector<MapPlace> MemoryMap::doubted_beside_cuts(const std::vector<MapPlace>& places) const {
    std::vector<MapPlace> doubted = places;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const std::size_t begin = k > next_blank_off_ ? k - next_blank_off_ : 0;
        const std::size_t end = std::min(places.size(), k + next_blank_off_ + 1);
        for (std::size_t at = begin; at < end && is_air(doubted[k]); ++at) {
            doubted[k] = is_air(places[at]) ? doubted[k] : at_most(places[at]);
        }
    }
    return doubted;
}

void MemoryMap::set_at_most(const MapPlace& cut, bool arc_is_known, const RunMemory::Bin& bin, MapPlace& place) const {
    place = cut;
    place.known = Known::at_most;
    if (!arc_is_known || !carries(place.cut, bin)) {
        place.cut = {{0.0, std::numbers::pi, depth_mm(cut)}};
        place.known = carries(place.cut, bin) ? Known::at_most : Known::nothing;
    }
}

/// How far the run was in a block. A CNC may go on with the next one before it has told the end of this one.
double MemoryMap::end_of(std::size_t block) const {
    const bool is_last = block + 1 == run_.blocks.size();
    const double next_mm = is_last ? run_.path_mm : run_.blocks[block + 1].begin_mm;
    return std::min({run_.blocks[block].end_mm, run_.path_mm, next_mm});
}

PartMap MemoryMap::map() const {
    const std::vector<MapPlace> seen = this->seen();
    PartMap map;
    Smoother smoother(map);
    double by_others_mm = 0.0;
    double end_mm = 0.0;
    for (std::size_t i = 0; i < run_.blocks.size(); ++i) {
        const RunMemory::Block& block = run_.blocks[i];
        if (block.tool != tool_) {
            by_others_mm += std::max(end_of(i) - block.begin_mm, 0.0);
            continue;
        }
        double path_mm = block.begin_mm;
        while (path_mm < end_of(i)) {
            const std::size_t k = RunMemory::bin_at(path_mm);
            MapPlace place;
            place.known = Known::nothing;
            if (k < seen.size() && block.feed_mm_s > 0.0F && block.spindle_speed_rad_s > 0.0F) {
                place = seen[k];
            }
            place.path_mm = path_mm - by_others_mm;
            place.block_end_mm = block.end_mm - by_others_mm;
            place.line = block.line;
            place.rapid = block.rapid;
            place.programmed_feed_mm_s = static_cast<double>(block.feed_mm_s);
            place.spindle_speed_rad_s = static_cast<double>(block.spindle_speed_rad_s);
            smoother.add(place);
            path_mm = std::min(RunMemory::bin_mm * static_cast<double>(k + 1), block.end_mm);
        }
        end_mm = (i + 1 == run_.blocks.size() ? run_.path_mm : end_of(i)) - by_others_mm;
    }
    if (!map.empty()) {
        MapPlace end = map.back();
        end.path_mm = end_mm;
        end.cut.clear();
        end.known = Known::cut;
        end.arc_sd_rad = 0.0;
        end.axial_depth_sd_mm = 0.0;
        map.push_back(end);
    }
    return map;
}

}  // namespace

PartMap map_of(const RunMemory& run, std::size_t tool, const firmware::Parameters<float>& parameters,
               double stock_tolerance_mm) {
    return MemoryMap(run, tool, parameters, stock_tolerance_mm).map();
}

}  // namespace millforce::host
