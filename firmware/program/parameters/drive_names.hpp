// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace millforce::host {

/// The drives in the order of their places, as tables and columns call them.
inline constexpr std::array<std::string_view, 4> drive_names{"spindle", "x", "y", "z"};

}  // namespace millforce::host
