#include <valgrind/callgrind.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>

#include "firmware/tick.hpp"
#include "machine_and_tool.hpp"

/// Feeds the tick a synthetic cut and lets callgrind write down the instructions of each step, one dump per step with
/// the name of its kind: `plain` between two tooth periods, `estimating` at the end of one. To be run by
/// count_instructions. The cut is down milling whose width grows, with the tooth's ripple on the currents.
/// Exit code 1: the estimator did not find the cut, so the count would be that of something else.

namespace {

using millforce::bench::encoder_counts_per_rev;
using millforce::bench::teeth;
using millforce::firmware::ForceControlTick;
using millforce::firmware::Parameters;
namespace hal = millforce::hal;

constexpr float sample_interval_s = 0.001F;
constexpr std::uint32_t sample_interval_us = 1000;
constexpr float spindle_speed_rad_s = 418.879F;  // 4000 rpm
constexpr float feed_mm_s = 20.0F;

constexpr int air_samples = 100;
constexpr int settling_samples = 100;  // from contact until each window lies wholly in the cut
constexpr int counted_samples = 300;
constexpr int samples = air_samples + settling_samples + counted_samples;

/// Sample `index` of a straight cut along +x that begins after `air_samples`.
hal::DriveSample sample_of(int index, const Parameters<float>& parameters) {
    constexpr float tangential_N = 250.0F;
    constexpr float narrow_ratio = -0.75F;  // F_ax/F_at
    constexpr float wide_ratio = -0.2F;
    constexpr float ripple_share = 0.3F;
    const float time_s = static_cast<float>(index) * sample_interval_s;
    const float turned_rev = time_s * spindle_speed_rad_s / (2.0F * std::numbers::pi_v<float>);
    const float tooth_phase_rad = 2.0F * std::numbers::pi_v<float> * teeth * turned_rev;
    const float load = index < air_samples ? 0.0F : 1.0F + ripple_share * std::sin(tooth_phase_rad);
    const float torque_Nm = load * tangential_N * parameters.tool.diameter_mm * 0.0005F;

    hal::DriveSample sample;
    sample.time_us = static_cast<std::uint32_t>(index) * sample_interval_us;
    sample.spindle_count = static_cast<std::uint32_t>(turned_rev * encoder_counts_per_rev);
    sample.present = hal::all_present;
    sample.spindle_current_A =
        (torque_Nm - parameters.machine.spindle.K_t2_Nm) / parameters.machine.spindle.K_t1_Nm_per_A;
    const float progress = static_cast<float>(index) / static_cast<float>(samples);
    const float feed_N = tangential_N * (narrow_ratio + (wide_ratio - narrow_ratio) * progress);
    const auto& x = parameters.machine.axes[0];
    const float friction_A = x.positive.at(feed_mm_s * 0.06F) + x.K_x3_A;
    sample.axis_current_A[0] = friction_A + load * feed_N / x.K_x4_N_per_A;
    sample.axis_velocity_mm_s[0] = feed_mm_s;
    return sample;
}

}  // namespace

/// What callgrind counts: its --toggle-collect names this function.
extern "C" [[gnu::noinline]] void counted_step(ForceControlTick<float>& tick, const hal::DriveSample& sample,
                                               const hal::ProgramStatus& program) {
    tick.step(sample, program);
}

int main() {
    const Parameters<float> parameters = millforce::bench::machine_and_tool();
    ForceControlTick<float> tick(parameters);
    hal::ProgramStatus program;
    program.programmed_feed_mm_s = feed_mm_s;
    int estimating = 0;
    int with_engagement = 0;
    for (int index = 0; index < samples; ++index) {
        const hal::DriveSample sample = sample_of(index, parameters);
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
