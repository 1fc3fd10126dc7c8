// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <random>
#include <string_view>

#include "part_map/part_map.hpp"

/// Part maps as they are, and wrong in each way that comes to mind.

namespace millforce::test {

enum class MapError : std::uint8_t {
    none,
    near,       ///< the stock up to 2.5 mm off along the path
    far,        ///< up to 20 mm
    stretched,  ///< the path up to a tenth too long or too short
    mirrored,   ///< the cuts in the order from the end to the begin
    deeper,     ///< than the cut by a factor of up to 3
    shallower,  ///< by a factor of up to 3
    air,        ///< nothing but air from some place on
    other_part
};

inline constexpr std::array all_map_errors{MapError::none,      MapError::near,     MapError::far,
                                           MapError::stretched, MapError::mirrored, MapError::deeper,
                                           MapError::shallower, MapError::air,      MapError::other_part};

[[nodiscard]] std::string_view name_of(MapError error);

/// `other`: the map of another part.
[[nodiscard]] host::PartMap drawn_map(MapError error, const host::PartMap& map, const host::PartMap& other,
                                      std::mt19937_64& random);

}  // namespace millforce::test
