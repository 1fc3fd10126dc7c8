// SPDX-License-Identifier: Apache-2.0
#include "parameters/tool_set.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

std::string tool_with(int teeth) {
    return "[tool]\nteeth = " + std::to_string(teeth) +
           "\ndiameter_mm = 10\nflute_length_mm = 22\ntooth_force_limit_N = 700\n[control]\n"
           "entry_feed_per_tooth_mm = 0.03\nair_feed_per_tooth_mm = 0.03\nmax_feed_per_tooth_mm = 0.2\n"
           "[cutting]\nk_s_N_per_mm2 = 1650\nk_1 = 0.376\n";
}

}  // namespace

TEST_GROUP(ToolSet) {
    TemporaryFolder folder;

    std::string error() {
        return message_of<InputError>([&] { (void)read_tool_folder(folder.path("")); });
    }
};

TEST(ToolSet, reads_each_tool_under_the_number_in_its_files_name) {
    folder.write("T12.toml", tool_with(2));
    folder.write("T007.toml", tool_with(3));
    folder.write("T4294967295.toml", tool_with(5));
    folder.write("README.md", "# Tools\n");
    const auto tools = read_tool_folder(folder.path(""));
    UNSIGNED_LONGS_EQUAL(3, tools.size());
    UNSIGNED_LONGS_EQUAL(7, tools[0].number);
    UNSIGNED_LONGS_EQUAL(3, tools[0].parameters.teeth);
    UNSIGNED_LONGS_EQUAL(12, tools[1].number);
    UNSIGNED_LONGS_EQUAL(2, tools[1].parameters.teeth);
    UNSIGNED_LONGS_EQUAL(UINT32_MAX, tools[2].number);
}

TEST(ToolSet, refuses_a_number_that_is_there_twice_with_both_names) {
    folder.write("T7.toml", tool_with(2));
    folder.write("T007.toml", tool_with(2));
    CHECK(contains(error(), "T7.toml: tool 7 is in T007.toml, too"));
}

TEST(ToolSet, refuses_a_toml_file_with_another_name) {
    for (const char* name : {"T.toml", "T0.toml", "t7.toml", "7.toml", "T-7.toml", "T+7.toml", "T7a.toml", "T 7.toml",
                             ".toml", "T4294967296.toml", "endmill.toml"}) {
        folder.write(name, tool_with(2));
        CHECK(contains(error(), std::string(name) + ": expected a name as T7.toml"));
        std::filesystem::remove(folder.path(name));
    }
}

TEST(ToolSet, refuses_a_tool_that_is_not_sound_with_its_file) {
    folder.write("T1.toml", tool_with(2));
    folder.write("T2.toml", tool_with(999));
    CHECK(contains(error(), "T2.toml"));
    CHECK(contains(error(), "tool.teeth = 999"));
    std::filesystem::remove(folder.path("T2.toml"));
    std::filesystem::create_directory(folder.path("T3.toml"));
    CHECK(contains(error(), "T3.toml"));
}

TEST(ToolSet, refuses_a_folder_without_a_tool_and_what_is_no_folder) {
    CHECK(contains(error(), "no tool file, expected T1.toml"));
    CHECK(contains(message_of<InputError>([&] { (void)read_tool_folder(folder.path("nowhere")); }),
                   "nowhere: No such file or directory, expected a folder"));
    folder.write("T1.toml", tool_with(2));
    CHECK(contains(message_of<InputError>([&] { (void)read_tool_folder(folder.path("T1.toml")); }),
                   "T1.toml: Not a directory, expected a folder"));
}

TEST(ToolSet, is_of_one_tool_or_of_a_folder) {
    const auto error_of = [](const ToolChoice& choice) {
        return message_of<InputError>([&] { choice.require_one(); });
    };
    CHECK(contains(error_of({}), "--tool, --tools: neither was given"));
    CHECK(contains(error_of({"a.toml", "folder"}), "--tool, --tools: both were given"));
    STRCMP_EQUAL("", error_of({"a.toml", ""}).c_str());
    folder.write("T5.toml", tool_with(3));
    const ToolSet several({}, {"", folder.path("").string()});
    CHECK(several.source()->has(5));
    CHECK_FALSE(several.source()->has(4));
    CHECK_FALSE(several.source()->has(0));
    UNSIGNED_LONGS_EQUAL(3, several.parameters().tool.teeth);
    const ToolSet one({}, {folder.path("T5.toml").string(), ""});
    POINTERS_EQUAL(nullptr, one.source());
    UNSIGNED_LONGS_EQUAL(3, one.parameters().tool.teeth);
}
