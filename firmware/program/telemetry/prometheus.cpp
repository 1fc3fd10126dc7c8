// SPDX-License-Identifier: Apache-2.0
#include "telemetry/prometheus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "telemetry/telemetry_fields.hpp"

namespace millforce::host {

namespace {

struct UnitWord {
    std::string_view unit;
    std::string_view suffix;  ///< in the names of fields
    std::string_view word;    ///< in the names of metrics
};

constexpr std::array unit_words{
    UnitWord{"s", "_s", "seconds"},       UnitWord{"1", "", "ratio"},
    UnitWord{"N", "_N", "newtons"},       UnitWord{"A", "_A", "amperes"},
    UnitWord{"mm", "_mm", "millimeters"}, UnitWord{"mm/s", "_mm_s", "millimeters_per_second"},
};

std::string metric_name(const TelemetryField& field) {
    std::string name = fmt::format("millforce_{}", field.name);
    const auto* unit = std::find_if(unit_words.begin(), unit_words.end(),
                                    [&field](const UnitWord& word) { return word.unit == field.unit; });
    if (unit != unit_words.end()) {
        name.resize(name.size() - unit->suffix.size());
        name += fmt::format("_{}", unit->word);
    }
    return field.kind == FieldKind::counter ? name + "_total" : name;
}

bool has_word(const FieldValue& value, std::string_view word) {
    if (const auto* one = std::get_if<std::string_view>(&value)) {
        return *one == word;
    }
    const auto* some = std::get_if<std::vector<std::string_view>>(&value);
    return some != nullptr && std::find(some->begin(), some->end(), word) != some->end();
}

std::string sample_lines(const std::string& name, const TelemetryField& field, const FieldValue& value) {
    std::string text;
    for (const std::string_view word : field.words) {
        text += fmt::format("{}{{{}=\"{}\"}} {}\n", name, field.name, word, has_word(value, word) ? 1 : 0);
    }
    if (const auto* flag = std::get_if<bool>(&value)) {
        text = fmt::format("{} {}\n", name, *flag ? 1 : 0);
    } else if (field.words.empty() && !std::holds_alternative<std::monostate>(value)) {
        text = fmt::format("{} {}\n", name, json_value(value));
    }
    return text;
}

}  // namespace

std::string prometheus_text(const Telemetry& telemetry) {
    std::string text;
    for (const TelemetryField& field : telemetry_fields()) {
        const std::string name = metric_name(field);
        fmt::format_to(std::back_inserter(text), "# HELP {} {}.\n# TYPE {} {}\n", name, field.meaning, name,
                       field.kind == FieldKind::counter ? "counter" : "gauge");
        text += sample_lines(name, field, field.value(telemetry));
    }
    return text;
}

}  // namespace millforce::host
