// SPDX-License-Identifier: Apache-2.0
#include "check/unseen_faults.hpp"

#include <fmt/format.h>

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
    const auto& machine = parameters.machine;
    if (machine.spindle_load_period_s > 0.0F) {
        faults.push_back(fmt::format(
            "the spindle's load comes every {:g} s (load_period_s) and is {:g} s old by then (load_age_s): what the "
            "tool meets shows up to {:g} s late",
            machine.spindle_load_period_s, machine.spindle_load_age_s, firmware::load_delay_s(machine)));
        faults.emplace_back("a load that no longer changes looks like a steady cut: it is found in the next air");
    }
    faults.emplace_back(
        "a programmed feed that is told too high, and velocities that are told too low, only slow the machine down; "
        "nothing reports them");
    return faults;
}

}  // namespace millforce::host
