// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "reproduce/reproduction.hpp"
#include "reproduce/yang_published.hpp"
#include "reproduce/yang_random_cuts.hpp"

namespace millforce::sim::yang {

/// The paper's Figs. 5–8, 10, 11 and 13–16 redrawn from our forces, and the errors of both methods.
[[nodiscard]] std::vector<Plot> plots(const std::vector<Series>& all, const std::vector<RandomCutOutcome>& outcomes);

}  // namespace millforce::sim::yang
