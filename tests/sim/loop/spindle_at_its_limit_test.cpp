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

/// What a controller is told of a spindle drive that gives no more than 1.5 times its idle current: no more than that,
/// or nothing, where its largest share is below the limit by more than the noise.
class SpindleAtItsLimit : public OverrideSource {
  public:
    SpindleAtItsLimit(OverrideSource& controller, const firmware::Parameters<float>& parameters, bool is_limit_told)
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

RunFigures milled(bool is_limit_told) {
    Scenario scenario = read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/depth_ramp.toml");
    scenario.deviation.cutting_force_scale = 1.3;
    MillforceController controller(scenario.parameters);
    SpindleAtItsLimit told(controller, scenario.parameters, is_limit_told);
    SimulationSettings settings;
    settings.longest_run_s = 60.0;
    return simulate(scenario, told, "millforce", settings).result.figures;
}

}  // namespace

TEST_GROUP(SpindleAtItsLimit){};

TEST(SpindleAtItsLimit, holds_the_feed_where_the_drives_limit_is_told_and_no_tooth_breaks) {
    const RunFigures figures = milled(true);
    CHECK_EQUAL(0, figures.teeth_broken);
    CHECK_COMPARE(figures.peak_over_limit, <=, 1.0);
}

TEST(SpindleAtItsLimit, passes_for_a_lighter_cut_where_it_is_not) {
    CHECK_COMPARE(milled(false).peak_over_limit, >, 1.5);
}
