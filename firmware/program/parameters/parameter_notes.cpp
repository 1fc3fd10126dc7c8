// SPDX-License-Identifier: Apache-2.0
#include "parameters/parameter_notes.hpp"

#include "files/console.hpp"

namespace millforce::host {

std::vector<std::string> parameter_notes(const firmware::Parameters<float>& parameters) {
    std::vector<std::string> notes;
    const auto& axes = parameters.machine.axes;
    const bool has_sensor = parameters.tool.force_sensor.low_pass_hz > 0.0F;
    if (!(axes[0].K_x4_N_per_A > 0.0F) && !(axes[1].K_x4_N_per_A > 0.0F) && !has_sensor) {
        notes.emplace_back(
            "neither x nor y gives a force (K_x4_N_per_A): radial immersion and depth are not known, and the feed is "
            "chosen so that the worst cut with this torque stays within the tooth's limit");
    }
    return notes;
}

void tell_parameter_notes(const firmware::Parameters<float>& parameters) {
    for (const std::string& note : parameter_notes(parameters)) {
        print_line(stderr, "millforce: note: " + note);
    }
}

}  // namespace millforce::host
