// SPDX-License-Identifier: Apache-2.0
#include <valgrind/callgrind.h>

#include <cstdio>

#include "firmware/tick.hpp"
#include "synthetic_cut.hpp"

/// Feeds the tick the synthetic cut and lets callgrind write down the instructions of each step, one dump per step with
/// the name of its kind: `plain` between two tooth periods, `estimating` at the end of one. To be run by
/// count_instructions.
/// Exit code 1: the estimator did not find the cut, so the count would be that of something else.

using namespace millforce;
using namespace millforce::instructions;
using millforce::firmware::ForceControlTick;
using millforce::firmware::Parameters;

/// What callgrind counts: its --toggle-collect names this function.
extern "C" [[gnu::noipa]] hal::FeedOverride counted_step(ForceControlTick<float>& tick, const hal::DriveSample& sample,
                                                         const hal::ProgramStatus& program) {
    return tick.step(sample, program);
}

int main() {
    const Parameters<float> parameters = millforce::bench::machine_and_tool();
    ForceControlTick<float> tick(parameters);
    int estimating = 0;
    int with_engagement = 0;
    for (int index = 0; index < instructions::fast_widening_cut.samples(); ++index) {
        const hal::DriveSample sample = sample_of(index, parameters);
        const hal::ProgramStatus program = program_at(index);
        const bool counted = index >= air_samples + settling_samples;
        if (!counted) {
            tick.step(sample, program);
            continue;
        }
        const float before_s = tick.estimator().since_period_s();
        CALLGRIND_ZERO_STATS;
        counted_step(tick, sample, program);
        if (tick.estimator().since_period_s() < before_s) {
            CALLGRIND_DUMP_STATS_AT("estimating");
            ++estimating;
            const auto& engagement = tick.estimate().engagement;
            with_engagement += engagement.immersion_valid && engagement.depth_valid ? 1 : 0;
        } else {
            CALLGRIND_DUMP_STATS_AT("plain");
        }
    }
    std::printf("immersion at the end: %.2f\n", static_cast<double>(tick.estimate().engagement.radial_immersion));
    if (estimating == 0 || with_engagement != estimating) {
        std::fprintf(stderr, "tick_instructions: %d of %d estimates found the engagement\n", with_engagement,
                     estimating);
        return 1;
    }
    return 0;
}
