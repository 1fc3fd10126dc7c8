// SPDX-License-Identifier: Apache-2.0
#include "firmware/program/import/import_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::test;

namespace {

const std::string map = R"([time_s]
source = "t"
[x_current_A]
source = "i"
)";

}  // namespace

TEST_GROUP(TableSource) {
    ImportBench bench;

    /// The current's column of the recording; or the refusal.
    std::string currents(std::string_view text, std::string_view with_map = map) {
        const std::string error = bench.error(text, with_map);
        return error.empty() ? joined(bench.column("x_current_A")) : error;
    }
};

TEST(TableSource, finds_separator_and_decimal_mark) {
    STRCMP_EQUAL("1.5 -2.25", currents("t,i\n0.0,1.5\n0.1,-2.25\n").c_str());
    STRCMP_EQUAL("1.5 -2.25", currents("t;i\n0,0;1,5\n0,1;-2,25\n").c_str());
    STRCMP_EQUAL("1.5 -2.25", currents("t\ti\r\n0,0\t1,5\r\n0,1\t-2,25\r\n").c_str());
    STRCMP_EQUAL("1.5 -2.25", currents("\"t\",\"i\"\n\"0,0\",\"1,5\"\n\"0,1\",\"-2,25\"\n").c_str());
}

TEST(TableSource, finds_the_names_after_thousands_of_lines_and_skips_units_and_comments) {
    std::string text = "\xEF\xBB\xBFScope;export;1.2\n";
    for (int k = 0; k < 5000; ++k) {
        text += "# remark, with; separators\n";
    }
    text += "i;other;t\n[A];;[s]\n\n1;x;0\n% a remark\n2;y;0,1\n";
    STRCMP_EQUAL("1 2", currents(text).c_str());
}

TEST(TableSource, finds_names_in_a_comment_as_numpy_writes_them) {
    STRCMP_EQUAL("4 5", currents("# t,i\n0,4\n1,5\n").c_str());
}

TEST(TableSource, takes_columns_by_number_where_there_are_no_names) {
    STRCMP_EQUAL("4 5", currents("measured on a Monday\n0 s\n0,9,4\n1,9,5\n",
                                 "[time_s]\nsource_number = 1\n[x_current_A]\nsource_number = 3\n")
                            .c_str());
}

TEST(TableSource, leaves_cells_without_a_number_empty_and_counts_them) {
    const auto recording = bench.import("t,i\n0,1\n1,\n2,NaN\n3,4\n", map);
    STRCMP_EQUAL("1 - - 4", joined(bench.column("x_current_A")).c_str());
    LONGS_EQUAL(2, recording.statistics[0].missing());
    LONGS_EQUAL(2, recording.statistics[0].count());
}

TEST(TableSource, leaves_out_a_last_line_that_is_cut_off_and_says_so) {
    const auto recording = bench.import("t,i\n0,1\n1,2\n2", map);
    STRCMP_EQUAL("1 2", joined(bench.column("x_current_A")).c_str());
    CHECK(contains(recording.files[0].notes.back(), "cut off"));
}

TEST(TableSource, names_the_place_of_what_does_not_fit) {
    STRCMP_EQUAL("source0:3: column 'i': 'three', expected a number", currents("t,i\n0,1\n1,three\n").c_str());
    CHECK(contains(currents("t,i\n0,1\n1\n2,3\n"), "source0:3: 1 cells separated by ','; expected 2, as in line 1"));
    CHECK(contains(currents("t,i\n0,1\n0,1,2,5\n"), "source0:3: 4 cells"));
    CHECK(contains(currents("t,i\n0,1\n0,1,2,5\n"), "decimal commas need another separator"));
    CHECK(contains(currents("t;i\n0;1,5\n1;1.5\n"), "source0:3: column 'i': '1.5', expected one decimal mark"));
    CHECK(contains(currents("t;i\n0;1\n1;1.234,5\n"), "no thousands separators"));
    CHECK(contains(currents("t,i\n0,1\n1,\"2\n"), "source0:3:"));
}

TEST(TableSource, names_the_nearest_column_and_the_line_that_it_took_for_the_names) {
    const std::string error = currents("Export\nt;I;j\n0;1;2\n");
    CHECK(contains(error, "source0:2: no column 'i'"));
    CHECK(contains(error, "the line has: t, I, j"));
    CHECK(contains(currents("t,i,i\n0,1,2\n"), "source0:1: column 'i' is there more than once"));
    CHECK(contains(currents(""), "the file is empty"));
    CHECK(contains(currents("t,i\n"), "no rows"));
}

TEST(TableSource, refuses_what_is_no_text) {
    CHECK(contains(currents(std::string_view("\xFF\xFEt\0,\0", 6)), "UTF-8 (not UTF-16)"));
    CHECK(contains(currents(std::string((1U << 20U) + 5, 'x')), "more than 1 MiB without a line end"));
}

TEST(TableSource, of_an_odrive_knows_a_property_by_the_end_of_its_path) {
    const std::string text = "time,odrv0.axis0.vel,odrv0.axis1.vel\n0,1,2\n1,3,4\n";
    const auto with_source = [](const std::string& source) {
        return "[source]\nformat = \"odrive\"\n[time_s]\nsource = \"time\"\n[x_current_A]\nsource = \"" + source +
               "\"\n";
    };
    STRCMP_EQUAL("2 4", currents(text, with_source("axis1.vel")).c_str());
    STRCMP_EQUAL("1 3", currents(text, with_source("odrv0.axis0.vel")).c_str());
    CHECK(contains(currents(text, with_source("vel")), "column 'vel' is there more than once"));
    CHECK(contains(currents(text, with_source("el")), "no column 'el'"));
}

TEST(TableSource, without_a_map_takes_the_columns_that_have_our_names) {
    const auto recording = bench.import("time_s;z_current_A;other\n0;1,5;7\n1;2;7\n", "");
    STRCMP_EQUAL("1.5 2", joined(bench.column("z_current_A")).c_str());
    LONGS_EQUAL(1, recording.columns.size());
    STRCMP_EQUAL("other", joined(recording.unused_names).c_str());
    CHECK(contains(bench.error("time_s,other\n0,1\n", ""), "no column of a recording but time_s; expected --map"));
}

TEST(TableSource, takes_one_column_by_name_and_another_by_number) {
    const char* both = "[time_s]\nsource = \"t\"\n[x_current_A]\nsource_number = 3\n";
    STRCMP_EQUAL("4 5", currents("t,j,j\n0,9,4\n1,9,5\n", both).c_str());
    CHECK(contains(currents("t,j\n0,9\n1,9\n", both), "source0:1: no column 3; expected a line with at least that"));
    CHECK(contains(currents("t,j,j\n0,9,4\n1,9,five\n", both), "source0:3: column 3: 'five', expected a number"));
}

TEST(TableSource, by_number_alone_finds_no_line_where_the_cells_are_no_numbers) {
    const char* numbers = "[time_s]\nsource_number = 1\n[x_current_A]\nsource_number = 2\n";
    CHECK(contains(currents("one,two\nthree,four\n", numbers), "no line with numbers in the columns asked for"));
    CHECK(contains(currents("1\n2\n", numbers), "no column 2"));
    CHECK(contains(currents("0,\n", numbers), "no column 2"));
    STRCMP_EQUAL("4 5", currents("// 7,7\n# 8,8\n0,4\n1,5\n", numbers).c_str());
}

TEST(TableSource, leaves_out_empty_cells_behind_the_last_name) {
    STRCMP_EQUAL("4 5", currents("t,i,,\n0,4,\n1,5,,,\n").c_str());
}

TEST(TableSource, skips_no_more_than_twenty_lines_between_the_names_and_the_numbers) {
    std::string units = "t,i\n";
    for (int k = 0; k < 25; ++k) {
        units += "s,A\n";
    }
    STRCMP_EQUAL("source0:22: column 'i': 'A', expected a number", currents(units + "0,1\n").c_str());
}

TEST(TableSource, reads_no_number_of_hundreds_of_digits) {
    const std::string endless(500, '1');
    CHECK(contains(currents("t,i\n0,1\n1," + endless + "\n"), "expected a number"));
}
