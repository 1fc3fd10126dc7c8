// SPDX-License-Identifier: Apache-2.0
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <random>

using namespace millforce::host;
using namespace millforce::test;

namespace {

/// The message of the first error on reading column `name` of all rows; empty without one.
std::string error_in(const TemporaryFolder& folder, std::string_view text, std::string_view name) {
    const auto file = folder.write("t.csv", text);
    const std::string message = message_of<InputError>([&] {
        CsvReader csv(file);
        const CsvColumn column = csv.require(name);
        while (csv.next_row()) {
            csv.number(column);
        }
    });
    const std::string place = file.string();
    return message.starts_with(place) ? message.substr(place.size()) : message;
}

std::string error_of(std::string_view text, std::string_view name = "a") {
    return error_in(TemporaryFolder(), text, name);
}

}  // namespace

TEST_GROUP(CsvReader){};

TEST(CsvReader, comments_stand_in_front_of_the_column_names_and_nowhere_else) {
    const TemporaryFolder folder;
    CsvReader csv(folder.write("t.csv", "# a table 1\n#\n\n# second\r\na\n1\n"));
    LONGS_EQUAL(3, csv.comments().size());
    STRCMP_EQUAL("a table 1", csv.comments()[0].c_str());
    STRCMP_EQUAL("second", csv.comments()[2].c_str());
    CHECK(csv.next_row());
    DOUBLES_EQUAL(1.0, csv.number(csv.require("a")), 0.0);
    STRCMP_CONTAINS(":2: ", error_of("a\n# no comment\n").c_str());
    STRCMP_EQUAL(":1: the file is empty; expected a line of column names", error_of("# alone\n").c_str());
}

TEST(CsvReader, finds_columns_by_name_in_any_order) {
    const TemporaryFolder folder;
    CsvReader csv(folder.write("t.csv", "b,a,note\n1,2,x\n3,-4e-3,y\n"));
    const CsvColumn a = csv.require("a");
    const CsvColumn b = csv.require("b");
    CHECK(!csv.find("c").has_value());
    CHECK(csv.next_row());
    DOUBLES_EQUAL(2.0, csv.number(a), 0.0);
    DOUBLES_EQUAL(1.0, csv.number(b), 0.0);
    CHECK(csv.next_row());
    DOUBLES_EQUAL(-0.004, csv.number(a), 0.0);
    LONGS_EQUAL(3, csv.line_number());
    CHECK(!csv.next_row());
    CHECK(!csv.next_row());
}

TEST(CsvReader, takes_byte_order_mark_crlf_quotes_spaces_empty_lines_and_no_final_line_end) {
    const TemporaryFolder folder;
    CsvReader csv(folder.write("t.csv", "\xEF\xBB\xBF\"a\" , \"b,\"\"c\"\r\n\r\n \"1.5\" ,+2\r\n3,4"));
    const CsvColumn a = csv.require("a");
    const CsvColumn b = csv.require("b,\"c");
    CHECK(csv.next_row());
    DOUBLES_EQUAL(1.5, csv.number(a), 0.0);
    DOUBLES_EQUAL(2.0, csv.number(b), 0.0);
    CHECK(csv.next_row());
    DOUBLES_EQUAL(4.0, csv.number(b), 0.0);
    CHECK(!csv.next_row());
}

TEST(CsvReader, reads_an_empty_cell_or_a_missing_column_as_none) {
    const TemporaryFolder folder;
    CsvReader csv(folder.write("t.csv", "a,b\n,1\n"));
    CHECK(csv.next_row());
    CHECK(std::isnan(csv.number(csv.require("a"))));
    CHECK(std::isnan(csv.number(csv.find("nothing"))));
    CHECK(contains(message_of<InputError>([&] { csv.required_number(csv.require("a")); }),
                   ":2: column 'a': the cell is empty; expected a number"));
}

TEST(CsvReader, takes_the_surplus_commas_of_spreadsheets) {
    const TemporaryFolder folder;
    CsvReader csv(folder.write("t.csv", "a,b,,\n1,2,,\n3,4,,,,\n"));
    STRCMP_EQUAL("a,b", csv.header_text().c_str());
    CHECK(csv.next_row());
    STRCMP_EQUAL("1,2", csv.row_text().c_str());
    CHECK(csv.next_row());
    DOUBLES_EQUAL(4.0, csv.number(csv.require("b")), 0.0);
}

TEST(CsvReader, names_file_line_column_value_and_expectation) {
    STRCMP_EQUAL(":3: column 'a': 'fast' is not a number; expected a number with a decimal point, or an empty cell",
                 error_of("a,b\n1,2\nfast,2\n").c_str());
    STRCMP_EQUAL(":2: column 'a': '1e999' is not finite; expected a finite number, or an empty cell for none",
                 error_of("a\n1e999\n").c_str());
    for (const char* cell : {"nan", "inf", "-Infinity", "NaN", "1.5x", "0x1p3", "1 2", "--1", "+-1", "1,5\",2"}) {
        CHECK(!error_of(std::string("a\n") + cell + "\n").empty());
    }
}

TEST(CsvReader, names_the_nearest_column_of_a_missing_one) {
    const std::string message = error_of("time,spindle_angle\n1,2\n", "spindle_angle_rad");
    STRCMP_EQUAL(":1: no column 'spindle_angle_rad'; the nearest is 'spindle_angle'", message.c_str());
    STRCMP_EQUAL(":1: no column 'a'; found only: time, xyz", error_of("time,xyz\n").c_str());
}

TEST(CsvReader, refuses_ragged_rows_and_cut_off_files) {
    STRCMP_EQUAL(":3: 1 cells; expected 2, as in the header", error_of("a,b\n1,2\n3\n4,5\n").c_str());
    STRCMP_EQUAL(":2: 3 cells; expected 2, as in the header", error_of("a,b\n1,2,3\n").c_str());
    STRCMP_EQUAL(":3: 1 cells; expected 2, as in the header (the file seems to be cut off)",
                 error_of("a,b\n1,2\n3").c_str());
}

TEST(CsvReader, refuses_what_is_no_table_of_numbers) {
    STRCMP_EQUAL(":1: the file is empty; expected a line of column names", error_of("").c_str());
    STRCMP_EQUAL(":1: '1.5' is a number; expected a line of column names", error_of("1.5,2\n3,4\n").c_str());
    CHECK(contains(error_of("a;b\n1;2\n"), "separated by semicolons; expected commas"));
    CHECK(contains(error_of("a,a\n1,2\n"), "column 'a' stands there twice"));
    CHECK(contains(error_of("a\n\"1\n"), ":2: cell 1: a quote is opened and not closed"));
    CHECK(contains(error_of("a\n\"1\"x\n"), ":2: cell 1: text after a closing quote"));
    CHECK(contains(error_of(std::string_view("a\n1\0\n", 5)), ":2: a NUL byte"));
    CHECK(contains(error_of("a\n" + std::string(2'000'000, '1')), ":2: more than 1 MiB without a line end"));
    CHECK(contains(message_of<InputError>([] { CsvReader("/nonexistent/x.csv"); }), "cannot be opened"));
    CHECK(contains(message_of<InputError>([] { CsvReader("/"); }), "is a folder"));
}

TEST(CsvReader, keeps_every_message_on_one_line) {
    for (const char* text : {"a\nx\x01\x1b[31my\n", "a\n\"\r\n", "b\x07\x1b,c\n1,2\n", "a\r\r\nq\r\r\n"}) {
        const std::string message = error_of(text);
        for (const char letter : message) {
            CHECK(static_cast<unsigned char>(letter) >= 0x20);
        }
    }
}

TEST(CsvReader, takes_numbers_too_small_for_double_as_zero) {
    STRCMP_EQUAL("", error_of("a\n1e-400\n").c_str());
}

TEST(CsvReader, survives_any_bytes) {
    const TemporaryFolder folder;
    std::mt19937 random(7);
    const std::string letters = "a,b\"\r\n1.e-+ \t;\xEF\xBB\xBF\xff";
    for (int repetition = 0; repetition < 500; ++repetition) {
        std::string text = "a,b\n";
        for (auto k = random() % 40; k > 0; --k) {
            text += letters[random() % letters.size()];
        }
        error_in(folder, text, "a");  // an InputError or none; anything else ends the test
    }
}

TEST(CsvReader, streams_a_large_file_line_by_line) {
    const TemporaryFolder folder;
    std::string text = "time_s,x\n";
    for (int k = 0; k < 200'000; ++k) {
        text += std::to_string(k) + ",0.25\n";
    }
    CsvReader csv(folder.write("t.csv", text));
    const CsvColumn time = csv.require("time_s");
    double sum = 0.0;
    while (csv.next_row()) {
        sum += csv.number(time);
    }
    DOUBLES_EQUAL(199'999.0 * 200'000.0 / 2.0, sum, 0.0);
    DOUBLES_EQUAL(1.0, csv.fraction_read(), 0.01);
}

TEST(CsvReader, refuses_numbers_beyond_anything_measured) {
    STRCMP_EQUAL("", error_of("a\n1e18\n-1e18\n").c_str());
    STRCMP_EQUAL(":2: column 'a': '-1.1e18' is beyond anything measured; expected at most 1e+18",
                 error_of("a\n-1.1e18\n").c_str());
}

TEST(CsvReader, shows_the_names_of_many_columns_and_of_long_ones_by_their_begin) {
    std::string names = std::string(5000, 'x') + "\x7F";
    for (int k = 0; k < 500; ++k) {
        names += ",column" + std::to_string(k);
    }
    const std::string message = error_of(names + "\n", "y");
    STRCMP_CONTAINS(":1: no column 'y'", message.c_str());
    CHECK(message.size() < 2000);
    CHECK(message.find('\x7F') == std::string::npos);
    CHECK(error_of("a\n" + std::string(5000, 'x') + "\n").size() < 500);
    CHECK(error_of("a\nx\x7Fx\n").find('\x7F') == std::string::npos);
}

TEST(CsvReader, of_an_empty_first_name_is_no_number) {
    STRCMP_EQUAL("", error_of(",a\n1,2\n").c_str());
}
