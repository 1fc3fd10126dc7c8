// SPDX-License-Identifier: Apache-2.0
#include "gateway/received_files.hpp"

#include <string>

#include "files/input_error.hpp"
#include "gateway/gateway_settings.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

const std::string tool =
    "[tool]\nteeth = 4\ndiameter_mm = 10\nflute_length_mm = 22\ntooth_force_limit_N = 700\n[control]\n"
    "entry_feed_per_tooth_mm = 0.03\nair_feed_per_tooth_mm = 0.03\nmax_feed_per_tooth_mm = 0.2\n"
    "[cutting]\nk_s_N_per_mm2 = 1650\nk_1 = 0.376\n";

}  // namespace

TEST_GROUP(ReceivedFiles) {
    TemporaryFolder folder;

    std::string settings_error(const std::string& text) {
        const std::string file = folder.write("gateway.toml", text).string();
        return message_of<InputError>([&] { (void)read_gateway_settings(file); });
    }
};

TEST(ReceivedFiles, are_written_whole_where_they_are_sound) {
    ReceivedFiles files(folder.path(""), tool_files());
    STRCMP_EQUAL("", files.receive("T7.toml", tool, false).c_str());
    STRCMP_EQUAL(tool.c_str(), folder.read("T7.toml").c_str());
    STRCMP_EQUAL("", files.receive("T7.toml", "# own\n" + tool, true).c_str());
    CHECK(contains(files.receive("T7.toml", tool, false), "this machine has one of its own"));
    CHECK(folder.read("T7.toml").starts_with("# own"));
}

TEST(ReceivedFiles, leave_the_folder_as_it_was_where_they_are_not) {
    ReceivedFiles files(folder.path(""), tool_files());
    STRCMP_EQUAL("", files.receive("T7.toml", tool, false).c_str());
    for (const char* name : {"../T8.toml", "/tmp/T8.toml", "T8.toml/x", ".T8.toml", "T8.map", ".toml", "", "T8\n.toml",
                             "T0.toml", "T007.toml", "T8 .toml"}) {
        CHECK_TEXT(!files.receive(name, tool, false).empty(), name);
    }
    CHECK(contains(files.receive("T8.toml", "\x1b[2J", false), "T8.toml:1:1"));
    CHECK(contains(files.receive("T8.toml", std::string(100'000, '#'), false), "expected at most 65536"));
    CHECK(contains(files.receive("T7.toml", "teeth = 4", true), "T7.toml"));
    LONGS_EQUAL(1, folder.file_count());
    STRCMP_EQUAL(tool.c_str(), folder.read("T7.toml").c_str());
}

TEST(ReceivedFiles, come_by_settings_that_are_refused_by_key) {
    CHECK(contains(settings_error("[broker]\nhost = \"a\"\n"), "machine"));
    CHECK(contains(settings_error("machine = \"a/b\"\n[broker]\nhost = \"a\"\n"), "machine"));
    CHECK(contains(settings_error("machine = \"all\"\n[broker]\nhost = \"a\"\n"), "machine"));
    CHECK(contains(settings_error("machine = \"a\"\n"), "broker.host"));
    CHECK(contains(settings_error("machine = \"a\"\nquality = 2\n[broker]\nhost = \"a\"\n"), "quality"));
    CHECK(contains(settings_error("machine = \"a\"\njobs = \"/none\"\n[broker]\nhost = \"a\"\n"), "jobs"));
    CHECK(contains(settings_error("machine = \"a\"\n[broker]\nhost = \"a\"\nusername = \"u\"\npassword_file = \"p\"\n"),
                   "without TLS the password is readable"));
}
