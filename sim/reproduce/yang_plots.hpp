// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "reproduce/reproduction.hpp"
#include "reproduce/yang_published.hpp"
#include "reproduce/yang_random_cuts.hpp"

namespace millforce::sim::yang {

/// The paper's Figs. 5–7 and 16 redrawn from our forces, and the errors of both methods.
[[nodiscard]] std::vector<Plot> plots(const std::vector<Series>& all, const std::vector<RandomCutOutcome>& outcomes);

}  // namespace millforce::sim::yang
