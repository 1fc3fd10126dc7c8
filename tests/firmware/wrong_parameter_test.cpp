// SPDX-License-Identifier: Apache-2.0
#include "firmware/wrong_parameter.hpp"
#include "control/feed_controller.hpp"
#include "estimation/number/fixed_point.hpp"
#include "firmware/default_parameters.hpp"

#include <limits>
#include <type_traits>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::firmware;

namespace {

bool is_bad_configuration(const Parameters<float>& parameters) {
    control::FeedController<float> controller(controller_parameters(parameters));
    return controller.step({}).fault == control::Fault::bad_configuration;
}

/// Calls visit(parameters, name, minimum, maximum, field) with the defaults once for each number among them.
template <typename Visit>
void for_each_number(Visit visit) {
    Parameters<float> parameters = default_parameters<float>();
    for_each_parameter(parameters,
                       [&]<typename Field>(const ParameterName& name, Field& field, float minimum, float maximum) {
                           if constexpr (std::is_same_v<Field, float>) {
                               const float before = field;
                               visit(parameters, name, minimum, maximum, field);
                               field = before;
                           }
                       });
}

void names_the_field(const Parameters<float>& parameters, const ParameterName& name) {
    const auto wrong = first_wrong_parameter(parameters);
    CHECK_TEXT(wrong.has_value(), name.key);
    STRCMP_EQUAL(name.key, wrong->name.key);
    STRCMP_EQUAL(name.table, wrong->name.table);
    UNSIGNED_LONGS_EQUAL(name.place, wrong->name.place);
}

}  // namespace

TEST_GROUP(WrongParameter){};

TEST(WrongParameter, is_none_in_the_defaults_of_either_scalar) {
    CHECK_FALSE(first_wrong_parameter(default_parameters<float>()).has_value());
    CHECK_FALSE(first_wrong_parameter(default_parameters<estimation::Fixed>()).has_value());
    CHECK_FALSE(is_bad_configuration(default_parameters<float>()));
}

TEST(WrongParameter, is_each_number_that_is_out_of_its_range_or_not_a_number) {
    for_each_number(
        [](const Parameters<float>& parameters, const ParameterName& name, float minimum, float maximum, float& field) {
            const float far = 1.0F + maximum - minimum;
            for (const float value : {minimum - far, maximum + far, std::numeric_limits<float>::quiet_NaN()}) {
                field = value;
                names_the_field(parameters, name);
            }
        });
}

TEST(WrongParameter, is_named_wherever_the_controller_sees_a_bad_configuration) {
    for_each_number([](const Parameters<float>& parameters, const ParameterName& name, float minimum, float maximum,
                       float& field) {
        for (const float value : {minimum, maximum}) {
            field = value;
            CHECK_TEXT(first_wrong_parameter(parameters).has_value() || !is_bad_configuration(parameters), name.key);
        }
    });
}

TEST(WrongParameter, is_a_largest_override_that_is_not_above_the_smallest) {
    Parameters<float> parameters = default_parameters<float>();
    parameters.machine.cnc.override_max = parameters.machine.cnc.override_min;
    CHECK(is_bad_configuration(parameters));
    names_the_field(parameters, {ParameterFile::machine, "cnc", "override_max"});
}

TEST(WrongParameter, has_the_table_of_its_file) {
    STRCMP_EQUAL("y", table_in_file({ParameterFile::machine, "axis", "mass_kg", 1}));
    STRCMP_EQUAL("bus.z", table_in_file({ParameterFile::machine, "bus.drive", "node_id", 3}));
    STRCMP_EQUAL("cutting", table_in_file({ParameterFile::tool, "cutting", "k_1"}));
}
