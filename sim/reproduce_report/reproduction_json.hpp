// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "reproduce/reproduction.hpp"

namespace millforce::sim {

/// reproduce.json: per paper its name, title, whether all bounds hold, every figure, every check of our own, every
/// deviation from print and what is not reproduced. A missing value is null.
[[nodiscard]] std::string reproduction_json(std::span<const Reproduction> reproductions);

}  // namespace millforce::sim
