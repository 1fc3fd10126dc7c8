// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "reproduce/reproduction.hpp"

namespace millforce::sim {

/// A paper for a terminal of 100 columns. First its figures: name, paper's value, ours, difference, bound, ok or
/// BROKEN; a long name goes on in the next line, a reason follows. Then the checks of our own, and what is not
/// reproduced. Of a long table only what is broken and the row that is nearest to its bound, unless `every_row`. The
/// last lines count.
[[nodiscard]] std::string reproduction_text(const Reproduction& reproduction, bool every_row);

}  // namespace millforce::sim
