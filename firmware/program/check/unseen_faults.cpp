// SPDX-License-Identifier: Apache-2.0
#include "check/unseen_faults.hpp"

#include <fmt/format.h>

#include "firmware/load_answer.hpp"

namespace millforce::host {

namespace {

/// Below it load_answer.hpp does not ask. The steps of a load that is rounded are those of an evenly distributed error.
float lightest_asked_N(const firmware::Parameters<float>& parameters) {
    constexpr float steps_per_sd = 3.46F;  // √12
    const auto& spindle = parameters.machine.spindle;
    const float answer_N =
        spindle.K_t1_Nm_per_A * 2000.0F / parameters.tool.diameter_mm * (steps_per_sd + 2.0F) * spindle.current_sd_A;
    return answer_N / (firmware::LoadAnswer<float>::largest_answer * estimation::usual_feed_exponent<float>);
}

}  // namespace

std::vector<std::string> unseen_faults(const firmware::Parameters<float>& parameters) {
    const auto& axes = parameters.machine.axes;
    const bool has_axes = axes[0].K_x4_N_per_A > 0.0F || axes[1].K_x4_N_per_A > 0.0F;
    std::vector<std::string> faults;
    if (has_axes) {
        faults.emplace_back(
            "a current that drifts within one cut looks like a cut that changes in width and depth; the larger of the "
            "forces by the spindle and by the axes counts then, and may still be too small: the drift is found in the "
            "next air. Where the width alone seems to change a dip of the feed asks (limit current_in_doubt)");
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
        "a current whose gain becomes another by less than a factor of two, and all currents that do so at once, look "
        "like another cut: most are found in the next air, by the idle torque. Where the depth is not declared and "
        "depth_step_ratio is above 1 the heaviest cut so far bounds the feed, else nothing does; a gain that changes "
        "while the tool enters may break a tooth all the same");
    faults.emplace_back(
        "a spindle current that is cut off above some value, while the spindle keeps its speed, looks like a lighter "
        "cut: largest_share_of_rated below that value holds the feed there");
    const auto& machine = parameters.machine;
    if (machine.spindle_load_period_s > 0.0F) {
        faults.push_back(fmt::format(
            "the spindle's load comes every {:g} s (load_period_s) and is {:g} s old by then (load_age_s): what the "
            "tool meets shows up to {:g} s late",
            machine.spindle_load_period_s, machine.spindle_load_age_s, firmware::load_delay_s(machine)));
        faults.push_back(fmt::format(
            "a load that stands still is asked in the cut, after 2 s, by a lower feed; not where F_at is below some "
            "{:.0f} N (by current_sd_A), and not in air. There the feed rises by no more than the load may hide "
            "(limit load_unanswered)",
            lightest_asked_N(parameters)));
    }
    faults.emplace_back(
        "a CNC that goes on telling a rapid while its program feeds lets the tool meet the cut at the whole programmed "
        "feed; the contact is the fault contact_in_rapid");
    faults.emplace_back(
        "a programmed feed that is told too high, and velocities that are told too low, only slow the machine down; "
        "nothing reports them");
    return faults;
}

}  // namespace millforce::host
