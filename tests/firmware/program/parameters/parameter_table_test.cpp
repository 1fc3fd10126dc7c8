// SPDX-License-Identifier: Apache-2.0
#include "parameters/parameter_table.hpp"
#include "firmware/crc32.hpp"
#include "firmware/parameter_block.hpp"
#include "firmware_can/bus_settings.hpp"
#include "parameters/parameter_choices.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <vector>

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

/// As wide as any alignment in the parameters, so that no padding can hide a field of it.
using Wide = long double;

/// Which bytes of the parameters belong to a field.
class CoveredBytes {
  public:
    explicit CoveredBytes(const firmware::Parameters<Wide>& parameters)
        : begin_(reinterpret_cast<const unsigned char*>(&parameters)), covered_(sizeof(parameters), false) {}

    template <typename Field>
    void cover(const Field& field) {
        const auto first = static_cast<std::size_t>(reinterpret_cast<const unsigned char*>(&field) - begin_);
        for (std::size_t k = 0; k < sizeof(Field); ++k) {
            covered_[first + k] = true;
        }
    }
    [[nodiscard]] std::size_t longest_gap() const {
        std::size_t longest = 0;
        std::size_t gap = 0;
        for (const bool is_covered : covered_) {
            gap = is_covered ? 0 : gap + 1;
            longest = gap > longest ? gap : longest;
        }
        return longest;
    }

  private:
    const unsigned char* begin_;
    std::vector<bool> covered_;
};

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
            CHECK_TEXT(name.place < tables_in_file(row.table).size(), row.key);
            ++fields;
        });
    std::size_t keys_of_files = 0;
    for (const ParameterRow& row : parameter_table()) {
        keys_of_files += tables_in_file(row.table).size();
    }
    UNSIGNED_LONGS_EQUAL(fields, keys_of_files);
}

TEST(ParameterTable, has_all_fields_of_the_structures_but_those_worked_out_of_others) {
    const firmware::Parameters<Wide> parameters;
    CoveredBytes bytes(parameters);
    firmware::for_each_parameter(parameters, [&](const firmware::ParameterName& /*name*/, const auto& field,
                                                 float /*minimum*/, float /*maximum*/) { bytes.cover(field); });
    // Set by controller_parameters() and force_drop_law().
    const auto& control = parameters.tool.control;
    bytes.cover(control.tooth_force_limit_N);
    bytes.cover(control.override_min);
    bytes.cover(control.override_max);
    bytes.cover(control.stale_s);
    bytes.cover(control.teeth);
    bytes.cover(control.reaction_s);
    bytes.cover(control.monitor_only);
    const auto& law = parameters.tool.force_drop.law;
    bytes.cover(law.valid);
    bytes.cover(law.a_b_covariance(1, 0));
    bytes.cover(law.c_covariance(1, 0));
    bytes.cover(law.c_covariance(2, 0));
    bytes.cover(law.c_covariance(2, 1));
    // Shorter gaps are padding.
    CHECK_TRUE(bytes.longest_gap() < sizeof(Wide));
}

TEST(ParameterTable, shows_the_object_of_the_count_that_a_drive_has_by_default) {
    const firmware::DriveObjects defaults;
    for (const TextRow& row : text_table()) {
        if (std::string(row.key) == "count_object") {
            STRCMP_EQUAL(fmt::format("0x{:04X}", defaults.count.index).c_str(), row.default_text);
        }
    }
    UNSIGNED_LONGS_EQUAL(0, defaults.index_count.index);
    UNSIGNED_LONGS_EQUAL(0, defaults.index_number.index);
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
        CHECK_EQUAL_TEXT(is_enumeration, row.choices != nullptr, row.key);
        if (is_enumeration) {
            CHECK_EQUAL_TEXT(std::lround(row.maximum) + 1, static_cast<long>(words_of(row.choices).size()), row.key);
        }
        enumerations += is_enumeration ? 1 : 0;
    }
    UNSIGNED_LONGS_EQUAL(6, enumerations);
}

TEST(ParameterTable, has_the_fingerprint_that_blocks_carry) {
    // Where this fails, the keys, their units or their order have changed: put the actual value into
    // parameter_block.hpp.
    UNSIGNED_LONGS_EQUAL(fingerprint(), firmware::table_fingerprint);
}
