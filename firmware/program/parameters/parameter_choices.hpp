// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace millforce::host {

/// Of a row of the parameters' tables.
inline constexpr bool must_be_given = true;
inline constexpr bool may_be_left_out = false;

/// The words of a parameter row's choices, "down|up" → {"down", "up"}.
std::vector<std::string> words_of(const char* choices);

/// The double that a table's float was written as: 0.1F → 0.1, not 0.10000000149.
double decimal(float value);

}  // namespace millforce::host
