// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "cnc/move.hpp"

namespace millforce::sim {

/// The plane of an arc: its first axis, its second, and the one about which it turns, in a right-handed order.
enum class ArcPlane : std::uint8_t {
    xy,  ///< G17
    zx,  ///< G18
    yz,  ///< G19
};

/// (x, y, z) as (first, second, about).
Eigen::Vector3d in_plane(const Eigen::Vector3d& position_mm, ArcPlane plane);
/// The way back.
Eigen::Vector3d from_plane(const Eigen::Vector3d& position_mm, ArcPlane plane);

/// A move whose positions are given in the plane's axes, as moves in x, y and z. An arc outside xy becomes lines that
/// are within 1 µm of it.
std::vector<Move> moves_from_plane(const Move& move, ArcPlane plane);

}  // namespace millforce::sim
