// SPDX-License-Identifier: Apache-2.0
#include "files/toml_reader.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::test;

namespace {

/// The message about a file that may hold the number `feed` and nothing else; empty if it is taken.
std::string error_of(const std::string& text) {
    return message_of<InputError>([&] {
        TomlFile file = TomlFile::from_text(text, "t.toml");
        TomlFile::Table root = file.root();
        (void)root.number("feed", 0.0, 10.0);
        root.reject_unknown_keys();
    });
}

std::string repeated(const std::string& part, int count) {
    std::string text;
    for (int k = 0; k < count; ++k) {
        text += part;
    }
    return text;
}

}  // namespace

TEST_GROUP(TomlReader){};

TEST(TomlReader, shows_keys_and_values_without_what_a_terminal_obeys) {
    STRCMP_EQUAL(R"(t.toml:1:8: feed = "?[31m?": expected a number from 0 to 10)",
                 error_of("feed = \"\\u001b[31m\\n\"").c_str());
    STRCMP_CONTAINS("f?ed: unknown key; did you mean feed?", error_of("feed = 1\n\"f\\u0007ed\" = 1\n").c_str());
    STRCMP_CONTAINS("f?ed: unknown key; did you mean feed?", error_of("feed = 1\n\"f\\u009bed\" = 1\n").c_str());
}

TEST(TomlReader, shows_the_begin_of_a_key_or_a_value_of_megabytes) {
    const std::string endless(4'000'000, 'a');
    CHECK(error_of("feed = \"" + endless + "\"").size() < 200);
    const std::string of_key = error_of("feed = 1\n" + endless + " = 1");
    STRCMP_CONTAINS("unknown key; known keys: feed", of_key.c_str());
    CHECK(of_key.size() < 200);
}

TEST(TomlReader, refuses_what_nests_deeper_than_parameters_do) {
    STRCMP_EQUAL("", error_of("feed = 1").c_str());
    STRCMP_EQUAL("t.toml:2: a key of more than 16 parts, expected parameters",
                 error_of("feed = 1\n" + repeated("a.", 50'000) + "a = 1").c_str());
    STRCMP_EQUAL("t.toml:1: a key of more than 16 parts, expected parameters",
                 error_of("[" + repeated("a.", 50'000) + "a]").c_str());
    STRCMP_EQUAL("t.toml:1: brackets deeper than 16, expected parameters",
                 error_of("a = " + repeated("[", 500'000)).c_str());
    STRCMP_EQUAL("t.toml:1: brackets deeper than 16, expected parameters",
                 error_of("a = " + repeated("{a = ", 300'000)).c_str());
}

TEST(TomlReader, does_not_count_brackets_and_points_in_texts_and_comments) {
    const std::string brackets(30, '[');
    STRCMP_CONTAINS("expected a number", error_of("feed = '" + brackets + "'").c_str());
    STRCMP_CONTAINS("expected a number", error_of("feed = \"\\\"" + brackets + "\"").c_str());
    STRCMP_CONTAINS("expected a number", error_of("feed = \"\\\\\\\"" + brackets + "\"").c_str());
    STRCMP_CONTAINS("expected a number", error_of("feed = {a = 1, b = {c = 2}}").c_str());
    STRCMP_EQUAL("", error_of("feed = 1 # " + brackets + "\n").c_str());
    STRCMP_EQUAL("t.toml:1: brackets deeper than 16, expected parameters",
                 error_of("feed = ['\\', " + brackets).c_str());  // a backslash escapes nothing between these quotes
}

TEST(TomlReader, says_which_kind_of_value_a_key_needs) {
    const auto refusal = [](const std::string& text, const auto& read) {
        return message_of<InputError>([&] {
            TomlFile file = TomlFile::from_text(text, "t.toml");
            TomlFile::Table root = file.root();
            read(root);
        });
    };
    using Table = TomlFile::Table;
    STRCMP_EQUAL("t.toml:1:5: a = 1: expected a text in quotes",
                 refusal("a = 1", [](Table& t) { static_cast<void>(t.text("a")); }).c_str());
    STRCMP_CONTAINS("a = 1: expected [[a]] tables",
                    refusal("a = 1", [](Table& t) { static_cast<void>(t.tables("a")); }).c_str());
    STRCMP_CONTAINS("a = 1: expected a table [a]",
                    refusal("a = 1", [](Table& t) { static_cast<void>(t.table("a")); }).c_str());
    STRCMP_CONTAINS("a = 1: expected true or false",
                    refusal("a = 1", [](Table& t) { static_cast<void>(t.boolean("a", false)); }).c_str());
    const std::vector<std::string> choices{"true", "up"};
    STRCMP_CONTAINS("a: missing, expected one of true, up",
                    refusal("", [&](Table& t) { static_cast<void>(t.choice("a", choices)); }).c_str());
    STRCMP_CONTAINS("a = false: expected one of true, up",
                    refusal("a = false", [&](Table& t) { static_cast<void>(t.choice("a", choices)); }).c_str());
    STRCMP_EQUAL("", refusal("a = true", [&](Table& t) { UNSIGNED_LONGS_EQUAL(0, t.choice("a", choices)); }).c_str());
}

TEST(TomlReader, refuses_a_file_of_more_than_16_MiB) {
    const TemporaryFolder folder;
    const auto file = folder.write("large.toml", std::string((16U << 20U) + 1, '\n'));
    STRCMP_CONTAINS("large.toml: larger than 16 MiB, expected a TOML file of parameters",
                    message_of<InputError>([&] { TomlFile::open(file.string()); }).c_str());
}
