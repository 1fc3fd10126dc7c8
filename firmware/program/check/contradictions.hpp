// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check/finding.hpp"
#include "firmware/parameters.hpp"

namespace millforce::host {

/// Keys of the two files that contradict each other, each within its own range.
Findings check_contradictions(const firmware::Parameters<float>& parameters);

/// The in-plane force of the edge alone on one tooth, in N, as long as it is in the cut over the whole depth: the edge
/// forces K_te and K_re along a helix turn with it. It is there at any feed.
double edge_force_of_tooth_N(const firmware::ToolParameters<float>& tool, double axial_depth_mm);

}  // namespace millforce::host
