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
    double in_metric = 1.0;   ///< the field's unit: Prometheus wants base units
};

constexpr std::array unit_words{
    UnitWord{"s", "_s", "seconds"},        UnitWord{"1", "", "ratio"},
    UnitWord{"N", "_N", "newtons"},        UnitWord{"A", "_A", "amperes"},
    UnitWord{"mm", "_mm", "meters", 1e-3}, UnitWord{"mm/s", "_mm_s", "meters_per_second", 1e-3},
    UnitWord{"µm", "_um", "meters", 1e-6},
};

/// Null: a field without a unit.
const UnitWord* unit_of(const TelemetryField& field) {
    const auto* unit = std::find_if(unit_words.begin(), unit_words.end(),
                                    [&field](const UnitWord& word) { return word.unit == field.unit; });
    return unit != unit_words.end() ? unit : nullptr;
}

std::string metric_name(const TelemetryField& field) {
    std::string name = fmt::format("millforce_{}", field.name);
    if (const UnitWord* unit = unit_of(field)) {
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
    } else if (const auto* number = std::get_if<float>(&value); number != nullptr && unit_of(field) != nullptr) {
        text = fmt::format("{} {:.7g}\n", name, unit_of(field)->in_metric * static_cast<double>(*number));
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
