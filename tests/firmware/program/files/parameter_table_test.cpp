// SPDX-License-Identifier: Apache-2.0
#include "firmware/parameter_table.hpp"

#include <cmath>
#include <set>
#include <string>
#include <tuple>

#include <CppUTest/TestHarness.h>

using namespace millforce::firmware;

namespace {

constexpr const auto& table = parameter_table<float>;

long words_in(const char* choices) {
    long words = 1;
    for (const char* c = choices; *c != '\0'; ++c) {
        words += *c == '|' ? 1 : 0;
    }
    return words;
}

}  // namespace

TEST_GROUP(ParameterTable){};

TEST(ParameterTable, names_no_key_of_a_table_twice_for_information_neither) {
    std::set<std::tuple<ParameterFile, std::string, std::string>> keys;
    for (const auto& row : table) {
        CHECK_TEXT(keys.insert({row.file, row.table, row.key}).second, row.key);
    }
    for (const auto& row : text_table) {
        CHECK_TEXT(keys.insert({row.file, row.table, row.key}).second, row.key);
    }
    for (const auto& row : information_table) {
        CHECK_TEXT(keys.insert({row.file, row.table, row.key}).second, row.key);
    }
}

TEST(ParameterTable, leaves_no_key_that_could_be_another_ones_standard_error) {
    for (const auto& row : table) {
        CHECK_FALSE(std::string(row.key).ends_with("_se"));
    }
}

TEST(ParameterTable, gives_every_key_a_field_of_its_own) {
    Parameters<float> parameters;
    std::set<const float*> fields;
    for (const auto& row : table) {
        const std::string name = row.table;
        const std::size_t axes = name == "axis" ? 3 : name == "bus.drive" ? 4 : 1;
        for (std::size_t axis = 0; axis < axes; ++axis) {
            CHECK_TEXT(fields.insert(&row.field(parameters, axis)).second, row.key);
        }
    }
}

TEST(ParameterTable, has_each_default_within_its_range_and_a_sentence_for_each_key) {
    for (const auto& row : table) {
        CHECK_TEXT(row.minimum < row.maximum, row.key);
        CHECK_TEXT(
            std::isnan(row.default_value) || (row.default_value >= row.minimum && row.default_value <= row.maximum),
            row.key);
        CHECK_TEXT(std::string(row.sentence).ends_with('.'), row.key);
    }
}

TEST(ParameterTable, has_a_word_for_each_value_of_a_choice) {
    for (const auto& row : table) {
        if (row.choices != nullptr) {
            LONGS_EQUAL(std::lround(row.maximum) + 1, words_in(row.choices));
            DOUBLES_EQUAL(0.0, static_cast<double>(row.minimum), 0.0);
        }
    }
}
