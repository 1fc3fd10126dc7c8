// SPDX-License-Identifier: Apache-2.0
#include "firmware/parameters.hpp"

#include <CppUTest/TestHarness.h>

#include "firmware/tick_bench.hpp"

using millforce::firmware::estimator_law;
using millforce::firmware::ToolParameters;

namespace {

ToolParameters<float> tool_with_constant_coefficients() {
    ToolParameters<float> tool;
    tool.law.k_s_N_per_mm2 = 800.0F;
    tool.law.k_1 = 0.3F;
    return tool;
}

}  // namespace

TEST_GROUP(EstimatorLaw){};

TEST(EstimatorLaw, of_constant_coefficients_has_the_doubt_of_the_edges_that_it_leaves_out) {
    const ToolParameters<float> tool = tool_with_constant_coefficients();
    const auto law = estimator_law(tool);
    CHECK(law.K_s_relative_sd > tool.law.K_s_relative_sd);
    CHECK(law.K_s_exponent_sd > 0.0F);
    CHECK(law.r_1_relative_sd > tool.law.r_1_relative_sd);
    CHECK(law.r_1_exponent_sd > 0.0F);
    CHECK(law.reference_chip_thickness_mm > 0.0F);
}

TEST(EstimatorLaw, a_small_tool_in_a_heavy_spindle_gets_a_window_in_which_the_counts_tell_its_force) {
    auto parameters = millforce::test::machine_and_tool();
    parameters.tool.diameter_mm = 6.0F;
    parameters.tool.tooth_force_limit_N = 250.0F;
    parameters.machine.spindle.inertia_kg_m2 = 0.004F;
    parameters.machine.encoder_counts_per_rev = 8192;
    const float window_s = estimator_settings(parameters).min_samples / parameters.machine.cnc.sample_rate_hz;
    const float torque_Nm = 0.004F * 4.0F * (6.2832F / 8192.0F) / (window_s * window_s);
    DOUBLES_EQUAL(0.04 * 250.0, static_cast<double>(torque_Nm / 0.003F), 0.01);
    parameters.tool.diameter_mm = 20.0F;
    parameters.tool.tooth_force_limit_N = 2000.0F;
    DOUBLES_EQUAL(12.0, static_cast<double>(estimator_settings(parameters).min_samples), 0.0);
}

TEST(EstimatorLaw, keeps_a_larger_doubt_than_that) {
    ToolParameters<float> tool = tool_with_constant_coefficients();
    tool.law.K_s_relative_sd = 0.7F;
    CHECK(estimator_law(tool).K_s_relative_sd == 0.7F);
}

TEST(EstimatorLaw, with_edge_forces_or_exponents_is_taken_at_its_word) {
    for (float millforce::estimation::CuttingLaw<float>::*coefficient :
         {&millforce::estimation::CuttingLaw<float>::K_te_N_per_mm, &millforce::estimation::CuttingLaw<float>::p_s}) {
        ToolParameters<float> tool = tool_with_constant_coefficients();
        tool.law.*coefficient = -0.2F;
        const auto law = estimator_law(tool);
        CHECK(law.K_s_relative_sd == tool.law.K_s_relative_sd);
        CHECK(law.r_1_relative_sd == tool.law.r_1_relative_sd);
        CHECK(law.K_s_exponent_sd == 0.0F);
    }
}
