// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "telemetry/telemetry.hpp"

/// The one description of the telemetry. The terminal's view, the web page, JSON, MCAP, the metrics and their
/// documentation are made of it: a field that is added here appears in all of them.

namespace millforce::host {

enum class FieldKind : std::uint8_t {
    number,
    count,    ///< a whole number that may fall
    counter,  ///< a whole number that only rises, until the next start
    flag,
    word,   ///< one of `words`
    words,  ///< some of `words`
};

/// std::monostate: there is no value, e.g. no estimate.
using FieldValue =
    std::variant<std::monostate, float, double, std::uint64_t, bool, std::string_view, std::vector<std::string_view>>;

struct TelemetryField {
    std::string_view name;     ///< with the unit, as in recordings and tables of estimates
    std::string_view unit;     ///< "1": a ratio; empty: none
    std::string_view meaning;  ///< one sentence
    FieldKind kind = FieldKind::number;
    FieldValue (*value)(const Telemetry& telemetry) = nullptr;
    std::span<const std::string_view> words{};
};

[[nodiscard]] std::span<const TelemetryField> telemetry_fields();

/// The value as JSON; empty where there is none.
[[nodiscard]] std::string json_value(const FieldValue& value);

/// All fields that have a value, as one JSON object. Never throws for what a sample may hold.
[[nodiscard]] std::string telemetry_json(const Telemetry& telemetry);

/// The fields as a table in Markdown.
[[nodiscard]] std::string telemetry_table();

}  // namespace millforce::host
