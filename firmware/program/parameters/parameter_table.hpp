// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <type_traits>

#include "firmware/file_tables.hpp"

/// The table of all keys of machine.toml and tool.toml: what the TOML reader and writer, the calibrations and
/// `millforce parameters` are made from. Fields and ranges come from firmware/parameter_fields.hpp, defaults from the
/// default-constructed parameters, units and sentences from parameter_table.cpp.

namespace millforce::host {

using firmware::axis_tables;
using firmware::drive_tables;

enum class ParameterType : unsigned char {
    number,
    integer,      ///< a count, a CAN id, a node id
    flag,         ///< false or true
    enumeration,  ///< one of a few names
};

template <typename Field>
constexpr ParameterType type_of() {
    if constexpr (std::is_same_v<Field, bool>) {
        return ParameterType::flag;
    } else if constexpr (std::is_enum_v<Field>) {
        return ParameterType::enumeration;
    } else {
        return std::is_integral_v<Field> ? ParameterType::integer : ParameterType::number;
    }
}

struct ParameterRow {
    firmware::ParameterFile file;
    const char* table;  ///< as in firmware::ParameterName
    const char* key;
    const char* unit;
    const char* sentence;
    ParameterType type;
    bool is_required;     ///< the file must give the value
    float default_value;  ///< default of an optional key; an enumeration's as an index
    float minimum;
    float maximum;
    const char* choices;  ///< the names of an enumeration in the order of its values, separated by '|'; else null
};

/// In the order of firmware::for_each_parameter; the keys of "axis" and "bus.drive" once.
std::span<const ParameterRow> parameter_table();
const ParameterRow& row_of(const firmware::ParameterName& name);

/// The tables of a file that `table` stands for: "x", "y", "z" for "axis". `table` must outlive the answer.
std::span<const char* const> tables_in_file(const char* const& table);

/// Keys that a calibration writes for the reader of the file, not for the controller: they are checked and ignored.
/// A numeric key of either table may also have a companion KEY_se, the standard error of its fit.
struct InformationRow {
    firmware::ParameterFile file;
    const char* table;  ///< as in ParameterRow
    const char* key;
    const char* unit;
    const char* sentence;
    const char* choices = nullptr;  ///< as in ParameterRow
};
std::span<const InformationRow> information_table();

/// Keys whose value is text and names objects of a drive: "INDEX" or "INDEX.SUBINDEX", in a PDO with ":BITS".
struct TextRow {
    firmware::ParameterFile file;
    const char* table;  ///< as in ParameterRow
    const char* key;
    const char* default_text;
    const char* form;
    const char* sentence;
};
std::span<const TextRow> text_table();

}  // namespace millforce::host
