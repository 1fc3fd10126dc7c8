// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "calibration/recorded_cuts.hpp"
#include "firmware/feed_frame_forces.hpp"
#include "firmware/parameters.hpp"

namespace millforce::host {

using FeedForces = firmware::FeedFrameForces<float>::Forces;

/// One sample of a recorded cut in the feed's frame; dt_s is 0 at its beginning.
using ForceTaker = std::function<void(std::size_t cut, float dt_s, const FeedForces& forces)>;

/// Reads the recordings and hands over the samples within each cut of the table, in the recording's order. Samples that
/// are not valid come too: averages must restart there. Throws InputError.
void read_recorded_forces(const std::vector<std::filesystem::path>& recordings,
                          const std::vector<StretchConditions>& cuts, const firmware::Parameters<float>& parameters,
                          const ForceTaker& take);

/// The rows of the table that cut, with the tool of the parameters. Throws InputError where there is none, or a row's
/// diameter or flutes are another tool's.
std::vector<StretchConditions> cuts_of_tool(const std::filesystem::path& table,
                                            const std::vector<std::filesystem::path>& recordings,
                                            const firmware::ToolParameters<float>& tool);

}  // namespace millforce::host
