// SPDX-License-Identifier: Apache-2.0
#include "loop/override_source.hpp"
#include "loop/simulation.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <random>
#include <string>

#include "hal/drive_sample.hpp"

using namespace millforce;
using namespace millforce::sim;

namespace {

/// What a controller is told of a spindle's current that is cut off at 1.5 times the idle one, though the spindle gives
/// what the cut asks for: no more than that, or nothing, where its largest share is below that by more than the noise.
class CutOffCurrent : public OverrideSource {
  public:
    CutOffCurrent(OverrideSource& controller, const firmware::Parameters<float>& parameters, bool is_limit_told)
        : controller_(controller), noise_A_(0.0F, parameters.machine.spindle.current_sd_A), is_told_(is_limit_told) {
        const auto& spindle = parameters.machine.spindle;
        limit_A_ = 1.5F * (spindle.warm_up_torque_Nm - spindle.K_t2_Nm) / spindle.K_t1_Nm_per_A;
    }

    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override {
        hal::DriveSample told = sample;
        if (told.spindle_current_A > limit_A_) {
            told.spindle_current_A = limit_A_ + noise_A_(random_);
        }
        if (is_told_ && told.spindle_current_A > limit_A_ - 4.0F * noise_A_.stddev()) {
            told.present &= static_cast<std::uint8_t>(~static_cast<unsigned>(hal::Present::spindle_current));
        }
        return controller_.step(told, program);
    }
    void describe(TracePoint& point) const override { controller_.describe(point); }

  private:
    OverrideSource& controller_;
    std::normal_distribution<float> noise_A_;
    std::mt19937 random_{7};
    bool is_told_;
    float limit_A_ = 0.0F;
};

Scenario hard(const char* name) {
    Scenario scenario = read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/" + name + ".toml");
    scenario.deviation.cutting_force_scale = 1.3;
    return scenario;
}

RunFigures milled(const Scenario& scenario, OverrideSource& controller) {
    SimulationSettings settings;
    settings.longest_run_s = 120.0;
    return simulate(scenario, controller, "millforce", settings).result.figures;
}

RunFigures milled_with_current_cut_off(bool is_limit_told) {
    const Scenario scenario = hard("depth_ramp");
    MillforceController controller(scenario.parameters);
    CutOffCurrent told(controller, scenario.parameters, is_limit_told);
    return milled(scenario, told);
}

/// The drive gives no more than `share` of its rated current, and the spindle loses speed where the cut asks for more.
RunFigures milled_by_weak_spindle(const char* name, double share, bool measures_axes = true) {
    Scenario scenario = hard(name);
    scenario.machine.spindle.largest_current_of_rated = share;
    if (!measures_axes) {
        for (auto& axis : scenario.parameters.machine.axes) {
            axis.K_x4_N_per_A = 0.0F;
        }
    }
    MillforceController controller(scenario.parameters);
    return milled(scenario, controller);
}

}  // namespace

TEST_GROUP(SpindleAtItsLimit){};

TEST(SpindleAtItsLimit, loses_speed_and_the_part_is_milled_within_the_limit_by_a_lower_feed) {
    for (const bool measures_axes : {true, false}) {
        const RunFigures ramp = milled_by_weak_spindle("depth_ramp", 0.3, measures_axes);
        CHECK(ramp.finished);
        CHECK_COMPARE(ramp.peak_over_limit, <=, 1.05);
    }
    const RunFigures step = milled_by_weak_spindle("width_step", 0.35);
    CHECK(step.finished);
    CHECK_COMPARE(step.peak_over_limit, <=, 1.05);
}

TEST(SpindleAtItsLimit, stalls_in_a_cut_that_no_feed_makes_light_enough_and_no_tooth_breaks) {
    for (const bool measures_axes : {true, false}) {
        const RunFigures figures = milled_by_weak_spindle("depth_ramp", 0.25, measures_axes);
        STRCMP_EQUAL("spindle_stopped", figures.fault.c_str());
        CHECK_COMPARE(figures.peak_over_limit, <=, 1.05);
    }
}

TEST(SpindleAtItsLimit, holds_the_feed_where_the_current_is_cut_off_and_that_is_told_and_no_tooth_breaks) {
    const RunFigures figures = milled_with_current_cut_off(true);
    CHECK_EQUAL(0, figures.teeth_broken);
    CHECK_COMPARE(figures.peak_over_limit, <=, 1.0);
}

TEST(SpindleAtItsLimit, passes_for_a_lighter_cut_where_its_current_is_cut_off_and_nobody_tells_it) {
    CHECK_COMPARE(milled_with_current_cut_off(false).peak_over_limit, >, 1.2);
}
