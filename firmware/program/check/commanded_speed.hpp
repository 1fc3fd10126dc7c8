// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check/finding.hpp"
#include "check/motion_windows.hpp"
#include "firmware/parameters.hpp"

#include <optional>
#include <span>

namespace millforce::host {

/// The spindle's speed by the encoder over the commanded one: the median of the windows in which it has turned at an
/// even speed, and was commanded one, for a second. Nothing where there is none.
[[nodiscard]] std::optional<double> ratio_to_commanded_speed(std::span<const MotionWindow> windows);

/// Wrong is what is a fifth off, as while the machine runs (firmware/commanded_speed.hpp). `ratio`: that above.
/// `counts_are_proven`: index pulses prove the encoder's counts right, so it is the command that is wrong.
[[nodiscard]] Findings check_commanded_speed(std::optional<double> ratio,
                                             const firmware::MachineParameters<float>& machine, bool counts_are_proven);

}  // namespace millforce::host
