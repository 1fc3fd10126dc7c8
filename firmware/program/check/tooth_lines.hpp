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
/// lines at N, 2N, 3N …; runout adds weaker ones at the others. Each line's power counts times its order, which makes
/// up for part of what the spindle's loop keeps of the higher ones. With S_n the sum over the multiples of n:
///
///   a multiple of the stated N has ≥ 0.9 S_N                     more teeth
///   a divisor of N, N = q n, has > (0.65 q + 0.3) S_N            fewer teeth: q equal lines of a narrow cut have q S_N
///   another number has > 4 S_N                                   another number
///
/// Lines that the air shows as well are not counted. A line between two whole orders, stronger than all others, is no
/// tooth: the counts per revolution are wrong. Takes eight blocks of eight revolutions in the cut and 2.5 samples per
/// tooth.
struct ToothEvidence {
    std::span<const OrderBlock> blocks;
    bool counts_are_proven = false;  ///< by index pulses
};

Findings check_teeth(const ToothEvidence& evidence, std::span<const MotionWindow> windows,
                     const firmware::ToolParameters<float>& tool);

}  // namespace millforce::host
