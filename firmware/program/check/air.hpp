// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check/motion_windows.hpp"
#include "firmware/parameters.hpp"

#include <span>

namespace millforce::host {

/// Sets `place` of each window. Certain air: axes at rest, rapids, and a spindle that stands. Air is also where the
/// spindle's current is as small as there; without any, as small as the smallest of the recording, if that is the idle
/// current of the machine's file and there are larger ones.
///
/// The spindle's current is used by its magnitude, compared with that of certain air at the
/// same speed: so a wrong gain or sign of it does no harm. It counts as air up to four standard deviations of the
/// current's noise and `contact_force_N`, as for the controller.
/// `spindle_shows`: false where the spindle's current says nothing (it stands still): then only certain air counts.
void find_air(std::span<MotionWindow> windows, const firmware::Parameters<float>& parameters, bool spindle_shows);

}  // namespace millforce::host
