// SPDX-License-Identifier: Apache-2.0
#include "files/csv.hpp"
#include "files/nearest_name.hpp"
#include "files/toml_writer.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

using namespace millforce::host;

TEST_GROUP(CsvWriter){};

TEST(CsvWriter, writes_the_shortest_numbers_that_read_back_and_empty_cells_for_no_estimate) {
    std::ostringstream out;
    const std::array<std::string_view, 3> names{"a", "b", "c"};
    CsvWriter csv(out, names);
    csv.row(std::array{0.1, no_estimate, 1.0 / 3.0});
    csv.row(std::array{-std::numeric_limits<double>::infinity(), 1e-300, 0.0});
    STRCMP_EQUAL("a,b,c\n0.1,,0.3333333333333333\n,1e-300,0\n", out.str().c_str());
}

TEST(CsvWriter, refuses_a_row_of_another_length) {
    std::ostringstream out;
    const std::array<std::string_view, 2> names{"a", "b"};
    CsvWriter csv(out, names);
    CHECK_THROWS(std::logic_error, csv.row(std::array{1.0}));
}

TEST_GROUP(TomlWriter){};

TEST(TomlWriter, writes_floats_strings_tables_and_comments) {
    std::ostringstream out;
    TomlWriter toml(out);
    toml.comment("from a\nb");
    toml.table("cutting");
    toml.key("p_s", -0.25, "exponent");
    toml.key("whole", 3.0);
    toml.key("huge", 1e300);
    toml.key("none", std::nan(""));
    toml.key("side", "a\"\\\n");
    STRCMP_EQUAL(
        "# from a?b\n\n[cutting]\np_s = -0.25  # exponent\nwhole = 3.0\nhuge = 1e+300\nside = \"a\\\"\\\\\\u000A\"\n",
        out.str().c_str());
}

TEST_GROUP(NearestName){};

TEST(NearestName, finds_the_name_with_the_fewest_changes) {
    const std::vector<std::string> names{"time_s", "spindle_current_A", "x_current_A"};
    STRCMP_EQUAL("spindle_current_A", nearest_name("spindel_current_a", names).c_str());
    STRCMP_EQUAL("x_current_A", nearest_name("z_current_A", names).c_str());
    STRCMP_EQUAL("", nearest_name("feed", names).c_str());
    STRCMP_EQUAL("", nearest_name("feed", {}).c_str());
    STRCMP_EQUAL("", nearest_name(std::string(100'000, 'x'), names).c_str());
}

TEST(NearestName, a_name_whose_unit_was_forgotten_is_the_nearest) {
    const std::vector<std::string> names{"box", "cell_mm", "top_mm"};
    STRCMP_EQUAL("top_mm", nearest_name("top", names).c_str());
    STRCMP_EQUAL("", nearest_name("tap", {names.data(), 1}).c_str());
}
