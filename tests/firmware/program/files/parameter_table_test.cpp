// SPDX-License-Identifier: Apache-2.0
#include "files/parameter_table.hpp"
#include "firmware/crc32.hpp"
#include "firmware/parameter_block.hpp"

#include <cmath>
#include <set>
#include <span>
#include <string>
#include <tuple>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;

namespace {

/// With the zero at its end, so that "ab" "c" and "a" "bc" differ.
std::uint32_t crc_of_text(std::uint32_t crc, const std::string& text) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(text.c_str());
    return firmware::crc32(crc, std::span(bytes, text.size() + 1));
}

std::uint32_t fingerprint() {
    std::uint32_t crc = 0;
    for (const ParameterRow& row : parameter_table()) {
        const std::array<std::uint8_t, 1> file{static_cast<std::uint8_t>(row.file)};
        crc = firmware::crc32(crc, file);
        for (const char* text : {row.table, row.key, row.unit}) {
            crc = crc_of_text(crc, text);
        }
    }
    return crc;
}

}  // namespace

TEST_GROUP(ParameterTable){};

TEST(ParameterTable, describes_each_field_by_the_row_of_its_key) {
    const firmware::Parameters<float> defaults;
    std::size_t fields = 0;
    firmware::for_each_parameter(
        defaults, [&](const firmware::ParameterName& name, const auto& field, float minimum, float maximum) {
            const ParameterRow& row = row_of(name);
            STRCMP_EQUAL(name.key, row.key);
            CHECK_EQUAL_TEXT(static_cast<float>(field), row.default_value, row.key);
            CHECK_EQUAL_TEXT(minimum, row.minimum, row.key);
            CHECK_EQUAL_TEXT(maximum, row.maximum, row.key);
            CHECK_TEXT(name.place < tables_of(row.table).size(), row.key);
            ++fields;
        });
    std::size_t keys_of_files = 0;
    for (const ParameterRow& row : parameter_table()) {
        keys_of_files += tables_of(row.table).size();
    }
    UNSIGNED_LONGS_EQUAL(fields, keys_of_files);
}

TEST(ParameterTable, names_no_key_of_a_table_twice_for_information_neither) {
    std::set<std::tuple<firmware::ParameterFile, std::string, std::string>> keys;
    for (const ParameterRow& row : parameter_table()) {
        CHECK_TEXT(keys.insert({row.file, row.table, row.key}).second, row.key);
    }
    for (const TextRow& row : text_table()) {
        CHECK_TEXT(keys.insert({row.file, row.table, row.key}).second, row.key);
    }
    for (const InformationRow& row : information_table()) {
        CHECK_TEXT(keys.insert({row.file, row.table, row.key}).second, row.key);
    }
}

TEST(ParameterTable, leaves_no_key_that_could_be_another_ones_standard_error) {
    for (const ParameterRow& row : parameter_table()) {
        CHECK_FALSE(std::string(row.key).ends_with("_se"));
    }
}

TEST(ParameterTable, has_each_default_within_its_range_or_requires_the_key) {
    for (const ParameterRow& row : parameter_table()) {
        CHECK_TEXT(row.minimum < row.maximum, row.key);
        CHECK_TEXT(row.is_required || (row.default_value >= row.minimum && row.default_value <= row.maximum), row.key);
    }
}

TEST(ParameterTable, has_a_sentence_for_each_key) {
    for (const ParameterRow& row : parameter_table()) {
        CHECK_TEXT(std::string(row.sentence).ends_with('.'), row.key);
    }
}

TEST(ParameterTable, has_a_name_for_each_value_of_an_enumeration_and_for_nothing_else) {
    std::size_t enumerations = 0;
    for (const ParameterRow& row : parameter_table()) {
        const bool is_enumeration = row.type == ParameterType::enumeration;
        const auto values = static_cast<std::size_t>(std::lround(row.maximum)) + 1;
        CHECK_EQUAL_TEXT(is_enumeration ? values : 0, row.choices.size(), row.key);
        enumerations += is_enumeration ? 1 : 0;
    }
    UNSIGNED_LONGS_EQUAL(6, enumerations);
}

TEST(ParameterTable, has_the_fingerprint_that_blocks_carry) {
    // Where this fails, the keys, their units or their order have changed: put the actual value into
    // parameter_block.hpp.
    UNSIGNED_LONGS_EQUAL(fingerprint(), firmware::table_fingerprint);
}
