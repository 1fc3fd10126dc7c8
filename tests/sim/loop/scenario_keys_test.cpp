// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include <CppUTest/TestHarness.h>

namespace {

std::string text_of(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(MILLFORCE_SOURCE_DIR "/" + file).rdbuf();
    return text.str();
}

}  // namespace

TEST_GROUP(ScenarioKeys){};

TEST(ScenarioKeys, stand_in_the_table_of_the_scenarios_page) {
    const std::string page = text_of("sim/scenarios/README.md");
    const std::string readers = text_of("sim/loop/scenario.cpp") + text_of("sim/loop/machine_kind.cpp");
    const std::regex call(R"re((?:number|text|boolean|choice|read|table|tables)\("(\w+)")re");
    int keys = 0;
    for (std::sregex_iterator found(readers.begin(), readers.end(), call), end; found != end; ++found) {
        const std::string key = (*found)[1];
        const bool is_there = page.find("`" + key + "`") != std::string::npos ||
                              page.find("[" + key + "]") != std::string::npos ||
                              page.find("." + key + "]]") != std::string::npos;
        CHECK_TEXT(is_there, key.c_str());
        ++keys;
    }
    CHECK(keys > 60);
}
