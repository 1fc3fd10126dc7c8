// SPDX-License-Identifier: Apache-2.0
#include "wrong_maps/drawn_map.hpp"

#include <cmath>

#include "bench_control/drawn_within.hpp"
#include "wrong_maps/wrong_maps.hpp"

namespace millforce::test {

std::string_view name_of(MapError error) {
    switch (error) {
        case MapError::none:
            return "right";
        case MapError::near:
            return "up to 2.5 mm off along the path";
        case MapError::far:
            return "up to 20 mm off along the path";
        case MapError::stretched:
            return "path up to a tenth too long or short";
        case MapError::mirrored:
            return "mirrored";
        case MapError::deeper:
            return "up to 3 times too deep";
        case MapError::shallower:
            return "up to 3 times too shallow";
        case MapError::air:
            return "air from some place on";
        case MapError::other_part:
            return "of another part";
    }
    return "";
}

host::PartMap drawn_map(MapError error, const host::PartMap& map, const host::PartMap& other, std::mt19937_64& random) {
    const double drawn = sim::drawn_within(-1.0, 1.0, random);
    switch (error) {
        case MapError::none:
            break;
        case MapError::near:
            return shifted(map, 2.5 * drawn);
        case MapError::far:
            return shifted(map, 20.0 * drawn);
        case MapError::stretched:
            return stretched(map, 1.0 + 0.1 * drawn);
        case MapError::mirrored:
            return mirrored(map);
        case MapError::deeper:
            return deeper(map, std::pow(3.0, std::abs(drawn)));
        case MapError::shallower:
            return deeper(map, std::pow(3.0, -std::abs(drawn)));
        case MapError::air:
            return with_air_behind(map, std::abs(drawn));
        case MapError::other_part:
            return other;
    }
    return map;
}

}  // namespace millforce::test
