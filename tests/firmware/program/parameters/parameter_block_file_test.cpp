// SPDX-License-Identifier: Apache-2.0
#include "parameters/parameter_block_file.hpp"

#include <sstream>

#include "files/input_error.hpp"
#include "firmware/some_parameters.hpp"
#include "parameters/parameter_files.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;

namespace {

const char* const machine_file = MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml";
const char* const tool_file = MILLFORCE_SOURCE_DIR "/sim/scenarios/tools/endmill_10mm.toml";

void check_equal(const firmware::Parameters<float>& a, const firmware::Parameters<float>& b) {
    STRCMP_EQUAL("", test::first_difference(firmware::values_of(a), firmware::values_of(b)));
}

/// The part of a text from one mark to another, or to its end.
std::string between(const std::string& text, const std::string& from, const std::string& to) {
    const std::size_t begin = text.find(from);
    const std::size_t end = to.empty() ? std::string::npos : text.find(to);
    return text.substr(begin, end - begin);
}

}  // namespace

TEST_GROUP(ParameterBlockFile) {
    test::TemporaryFolder folder;
};

TEST(ParameterBlockFile, holds_the_parameters_of_both_files) {
    const auto parameters = read_parameters(machine_file, tool_file);
    const std::string path = folder.path("parameters.bin").string();
    write_parameter_block(path, parameters);
    const BlockContents read = read_parameter_block(path);
    UNSIGNED_LONGS_EQUAL(1, read.tools.size());
    UNSIGNED_LONGS_EQUAL(0, read.tools[0].number);
    check_equal(parameters, {read.machine, read.tools[0].parameters});
}

TEST(ParameterBlockFile, holds_tools_by_number_and_is_printed_as_their_files) {
    const auto parameters = read_parameters(machine_file, tool_file);
    std::vector<firmware::NumberedTool> tools{{7, parameters.tool}, {12, parameters.tool}};
    tools[1].parameters.tooth_force_limit_N = 350.0F;
    const std::string path = folder.path("parameters.bin").string();
    const std::size_t bytes = write_tools_block(path, parameters.machine, tools);
    UNSIGNED_LONGS_EQUAL(bytes, folder.read("parameters.bin").size());
    const BlockContents read = read_parameter_block(path);
    UNSIGNED_LONGS_EQUAL(2, read.tools.size());
    std::ostringstream text;
    write_parameters_as_toml(text, read);
    const auto machine = folder.write("machine.toml", between(text.str(), "# machine.toml", "# T7.toml"));
    const auto first = folder.write("T7.toml", between(text.str(), "# T7.toml", "# T12.toml"));
    const auto second = folder.write("T12.toml", between(text.str(), "# T12.toml", ""));
    check_equal(parameters, read_parameters(machine.string(), first.string()));
    check_equal({parameters.machine, tools[1].parameters}, read_parameters(machine.string(), second.string()));
}

TEST(ParameterBlockFile, refuses_more_tools_than_a_block_holds) {
    const auto parameters = read_parameters(machine_file, tool_file);
    std::vector<firmware::NumberedTool> tools;
    for (std::uint32_t number = 1; number <= 17; ++number) {
        tools.push_back({number, parameters.tool});
    }
    const std::string path = folder.path("parameters.bin").string();
    const auto refusal = test::message_of<InputError>([&] { write_tools_block(path, parameters.machine, tools); });
    CHECK_TRUE(test::contains(refusal, "17 tools, expected 1 to 16"));
    CHECK_FALSE(std::filesystem::exists(path));
}

TEST(ParameterBlockFile, is_printed_as_files_that_give_every_key_its_value_again) {
    auto parameters = test::distinct_parameters();
    parameters.tool.control.Ra_limit_um = 0.0F;  // needs a model of R_a
    std::ostringstream text;
    write_parameters_as_toml(text, {parameters.machine, {{0, parameters.tool}}});
    const auto machine = folder.write("machine.toml", between(text.str(), "# machine.toml", "# tool.toml"));
    const auto tool = folder.write("tool.toml", between(text.str(), "# tool.toml", ""));
    check_equal(parameters, read_parameters(machine.string(), tool.string()));
}

TEST(ParameterBlockFile, what_is_no_block_is_refused_with_the_reason) {
    const std::string path = folder.path("parameters.bin").string();
    const auto refusal = [&path] { return test::message_of<InputError>([&path] { read_parameter_block(path); }); };
    CHECK_TRUE(test::contains(refusal(), "no such file"));
    const auto folder_refused = test::message_of<InputError>([] { read_parameter_block("/"); });
    STRCMP_EQUAL("/: is a folder; expected a file", folder_refused.c_str());
    folder.write("parameters.bin", "");
    CHECK_TRUE(test::contains(refusal(), "no block"));
    write_parameter_block(path, read_parameters(machine_file, tool_file));
    std::string bytes = folder.read("parameters.bin");
    bytes[100] = static_cast<char>(bytes[100] ^ 1);
    folder.write("parameters.bin", bytes);
    CHECK_TRUE(test::contains(refusal(), "CRC of the values"));
}
