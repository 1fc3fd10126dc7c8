// SPDX-License-Identifier: Apache-2.0
#include "check/unseen_faults.hpp"

namespace millforce::host {

std::vector<std::string> unseen_faults(const firmware::Parameters<float>& parameters) {
    const auto& axes = parameters.machine.axes;
    const bool has_axes = axes[0].K_x4_N_per_A > 0.0F || axes[1].K_x4_N_per_A > 0.0F;
    std::vector<std::string> faults;
    if (has_axes) {
        faults.emplace_back(
            "a current that drifts within one cut looks like a cut that changes in width and depth; the larger of the "
            "forces by the spindle and by the axes counts then, and may still be too small: the drift is found in the "
            "next air");
    } else {
        faults.emplace_back(
            "a spindle current that drifts within one cut looks like a cut that becomes lighter: a fall of the force "
            "of up to 5 % of rated_current_A per second does not raise the feed until the next air, a faster drift "
            "does");
        faults.emplace_back(
            "a spindle current that is too small in the cut, though its idle current is right, is contradicted by no "
            "second current");
    }
    faults.emplace_back(
        "a programmed feed that is told too high, and velocities that are told too low, only slow the machine down; "
        "nothing reports them");
    return faults;
}

}  // namespace millforce::host
