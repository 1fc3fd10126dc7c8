// SPDX-License-Identifier: Apache-2.0
#include "firmware/parameter_fields.hpp"
#include "estimation/number/fixed_point.hpp"
#include "firmware/parameters_in.hpp"
#include "firmware/some_parameters.hpp"

#include <set>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::firmware;

namespace {

ParameterValues values_of_fixed(const Parameters<estimation::Fixed>& parameters) {
    ParameterValues values{};
    std::size_t next = 0;
    for_each_parameter(parameters, [&](const ParameterName& /*name*/, const auto& field, float /*minimum*/,
                                       float /*maximum*/) { values[next++] = static_cast<float>(field); });
    return values;
}

}  // namespace

TEST_GROUP(ParameterFields){};

TEST(ParameterFields, are_as_many_as_their_count_and_each_another) {
    const Parameters<float> parameters;
    std::set<const void*> fields;
    for_each_parameter(parameters, [&](const ParameterName& name, const auto& field, float /*minimum*/,
                                       float /*maximum*/) { CHECK_TEXT(fields.insert(&field).second, name.key); });
    UNSIGNED_LONGS_EQUAL(parameter_count, fields.size());
    std::size_t of_machine = 0;
    const auto count = [&of_machine](const ParameterName& /*name*/, const auto& /*field*/, float /*minimum*/,
                                     float /*maximum*/) { ++of_machine; };
    for_each_machine_parameter(parameters.machine, count);
    UNSIGNED_LONGS_EQUAL(machine_parameter_count, of_machine);
}

TEST(ParameterFields, become_a_list_of_values_and_back) {
    const Parameters<float> written = test::distinct_parameters();
    const ParameterValues values = values_of(written);
    STRCMP_EQUAL("", test::first_difference(values, values_of(parameters_of<float>(values))));
    CHECK_TRUE(*test::first_difference(values, values_of(Parameters<float>{})) != '\0');
}

TEST(ParameterFields, are_the_same_in_fixed_point) {
    const Parameters<float> parameters = test::distinct_parameters();
    const ParameterValues in_fixed = values_of_fixed(parameters_in<estimation::Fixed>(parameters));
    STRCMP_EQUAL("", test::first_difference(values_of(parameters), in_fixed, 1e-5F));
}

TEST(ParameterFields, of_all_four_drives_arrive_in_fixed_point) {
    Parameters<float> parameters;
    for (std::size_t k = 0; k < 4; ++k) {
        parameters.machine.bus.drives[k].node_id = static_cast<std::uint8_t>(10 + k);
        parameters.machine.bus.drives[k].stale_ms = static_cast<float>(5 + k);
    }
    const auto in_fixed = parameters_in<estimation::Fixed>(parameters);
    for (std::size_t k = 0; k < 4; ++k) {
        UNSIGNED_LONGS_EQUAL(10 + k, in_fixed.machine.bus.drives[k].node_id);
        CHECK_TRUE(in_fixed.machine.bus.drives[k].stale_ms == estimation::Fixed(static_cast<int>(5 + k)));
    }
}
