// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "control/feed_ahead.hpp"
#include "firmware/parameters.hpp"

namespace millforce::host {

/// A stretch of the tool's periphery that is in material, of one height. φ as in estimation/cutting/cut_geometry.hpp.
struct EngagedArc {
    double entry_rad = 0.0;
    double exit_rad = 0.0;
    double axial_depth_mm = 0.0;

    bool operator==(const EngagedArc&) const = default;
};

/// Of K_s relative to the tool's file, in any map.
inline constexpr double least_hardness = 0.1;
inline constexpr double largest_hardness = 10.0;

/// How well the cut at a place is known.
enum class Known : std::uint8_t {
    nothing,  ///< not at all: the controller takes it as if there were no map
    at_most,  ///< it is between least_share of this cut and all of it
    cut,      ///< it is this cut, or air
};

/// The cut along a program's path: what the tool meets, and how it is to go there.
struct MapPlace {
    double path_mm = 0.0;       ///< gone since the program's begin, rapids included
    double block_end_mm = 0.0;  ///< path at the end of the block that the place is in
    std::size_t line = 0;       ///< line of the program, 1 the first
    bool rapid = false;
    double programmed_feed_mm_s = 0.0;
    double spindle_speed_rad_s = 0.0;
    std::vector<EngagedArc> cut{};  ///< engaged arcs in the order of φ; empty: air
    Known known = Known::cut;
    double least_share = 0.0;        ///< of its force, where it is known at most; 0: the tool may be in air
    double arc_sd_rad = 0.0;         ///< standard deviation of the arcs' ends; 0: as geometry has them
    double axial_depth_sd_mm = 0.0;  ///< of the depth, without what K_s leaves open; 0: as geometry has it
    double hardness = 1.0;           ///< K_s relative to the tool's file; measured, or 1
    double hardness_sd = 0.0;        ///< 0: not measured
    double position_sd_mm = 0.0;     ///< of the place along the path; 0: not measured
    bool is_contested = false;       ///< geometry and run disagree here beyond their doubt
};

/// Each place holds to the next one. The last is the program's end.
using PartMap = std::vector<MapPlace>;

/// Known to be air.
[[nodiscard]] inline bool is_air(const MapPlace& place) {
    return place.known == Known::cut && place.cut.empty();
}
/// A cut as it is, not only what it may be at most.
[[nodiscard]] inline bool is_seen_cut(const MapPlace& place) {
    return place.known == Known::cut && !place.cut.empty();
}

/// Alike within 0.005 rad and 0.01 mm, at the same programmed feed and speed, and known alike: of equal forces at equal
/// feeds.
[[nodiscard]] bool is_same_cut(const MapPlace& a, const MapPlace& b);

/// a_e/R of all its arcs, 0…2.
[[nodiscard]] double immersion_of(const MapPlace& place);

/// Of the highest tooth, by the tool's cutting law at the programmed feed. 0 in air and where nothing is known.
[[nodiscard]] double tooth_force_N(const MapPlace& place, const firmware::ToolParameters<float>& tool);

/// The map as the controller takes it (control/feed_ahead.hpp): the feed at which a tooth reaches its set point by the
/// tool's cutting law, and the forces there. Neighbours whose feeds and forces are alike are one stretch, with the
/// lower feed. In air no stretch is faster than the machine's largest override allows, in a cut than twice that: a
/// softer batch may use some of it, and the controller bounds its override. Cost: some 1,000 single-tooth forces
/// for each change of the cut.
[[nodiscard]] std::vector<control::Stretch<float>> stretches_of(const PartMap& map,
                                                                const firmware::Parameters<float>& parameters);

}  // namespace millforce::host
