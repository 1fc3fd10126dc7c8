// SPDX-License-Identifier: Apache-2.0
#include "import/text_cells.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace millforce::host;

namespace {

std::string cells_of(std::string_view line, char separator) {
    std::vector<std::string> cells;
    if (!split_cells(line, separator, cells)) {
        return "refused";
    }
    std::string text;
    for (const std::string& cell : cells) {
        text += "[" + cell + "]";
    }
    return text;
}

double number_of(std::string_view cell) {
    NumberReader numbers;
    const CellNumber number = numbers.read(cell);
    return number.problem.empty() ? number.value : -999.0;
}

}  // namespace

TEST_GROUP(TextCells){};

TEST(TextCells, are_split_at_one_separator_without_the_spaces_around_them) {
    STRCMP_EQUAL("[a][b c][][d]", cells_of(" a ; b c;;d", ';').c_str());
    STRCMP_EQUAL("[][1][]", cells_of("\t1\t", '\t').c_str());
    STRCMP_EQUAL("[1.5][-2][x]", cells_of("  1.5 \t -2   x  ", any_space).c_str());
    STRCMP_EQUAL("[]", cells_of("", ',').c_str());
}

TEST(TextCells, may_be_quoted) {
    STRCMP_EQUAL("[1,5][say \"x\"][2]", cells_of("\"1,5\", \"say \"\"x\"\"\" ,2", ',').c_str());
    STRCMP_EQUAL("refused", cells_of("\"1,5", ',').c_str());
    STRCMP_EQUAL("refused", cells_of("\"1\"5,2", ',').c_str());
}

TEST(TextCells, hold_numbers_with_a_point_or_a_comma) {
    DOUBLES_EQUAL(-1.25e-3, number_of("-1.25e-3"), 0.0);
    DOUBLES_EQUAL(-1.25e-3, number_of("-1,25e-3"), 0.0);
    DOUBLES_EQUAL(7.0, number_of("+7"), 0.0);
    CHECK(std::isnan(number_of("")));
    CHECK(std::isnan(number_of("NaN")));
    CHECK(std::isnan(number_of("n/a")));
}

TEST(TextCells, hold_no_number_where_it_could_be_read_in_two_ways) {
    for (const char* cell :
         {"1.234,5", "1,234,567", "1.2.3", "12x", "0x10", "inf", "+-1", "1 2", "--1", "+", "1e999"}) {
        DOUBLES_EQUAL(-999.0, number_of(cell), 0.0);
    }
}

TEST(TextCells, keep_the_decimal_mark_of_their_file) {
    NumberReader numbers;
    CHECK(numbers.read("12").problem.empty());
    CHECK_EQUAL('\0', numbers.decimal_mark());
    CHECK(numbers.read("1,234").problem.empty());
    CHECK_EQUAL(',', numbers.decimal_mark());
    CHECK(!numbers.read("1.234").problem.empty());
    CHECK(numbers.read("5,5").problem.empty());
}
