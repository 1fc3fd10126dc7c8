// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include "firmware/default_parameters.hpp"
#include "firmware/tick.hpp"
#include "firmware/wrong_parameter.hpp"

/// A second in air, then a second in a cut, at 4000 rpm and 8192 counts. With an argument a value is wrong.
int main(int argc, char** /*argv*/) {
    auto parameters = millforce::firmware::default_parameters<float>();
    parameters.tool.monitor_only = false;
    parameters.tool.tooth_force_limit_N = argc > 1 ? 0.0F : 700.0F;
    const auto wrong = first_wrong_parameter(parameters);
    std::printf("wrong value: %s\n", wrong ? wrong->name.key : "none");
    millforce::firmware::SmallTick<float> tick(parameters);
    millforce::hal::DriveSample sample{.present = millforce::hal::all_present, .axis_velocity_mm_s = {10.0F}};
    while ((sample.time_us += 1000) < 2'000'000) {
        sample.spindle_count += 546;
        sample.spindle_current_A = sample.time_us < 1'000'000 ? 1.4F : 6.0F;
        step_and_work(tick, sample, {.programmed_feed_mm_s = 10.0F});
    }
    std::printf("override %.4f, fault %s\n", double{tick.control().ratio}, name(tick.control().fault));
}
