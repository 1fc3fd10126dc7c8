// SPDX-License-Identifier: Apache-2.0
#include "firmware/default_parameters.hpp"
#include "firmware/parameters_in.hpp"
#include "parameters/parameter_files.hpp"

#include <set>
#include <string>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::firmware;

TEST_GROUP(DefaultParameters){};

TEST(DefaultParameters, are_those_of_the_scenarios_files_but_for_feed_drives_bus_and_monitor_only) {
    const std::string scenarios = MILLFORCE_SOURCE_DIR "/sim/scenarios/";
    const Parameters<float> of_files =
        host::read_parameters(scenarios + "machines/vmc.toml", scenarios + "tools/endmill_10mm.toml");
    Parameters<float> defaults = default_parameters<float>();
    CHECK_TRUE(defaults.tool.monitor_only);
    defaults.tool.monitor_only = of_files.tool.monitor_only;

    const ParameterValues values = values_of(of_files);
    const std::set<std::string> not_theirs{"axis", "bus", "bus.drive"};
    std::size_t next = 0;
    for_each_parameter(defaults,
                       [&](const ParameterName& name, const auto& field, float /*minimum*/, float /*maximum*/) {
                           const float of_file = values[next++];
                           if (!not_theirs.contains(name.table)) {
                               CHECK_TEXT(of_file == static_cast<float>(field), name.key);
                           }
                       });
}
