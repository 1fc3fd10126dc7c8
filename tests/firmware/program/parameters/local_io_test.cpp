// SPDX-License-Identifier: Apache-2.0
#include "parameters/local_io_reader.hpp"

#include "files/input_error.hpp"
#include "parameters/parameter_choices.hpp"

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include <CppUTest/TestHarness.h>

using namespace millforce::host;

namespace {

/// Stands for a value of any type, to count the members of a structure.
struct Anything {
    template <typename Type>
    operator Type() const;  // NOLINT(google-explicit-constructor): a member is initialized by it
};

template <typename Structure, typename... Members>
constexpr std::size_t member_count(Members... members) {
    if constexpr (requires { Structure{members..., Anything{}}; }) {
        return member_count<Structure>(members..., Anything{});
    } else {
        return sizeof...(Members);
    }
}

std::size_t places_of(const char* table) {
    return std::string(table) == "iio.drive" ? local_drive_tables.size() : 1;
}

template <typename Type>
bool holds(const LocalValueRow& row) {
    LocalIoKeys keys;
    return std::holds_alternative<Type*>(row.field(keys, 0));
}

LocalIoKeys read(const std::string& text) {
    TomlFile toml = TomlFile::from_text(text, "machine.toml");
    TomlFile::Table root = toml.root();
    std::map<std::string, TomlFile::Table> tables;
    const std::function<TomlFile::Table&(const std::string&)> table_of =
        [&](const std::string& name) -> TomlFile::Table& {
        if (const auto found = tables.find(name); found != tables.end()) {
            return found->second;
        }
        const std::size_t dot = name.rfind('.');
        TomlFile::Table& parent = dot == std::string::npos ? root : table_of(name.substr(0, dot));
        return tables.emplace(name, parent.table(name.substr(dot + 1))).first->second;
    };
    return read_local_io(table_of);
}

std::string one_current() {
    return "[iio.x]\ncurrent_channel = \"voltage0\"\nA_per_V = 10\n[iio]\ndevice = \"adc\"\nbuffer = \"buffer\"\n";
}

std::string refusal_of(const std::string& text) {
    try {
        (void)read(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_GROUP(LocalIo){};

TEST(LocalIo, has_one_row_for_each_field_of_the_structures) {
    LocalIoKeys keys;
    std::set<const void*> fields;
    std::size_t rows = 0;
    for (const LocalTextRow& row : local_texts) {
        for (std::size_t place = 0; place < places_of(row.table); ++place) {
            fields.insert(&row.field(keys, place));
            ++rows;
        }
    }
    for (const LocalValueRow& row : local_values) {
        for (std::size_t place = 0; place < places_of(row.table); ++place) {
            std::visit([&](const auto* field) { fields.insert(field); }, row.field(keys, place));
            ++rows;
        }
    }
    UNSIGNED_LONGS_EQUAL(rows, fields.size());
    const std::size_t of_drives = keys.drives.size() * member_count<LocalDriveKeys>();
    UNSIGNED_LONGS_EQUAL(member_count<LocalIoKeys>() - 1 + of_drives, fields.size());
}

TEST(LocalIo, has_each_default_within_its_range_or_requires_the_key) {
    LocalIoKeys defaults;
    for (const LocalValueRow& row : local_values) {
        CHECK_TEXT(row.minimum < row.maximum, row.key);
        const double value =
            std::visit([](const auto* field) { return static_cast<double>(*field); }, row.field(defaults, 0));
        CHECK_TEXT(row.is_required || (value >= row.minimum && value <= row.maximum), row.key);
    }
}

TEST(LocalIo, has_a_sentence_for_each_key_and_names_none_of_a_table_twice) {
    std::set<std::pair<std::string, std::string>> keys;
    for (const LocalTextRow& row : local_texts) {
        CHECK_TEXT(keys.insert({row.table, row.key}).second, row.key);
        CHECK_TEXT(std::string(row.sentence).ends_with('.'), row.key);
    }
    for (const LocalValueRow& row : local_values) {
        CHECK_TEXT(keys.insert({row.table, row.key}).second, row.key);
        CHECK_TEXT(std::string(row.sentence).ends_with('.'), row.key);
    }
}

TEST(LocalIo, has_a_name_for_each_value_of_an_enumeration_and_for_nothing_else) {
    std::size_t enumerations = 0;
    for (const LocalValueRow& row : local_values) {
        const bool is_enumeration = holds<ConverterMode>(row);
        CHECK_EQUAL_TEXT(is_enumeration, row.choices != nullptr, row.key);
        if (is_enumeration) {
            CHECK_EQUAL_TEXT(static_cast<std::size_t>(row.maximum) + 1, words_of(row.choices).size(), row.key);
        }
        CHECK_TEXT(!holds<bool>(row) || (row.minimum == 0.0 && row.maximum == 1.0), row.key);
        enumerations += is_enumeration ? 1 : 0;
    }
    UNSIGNED_LONGS_EQUAL(1, enumerations);
}

TEST(LocalIo, that_a_file_leaves_out_is_as_the_structures_have_it) {
    const LocalIoKeys defaults;
    const LocalIoKeys keys = read(one_current());
    CHECK(keys.mode == defaults.mode);
    CHECK_EQUAL(defaults.configures, keys.configures);
    UNSIGNED_LONGS_EQUAL(defaults.buffer_scans, keys.buffer_scans);
    DOUBLES_EQUAL(defaults.stale_ms, keys.stale_ms, 0.0);
    DOUBLES_EQUAL(defaults.drives[1].largest_A, keys.drives[1].largest_A, 0.0);
    UNSIGNED_LONGS_EQUAL(defaults.drives[1].largest_count_step, keys.drives[1].largest_count_step);
    LONGS_EQUAL(defaults.highest_raw, keys.highest_raw);
    UNSIGNED_LONGS_EQUAL(defaults.pulse_line, keys.pulse_line);
}

TEST(LocalIo, reads_flags_as_truth_values_or_their_words_and_counts_as_whole_numbers) {
    const LocalIoKeys keys = read(one_current() +
                                  "configures = false\nbuffer_scans = 512.0\nsample_period_us = 97.5\nmode = "
                                  "\"polled\"\n[feed_hold_line]\nchip = \"chip\"\npulse_line = 27\nactive_low = "
                                  "\"true\"\n[override_voltage]\ndevice = \"dac\"\nchannel = \"voltage0\"\n"
                                  "lowest_raw = -2048\nhighest_raw = 2047\n");
    CHECK_FALSE(keys.configures);
    CHECK_TRUE(keys.active_low);
    CHECK(keys.mode == ConverterMode::polled);
    UNSIGNED_LONGS_EQUAL(512, keys.buffer_scans);
    DOUBLES_EQUAL(97.5, keys.sample_period_us, 0.0);
    UNSIGNED_LONGS_EQUAL(27, keys.pulse_line);
    LONGS_EQUAL(-2048, keys.lowest_raw);
    STRCMP_CONTAINS("iio.buffer_scans = 512.5: expected an integer",
                    refusal_of(one_current() + "buffer_scans = 512.5\n").c_str());
    STRCMP_CONTAINS("iio.configures = 1: expected one of false, true",
                    refusal_of(one_current() + "configures = 1\n").c_str());
    UNSIGNED_LONGS_EQUAL(4'294'967'295U,
                         read("[iio]\ndevice = \"adc\"\nbuffer = \"b\"\n[iio.x]\ncurrent_channel = \"v\"\nA_per_V = "
                              "1\ncount_modulus = 4294967295\n")
                             .drives[1]
                             .count_modulus);
}

TEST(LocalIo, that_cannot_be_meant_is_refused_with_its_key) {
    const std::string no_channel = "[iio]\ndevice = \"adc\"\nbuffer = \"b\"\n";
    STRCMP_CONTAINS("iio.device = \"adc\": has no channel, expected [iio.spindle]", refusal_of(no_channel).c_str());
    STRCMP_CONTAINS("iio.x.A_per_V = 0: 0, expected the current per volt",
                    refusal_of("[iio.x]\ncurrent_channel = \"v\"\nA_per_V = 0\n" + no_channel).c_str());
    const std::string counter =
        "[iio.x]\ncurrent_channel = \"v\"\nA_per_V = 1\ncount_file = \"count\"\nmm_per_count = ";
    STRCMP_CONTAINS("expected the travel per count with count_file", refusal_of(counter + "0\n" + no_channel).c_str());
    STRCMP_EQUAL("", refusal_of(counter + "0.01\n" + no_channel).c_str());

    const std::string voltage = "[override_voltage]\nchannel = \"voltage0\"\n";
    STRCMP_CONTAINS("override_voltage.device: is missing, expected both", refusal_of(voltage).c_str());
    const std::string whole = voltage + "device = \"dac\"\n";
    STRCMP_EQUAL("", refusal_of(whole).c_str());
    STRCMP_CONTAINS("expected more than lowest_V", refusal_of(whole + "lowest_V = 5\nhighest_V = 5\n").c_str());
    STRCMP_CONTAINS("V_per_ratio other than 0", refusal_of(whole + "V_per_ratio = 0\n").c_str());
    STRCMP_CONTAINS("highest_raw = 7: expected more than lowest_raw",
                    refusal_of(whole + "lowest_raw = 7\nhighest_raw = 7\n").c_str());

    STRCMP_CONTAINS("feed_hold_line.chip: is missing", refusal_of("[feed_hold_line]\npulse_line = 3\n").c_str());
    STRCMP_CONTAINS("feed_hold_line.pulse_line = 3: is the release's, expected another",
                    refusal_of("[feed_hold_line]\nchip = \"c\"\npulse_line = 3\nrelease_line = 3\n").c_str());
}
