// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "reproduce/reproduction.hpp"

namespace millforce::sim {

/// The figures of a paper for a terminal of 100 columns: name, paper's value, ours, difference, bound, ok or BROKEN; a
/// long name goes on in the next line. Of a long table only what is broken and the row that is nearest to its bound,
/// unless `every_row`. A last line counts.
[[nodiscard]] std::string reproduction_text(const Reproduction& reproduction, bool every_row);

}  // namespace millforce::sim
