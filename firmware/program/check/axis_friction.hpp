// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check/finding.hpp"
#include "check/motion_windows.hpp"
#include "firmware/parameters.hpp"

#include <array>
#include <span>

namespace millforce::host {

/// The currents of the axes in air against the friction of the machine's file:
///
///   κ = (I − I_g) / (σ I_f(|w|)),   the mean of both directions; 1 on the machine of the file
///
/// Wrong is what lies beyond four standard deviations: friction_relative_sd, and friction_ripple_A and the noise over
/// I_f. κ ≈ −1: reversed; κ ≈ 0: dead, or swapped with the axis whose motion it follows while this one rests. A factor
/// of √2 or 1/√2 is within the usual friction_relative_sd: then it is a warning where two axes show the same, else a
/// note. Axes without K_x4_N_per_A give no force and are not judged.
/// `current_stands`: of each axis, it has one value in the whole recording.
Findings check_axis_currents(std::span<const MotionWindow> windows, const firmware::MachineParameters<float>& machine,
                             const std::array<bool, hal::axis_count>& current_stands);

}  // namespace millforce::host
