// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "loop/scenario.hpp"
#include "sim/without_axis_currents.hpp"

namespace millforce::test {

/// The scenario on a machine that knows nothing but its spindle's load, as a frequency converter gives it over Modbus:
/// with this period, this old when it arrives, smoothed over 0.05 s and rounded to 0.1 A.
inline sim::Scenario with_converter_load(sim::Scenario scenario, double period_s, double age_s) {
    constexpr double smoothing_s = 0.05;
    scenario.machine.load_meter = {.period_s = period_s, .age_s = age_s, .smoothing_s = smoothing_s};
    scenario.parameters = without_axis_currents(scenario.parameters);
    scenario.parameters.machine.spindle_load_period_s = static_cast<float>(period_s);
    scenario.parameters.machine.spindle_load_age_s = static_cast<float>(age_s + smoothing_s);
    scenario.parameters.machine.spindle.current_sd_A = 0.04F;
    return scenario;
}

}  // namespace millforce::test
