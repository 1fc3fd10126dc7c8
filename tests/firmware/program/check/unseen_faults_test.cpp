// SPDX-License-Identifier: Apache-2.0
#include "check/unseen_faults.hpp"

#include <algorithm>

#include "parameters/parameter_files.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;

TEST_GROUP(UnseenFaults) {
    firmware::Parameters<float> parameters = [] {
        firmware::Parameters<float> all_currents;
        all_currents.machine = host::read_machine_parameters(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml");
        return all_currents;
    }();

    [[nodiscard]] bool names(const char* part) const {
        const std::vector<std::string> faults = host::unseen_faults(parameters);
        return std::any_of(faults.begin(), faults.end(),
                           [part](const std::string& fault) { return fault.find(part) != std::string::npos; });
    }
};

TEST(UnseenFaults, of_a_machine_with_all_currents_are_drifts_and_a_current_that_is_cut_off) {
    CHECK(names("a current that drifts within one cut"));
    CHECK(names("goes on telling a rapid"));
    CHECK(names("gain becomes another by less than a factor of two"));
    CHECK(names("the heaviest cut so far bounds the feed"));
    CHECK(names("largest_share_of_rated below that value"));
    CHECK_FALSE(names("a spindle current that drifts"));
    CHECK_FALSE(names("contradicted by no second current"));
    CHECK_FALSE(names("load_period_s"));
}

TEST(UnseenFaults, of_a_spindle_alone_are_also_its_scale_in_the_cut) {
    for (auto& axis : parameters.machine.axes) {
        axis.K_x4_N_per_A = 0.0F;
    }
    CHECK(names("a spindle current that drifts within one cut"));
    CHECK(names("contradicted by no second current"));
}

TEST(UnseenFaults, of_a_converters_load_are_late_and_may_stand_still_in_air_and_in_light_cuts) {
    parameters.machine = host::read_machine_parameters(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vfd.toml");
    CHECK(names("comes every 0.1 s (load_period_s) and is 0.15 s old by then (load_age_s)"));
    CHECK(names("shows up to 0.25 s late"));
    CHECK(names("a load that stands still is asked in the cut"));
    // 0.7 Nm/A · 2/(10 mm) · 5.46 · 0.04 A, of which a quarter of the feed must show as much
    parameters.machine.spindle.K_t1_Nm_per_A = 0.7F;
    parameters.machine.spindle.current_sd_A = 0.04F;
    parameters.tool.diameter_mm = 10.0F;
    CHECK(names("not where F_at is below some 170 N (by current_sd_A)"));
    CHECK(names("contradicted by no second current"));
}
