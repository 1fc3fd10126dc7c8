// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "judging/drawn_cut.hpp"

#include <span>

/// The tick on recordings of drawn cuts, held against the truth.

namespace millforce::judging {

/// Of one cut. Estimates are looked at once in four revolutions of the steady cut, from four revolutions after its
/// beginning.
struct Verdict {
    int looks = 0;
    int immersions = 0;         ///< looks with an immersion
    int immersions_beyond = 0;  ///< of them, more than three stated deviations off
    int beyond_with_twin = 0;   ///< of these, right ones for a twin of the cut (twin.hpp)
    int depths = 0;
    int depths_beyond = 0;
    int depths_beyond_flute = 0;
    bool last_has_immersion = false;
    bool last_immersion_covers = false;  ///< the 95 % interval of the last look holds the true one
    bool last_has_depth = false;
    bool last_depth_covers = false;
    double revolutions_above = 0.0;    ///< longest time in a row with the override above what the true cut allows
    double largest_excess = 0.0;       ///< largest override over what the true cut allows
    bool is_right_for_a_twin = false;  ///< where that was largest at a look: a twin allows that override
    bool has_fault = false;
};

Verdict judge(const DrawnCut& drawn);

struct Tally {
    int cuts = 0;
    int cuts_with_immersion = 0;
    int immersions_cover = 0;
    int cuts_with_depth = 0;
    int depths_cover = 0;
    int immersions = 0;
    int immersions_beyond = 0;
    int beyond_with_twin = 0;
    int depths = 0;
    int depths_beyond = 0;
    int depths_beyond_flute = 0;
    int cuts_too_fast = 0;        ///< above what the true cut allows for longer than two revolutions
    int too_fast_with_twin = 0;   ///< of these, not too fast for a twin of the cut
    double largest_excess = 0.0;  ///< of these
    int faults = 0;

    void add(const Verdict& verdict);
};

}  // namespace millforce::judging
