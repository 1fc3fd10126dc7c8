// SPDX-License-Identifier: Apache-2.0
#include "check/start_check.hpp"

#include <string>
#include <vector>

#include "check/check_parameters.hpp"
#include "parameters/parameter_files.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

TEST_GROUP(StartCheck) {
    TemporaryFolder folder;
    firmware::MachineParameters<float> machine =
        read_machine_parameters(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml");

    void write_tool(const std::string& name, float tooth_force_limit_N) {
        folder.write(name, "[tool]\nteeth = 2\ndiameter_mm = 10\nflute_length_mm = 22\ntooth_force_limit_N = " +
                               std::to_string(tooth_force_limit_N) +
                               "\n[control]\nentry_feed_per_tooth_mm = 0.03\nair_feed_per_tooth_mm = 0.03\n"
                               "max_feed_per_tooth_mm = 0.2\n[cutting]\nk_s_N_per_mm2 = 1650\nk_1 = 0.376\n");
    }
    std::vector<std::string> lines() {
        return start_check(ToolSet(machine, {"", folder.path("").string()}));
    }
};

TEST(StartCheck, names_what_is_wrong_with_one_tool_of_several_by_its_number) {
    write_tool("T1.toml", 700.0F);
    write_tool("T2.toml", 5.0F);
    write_tool("T3.toml", 700.0F);
    const std::vector<std::string> found = lines();
    UNSIGNED_LONGS_EQUAL(1, found.size());
    STRCMP_CONTAINS("tool 2: error: contact is seen from 10 N on, and a tooth may carry 5 N", found[0].c_str());
}

TEST(StartCheck, says_what_all_tools_show_once_and_without_a_number) {
    for (const char* name : {"T1.toml", "T2.toml", "T3.toml"}) {
        write_tool(name, 700.0F);
    }
    machine.cnc.override_max = 0.0F;
    const std::vector<std::string> found = lines();
    UNSIGNED_LONGS_EQUAL(1, found.size());
    STRCMP_CONTAINS("error: override_max = 0 is not above override_min", found[0].c_str());
    CHECK_FALSE(found[0].starts_with("tool"));
}

TEST(StartCheck, of_one_tool_says_what_the_check_of_its_files_says) {
    write_tool("tool.toml", 5.0F);
    const ToolSet one(machine, {folder.path("tool.toml").string(), ""});
    const std::vector<std::string> found = start_check(one);
    const Findings expected = check_parameters(one.parameters());
    UNSIGNED_LONGS_EQUAL(1, expected.size());
    UNSIGNED_LONGS_EQUAL(1, found.size());
    STRCMP_EQUAL(line_of(expected[0]).c_str(), found[0].c_str());
}
