// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "part_map/part_map.hpp"

/// Part maps that do not fit the block.

namespace millforce::test {

/// The place that holds there.
inline const host::MapPlace& place_holding_at(const host::PartMap& map, double path_mm) {
    return *(std::ranges::upper_bound(map, path_mm, {}, &host::MapPlace::path_mm) - 1);
}

/// The same path over stock that lies `by_mm` further along it.
inline host::PartMap shifted(const host::PartMap& map, double by_mm) {
    host::PartMap result = map;
    for (host::MapPlace& place : result) {
        const host::MapPlace& source = place_holding_at(map, std::max(place.path_mm - by_mm, 0.0));
        place.cut = source.cut;
        place.known = source.known;
    }
    return result;
}

inline host::PartMap mirrored(const host::PartMap& map) {
    host::PartMap result = map;
    for (std::size_t i = 0; i < map.size(); ++i) {
        result[i].cut = map[map.size() - 1 - i].cut;
        result[i].known = map[map.size() - 1 - i].known;
    }
    return result;
}

inline host::PartMap deeper(host::PartMap map, double factor) {
    for (host::MapPlace& place : map) {
        for (host::EngagedArc& arc : place.cut) {
            arc.axial_depth_mm *= factor;
        }
    }
    return map;
}

/// The same cuts along a path that is longer by a factor.
inline host::PartMap stretched(host::PartMap map, double factor) {
    for (host::MapPlace& place : map) {
        place.path_mm *= factor;
    }
    return map;
}

inline host::PartMap with_air_behind(host::PartMap map, double share) {
    for (host::MapPlace& place : map) {
        if (place.path_mm > share * map.back().path_mm) {
            place.cut.clear();
            place.known = host::Known::cut;
        }
    }
    return map;
}

}  // namespace millforce::test
