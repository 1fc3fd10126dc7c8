// SPDX-License-Identifier: Apache-2.0
#include "firmware/program/report/json_check.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

TEST_GROUP(Reproduce) {
    TemporaryFolder folder;

    Ended reproduce(std::vector<std::string> more) const {
        more.insert(more.begin(), "reproduce");
        more.insert(more.end(), {"--out", folder.path("out").string()});
        return run_millforce(more);
    }
    std::string result(const char* file) const {
        return text_of(folder.path("out") / file);
    }
};

TEST(Reproduce, a_paper_gives_its_table_a_page_and_json_and_is_silent_in_a_pipe) {
    const Ended ended = reproduce({"roughness"});
    LONGS_EQUAL(0, ended.exit_code);
    STRCMP_EQUAL("", ended.error.c_str());
    CHECK(contains(ended.out, "roughness: 12 figures, 12 within their bound\n"));
    CHECK(contains(ended.out, "roughness: 16 checks of our own, 12 within their bound, 4 shown without one\n"));
    CHECK(contains(ended.out, "not reproduced\n  Figs. 2–4: measured roughness: "));
    CHECK(contains(ended.out, "reproduce.html"));
    CHECK(contains(result("reproduce.html"), "Tangjitsitcharoen"));
    CHECK(millforce::host::JsonCheck::valid(result("reproduce.json")));
    CHECK(contains(result("reproduce.json"), "\"holds\": true"));
}

TEST(Reproduce, no_line_is_wider_than_100_columns) {
    std::istringstream text(reproduce({"guan", "--verbose"}).out);
    for (std::string line; std::getline(text, line);) {
        const auto columns = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
        CHECK_TEXT(columns <= 100 || line.starts_with("report: "), line.c_str());
    }
}

TEST(Reproduce, an_unknown_paper_is_refused_with_the_nearest_one_and_nothing_is_written) {
    STRCMP_EQUAL("", not_refused(reproduce({"hwnag"}), {"unknown paper 'hwnag'", "did you mean hwang?"}).c_str());
    STRCMP_EQUAL("", not_refused(reproduce({"zzzz"}), {"expected one of hwang, yang", "all"}).c_str());
    CHECK(!std::filesystem::exists(folder.path("out")));
}

TEST(Reproduce, a_folder_that_cannot_be_made_is_refused_before_the_work) {
    folder.write("out", "a file");
    STRCMP_EQUAL("", not_refused(reproduce({"all"}), {folder.path("out").string(), "folder"}).c_str());
}
