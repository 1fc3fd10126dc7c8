// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <string>

#include "control/cut_state.hpp"
#include "loop/override_source.hpp"
#include "loop/scenario.hpp"
#include "loop/simulation.hpp"

using namespace millforce;

namespace {

/// The controller's newest fault.
class Watched final : public sim::OverrideSource {
  public:
    explicit Watched(const firmware::Parameters<float>& parameters) : controller_(parameters) {}
    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override {
        const hal::FeedOverride output = controller_.step(sample, program);
        fault = static_cast<control::Fault>(output.fault);
        return output;
    }

    void describe(sim::TracePoint& point) const override { controller_.describe(point); }

    control::Fault fault = control::Fault::none;

  private:
    sim::MillforceController controller_;
};

}  // namespace

TEST_GROUP(WrongEncoder) {
    const sim::Scenario scenario =
        sim::read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/slot_entry.toml");

    firmware::Parameters<float> with_counts(float share) const {
        firmware::Parameters<float> stated = scenario.parameters;
        stated.machine.encoder_counts_per_rev =
            static_cast<std::uint32_t>(share * static_cast<float>(scenario.parameters.machine.encoder_counts_per_rev));
        return stated;
    }
};

TEST(WrongEncoder, is_found_before_the_first_contact_where_the_CNC_tells_the_spindles_speed) {
    for (const float share : {0.25F, 0.5F, 2.0F, 4.0F}) {
        Watched controller(with_counts(share));
        const sim::RunFigures figures = sim::simulate(scenario, controller, "millforce").result.figures;
        CHECK(controller.fault == control::Fault::encoder_mismatch);
        CHECK_FALSE(figures.finished);
        CHECK_EQUAL(0.0, figures.peak_over_limit);
    }
}

TEST(WrongEncoder, is_no_fault_where_the_counts_are_right) {
    Watched controller(with_counts(1.0F));
    CHECK_TRUE(sim::simulate(scenario, controller, "millforce").result.figures.finished);
    CHECK(controller.fault == control::Fault::none);
}
