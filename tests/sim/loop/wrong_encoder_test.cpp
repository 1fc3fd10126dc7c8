// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <string>

#include "loop/override_source.hpp"
#include "loop/scenario.hpp"
#include "loop/simulation.hpp"

using namespace millforce;

TEST_GROUP(WrongEncoder) {
    const sim::Scenario scenario =
        sim::read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/slot_entry.toml");

    /// With a controller that is told this share of the encoder's counts.
    [[nodiscard]] sim::RunFigures milled(float share) const {
        firmware::Parameters<float> stated = scenario.parameters;
        stated.machine.encoder_counts_per_rev =
            static_cast<std::uint32_t>(share * static_cast<float>(scenario.parameters.machine.encoder_counts_per_rev));
        sim::MillforceController controller(stated);
        return sim::simulate(scenario, controller, "millforce").result.figures;
    }
};

TEST(WrongEncoder, is_found_before_the_first_contact_where_the_CNC_tells_the_spindles_speed) {
    for (const float share : {0.25F, 0.5F, 2.0F, 4.0F}) {
        const sim::RunFigures figures = milled(share);
        STRCMP_EQUAL("encoder_mismatch", figures.fault.c_str());
        CHECK_FALSE(figures.finished);
        CHECK_EQUAL(0.0, figures.peak_over_limit);
    }
}

TEST(WrongEncoder, is_no_fault_where_the_counts_are_right) {
    const sim::RunFigures figures = milled(1.0F);
    CHECK_TRUE(figures.finished);
    STRCMP_EQUAL("none", figures.fault.c_str());
}
