// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check/finding.hpp"
#include "check/motion_windows.hpp"
#include "firmware/parameters.hpp"

#include <span>
#include <string>

namespace millforce::host {

/// The recorded motion against what a tool can do and what the files state: feed per tooth and cutting speed
/// (calibration/plausible_units.hpp, at the median feed of the windows that are no rapid), the programmed feed (the
/// axes are no faster than 1.5 times F with the largest override, and not 20 times slower), the rate of the samples,
/// and whether that feed is above the axes' velocity floors. `name` of the recording, for messages.
Findings check_motion(const std::string& name, std::span<const MotionWindow> windows,
                      const firmware::Parameters<float>& parameters);

}  // namespace millforce::host
