// SPDX-License-Identifier: Apache-2.0
#include "estimation/surface/roughness.hpp"
#include "parameters/parameter_files.hpp"
#include "reproduction_checks.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::sim;

namespace {

estimation::RoughnessModel<float> tool_entry(const std::string& name) {
    const std::string scenarios = MILLFORCE_SOURCE_DIR "/sim/scenarios/";
    return read_parameters(scenarios + "machines/vmc.toml", scenarios + "tools/" + name + ".toml").tool.roughness;
}

}  // namespace

TEST_GROUP(Roughness){};

TEST(Roughness, every_figure_of_the_paper_and_every_promise_about_it_holds) {
    const Reproduction roughness = reproduce_roughness();
    millforce::test::check_reproduction(roughness);
    LONGS_EQUAL(12, millforce::test::count_judged(roughness.figures));
    LONGS_EQUAL(12, millforce::test::count_judged(roughness.checks));
    LONGS_EQUAL(3, roughness.plots.size());
}

TEST(Roughness, both_published_models_are_tools_with_their_fitted_range_and_without_an_interval) {
    struct Entry {
        const char* name;
        float constant_um;
        estimation::RoughnessValues<float> exponent;
    };
    for (const Entry& entry : {Entry{"ballend_Ra", 7.5e-6F, {0.964F, 0.195F, 2.69F, 0.917F, -2.6F}},
                               Entry{"ballend_Rz", 2.91F, {0.16F, 0.438F, 1.25F, 0.474F, -2.84F}}}) {
        const auto model = tool_entry(entry.name);
        DOUBLES_EQUAL(1.0, static_cast<double>(model.constant_um / entry.constant_um), 1e-6);
        CHECK(model.exponent == entry.exponent);
        const estimation::RoughnessPredictor<float> predictor(model);
        CHECK(!predictor.has_interval());
        CHECK(predictor.predict({10000.0F, 0.03F, 6.0F, 0.3F, 1.0F}).in_range());
        CHECK(!predictor.predict({10000.0F, 0.03F, 6.0F, 1.0F, 1.0F}).in_range());
        LONGS_EQUAL(1U << estimation::roughness_force_ratio,
                    predictor.predict({10000.0F, 0.03F, 6.0F, 0.3F, 1.0F}).range_untold);
    }
}
