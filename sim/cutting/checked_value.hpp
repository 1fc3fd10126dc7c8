// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string_view>

#include "files/input_error.hpp"

namespace millforce::sim {

/// Throws InputError unless low ≤ value ≤ high; NaN and infinities are never in range.
inline void check_range(std::string_view name, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
        throw host::InputError(fmt::format("{}: {}, expected {:.6g} to {:.6g}", name, value, low, high));
    }
}

}  // namespace millforce::sim
