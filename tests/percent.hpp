// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <fmt/format.h>

namespace millforce::test {

/// For a table; a dash where there is nothing to count.
inline std::string percent(int part, int whole) {
    return whole == 0 ? "–" : fmt::format("{:.1f}", 100.0 * part / whole);
}

}  // namespace millforce::test
