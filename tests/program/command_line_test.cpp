// SPDX-License-Identifier: Apache-2.0
#include "inputs.hpp"

#include "parameters/parameter_table.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

namespace {

const std::vector<std::vector<std::string>> commands{{},
                                                     {"simulate"},
                                                     {"replay"},
                                                     {"calibrate"},
                                                     {"calibrate", "friction"},
                                                     {"calibrate", "spindle"},
                                                     {"calibrate", "standard-cut"},
                                                     {"calibrate", "warm-up"},
                                                     {"calibrate", "cutting"},
                                                     {"estimate"},
                                                     {"reproduce"},
                                                     {"run"},
                                                     {"serve"},
                                                     {"plant"},
                                                     {"cut-table"},
                                                     {"bench"},
                                                     {"parameters"},
                                                     {"import"}};

std::vector<std::string> plus(std::vector<std::string> words, const std::string& word) {
    words.push_back(word);
    return words;
}

void refuses(const std::vector<std::string>& words, const std::vector<std::string>& parts) {
    STRCMP_EQUAL("", not_refused(run_millforce(words), parts).c_str());
}

}  // namespace

TEST_GROUP(CommandLine){};

TEST(CommandLine, every_command_explains_itself) {
    for (const auto& command : commands) {
        const Ended help = run_millforce(plus(command, "--help"));
        LONGS_EQUAL(0, help.exit_code);
        STRCMP_EQUAL("", help.error.c_str());
        CHECK(contains(help.out, "Usage: "));
        CHECK(contains(help.out, "--version"));
        for (std::size_t start = 0; start < help.out.size(); start = help.out.find('\n', start) + 1) {
            CHECK(help.out.find('\n', start) - start <= 140);
        }
    }
}

TEST(CommandLine, every_command_tells_the_version) {
    for (const auto& command : commands) {
        const Ended version = run_millforce(plus(command, "--version"));
        LONGS_EQUAL(0, version.exit_code);
        CHECK(version.out.starts_with("millforce "));
        LONGS_EQUAL(1, std::count(version.out.begin(), version.out.end(), '\n'));
        STRCMP_EQUAL("", version.error.c_str());
    }
}

TEST(CommandLine, the_programs_help_lists_every_command) {
    const Ended help = run_millforce({"--help"});
    for (const auto& command : commands) {
        CHECK(command.empty() || contains(help.out, "  " + command.front() + " "));
    }
}

TEST(CommandLine, no_command_is_refused_in_one_line_that_names_them) {
    refuses({}, {"no command", "simulate", "replay", "calibrate", "'millforce --help'"});
    refuses({"calibrate"}, {"no command", "friction, spindle, cutting", "'millforce calibrate --help'"});
}

TEST(CommandLine, an_unknown_command_or_option_is_refused_with_the_nearest_one) {
    refuses({"simulat", "a.toml"}, {"unknown command 'simulat'", "did you mean simulate?"});
    refuses({"calibrate", "cuting", "a.csv", "-o", "b"}, {"unknown command 'cuting'", "did you mean cutting?"});
    refuses({"simulate", "a.toml", "--sed", "3"}, {"unknown option '--sed'", "did you mean --seed?"});
    refuses({"frobnicate"}, {"unknown command 'frobnicate'", "expected one of simulate, ensemble, replay"});
}

TEST(CommandLine, a_missing_argument_is_named) {
    refuses({"simulate"}, {"scenario"});
    refuses({"replay", "log.csv", "--machine", "m.toml"}, {"--tool"});
    refuses({"calibrate", "friction", "a.csv"}, {"--output"});
}

TEST(CommandLine, a_value_out_of_range_or_of_the_wrong_kind_is_refused) {
    refuses({"simulate", "a.toml", "--cutting-force-scale", "99"}, {"--cutting-force-scale", "99"});
    refuses({"simulate", "a.toml", "--friction-scale", "nan"}, {"--friction-scale"});
    refuses({"simulate", "a.toml", "--seed", "many"}, {"--seed", "many"});
    refuses({"simulate", "a.toml", "--seed", "-1"}, {"--seed", "-1"});
    refuses({"simulate", "a.toml", "--controller", "magic"}, {"--controller", "magic", "millforce"});
    refuses({"calibrate", "cutting", "a.csv", "-o", "b.toml", "--law", "cubic"}, {"--law", "cubic"});
}

TEST(CommandLine, parameters_lists_every_key_of_the_table) {
    const Ended listed = run_millforce({"parameters"});
    LONGS_EQUAL(0, listed.exit_code);
    for (const auto& row : millforce::host::parameter_table()) {
        CHECK(contains(listed.out, std::string("| `") + row.key + "` |"));
    }
    for (const auto& row : millforce::host::information_table()) {
        CHECK(contains(listed.out, std::string("| `") + row.key + "` |"));
    }
}
