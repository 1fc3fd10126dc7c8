// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check/finding.hpp"
#include "check/motion_windows.hpp"
#include "estimation/drives/spindle_drive.hpp"
#include "firmware/parameters.hpp"

#include <span>

namespace millforce::host {

/// The spindle's torque of a window that turns, without the cut: K_t1(ω) I + K_t2 − k ω − J dω/dt. Zero in air.
double torque_beyond_idle_Nm(const estimation::SpindleDriveParameters<float>& spindle, const MotionWindow& window);

/// Whether the controller would take the window for air: the torque beyond idle is within four of its stated standard
/// deviations (idle_torque_sd_Nm, warm-up, noise).
bool is_plausible_idle(const estimation::SpindleDriveParameters<float>& spindle, const MotionWindow& window);

/// The same window with the spindle's current times `factor`.
MotionWindow with_spindle_current_times(MotionWindow window, double factor);

/// The spindle's current in air against the idle torque of the machine's file: dead, reversed, in another unit, peak
/// for rms, or of another machine. Where no air is known: reversed alone, for a cut cannot make the torque negative.
/// `current_stands`: it has one value in the whole recording.
Findings check_spindle_current(std::span<const MotionWindow> windows, const firmware::MachineParameters<float>& machine,
                               bool current_stands);

}  // namespace millforce::host
