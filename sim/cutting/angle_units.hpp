// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

/// Angles in radians and speeds in rad/s, by the units that tools and programs are described in.

namespace millforce::sim {

inline constexpr double turn = 2.0 * std::numbers::pi;
inline constexpr double degree = std::numbers::pi / 180.0;
inline constexpr double rad_s_per_rpm = turn / 60.0;

}  // namespace millforce::sim
