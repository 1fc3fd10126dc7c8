// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check/finding.hpp"
#include "check/motion_windows.hpp"
#include "check/order_spectrum.hpp"
#include "firmware/parameters.hpp"

#include <span>
#include <vector>

namespace millforce::host {

/// The number of teeth from the lines of the cut's spectrum at multiples of the spindle's order. N equal teeth have
/// lines at N, 2N, 3N …; runout adds weaker ones at the others, most of all at 1. Each line's power counts times its
/// order, which makes up for part of what the spindle's loop keeps of the higher ones. With S_n the sum over the
/// multiples of n but 1 itself, the stated N is wrong where
///
///   a multiple of N has ≥ 0.9 S_N                   more teeth
///   a divisor n = N/q has > (0.65 q + 0.3) S_N      fewer teeth: of a narrow cut n has q S_N, runout adds far less
///   another number has > 4 S_N, without the common multiples of both
///
/// Where the line at 1 is stronger than all others nothing is said: such is a single tooth, but also a slot of a
/// helical tool, in which the teeth add up to an even torque and only the runout is left. Lines that the air shows as
/// well do not count. A line between two whole orders, stronger than all others, is no tooth: the counts per revolution
/// are wrong. It takes eight blocks of eight revolutions in the cut, and 2.5 samples per tooth.
struct ToothEvidence {
    std::span<const OrderBlock> blocks;
    bool counts_are_proven = false;  ///< by index pulses
    bool comes_seldom = false;       ///< the signal is not sampled as often as it is recorded
};

Findings check_teeth(const ToothEvidence& evidence, std::span<const MotionWindow> windows,
                     const firmware::ToolParameters<float>& tool);

}  // namespace millforce::host
