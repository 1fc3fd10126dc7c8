// SPDX-License-Identifier: Apache-2.0
#include "commission/answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <ostream>

#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "files/toml_writer.hpp"

namespace millforce::host {

namespace {

constexpr const char* command_line = "command line";

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

bool is_number(const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

/// KEY=VALUE as a line of TOML: a word needs no quotes on the command line.
std::string toml_line(const std::string& pair) {
    const std::size_t equals = pair.find('=');
    const std::string key = trimmed(pair.substr(0, equals));
    const bool is_key = !key.empty() && key.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                            "0123456789_.") == std::string::npos;
    if (equals == std::string::npos || !is_key) {
        throw InputError(fmt::format("'{}': expected KEY=VALUE, e.g. tool.diameter_mm=10", printable(pair)));
    }
    const std::string value = trimmed(pair.substr(equals + 1));
    return key + " = " + (is_number(value) ? value : toml_string(value)) + "\n";
}

/// "tool.diameter_mm" → "tool", "diameter_mm"
std::pair<std::string, std::string> split(const std::string& key) {
    const std::size_t dot = key.rfind('.');
    return dot == std::string::npos ? std::pair(std::string(), key)
                                    : std::pair(key.substr(0, dot), key.substr(dot + 1));
}

std::string joined(const std::vector<std::string>& words) {
    std::string list;
    for (const std::string& word : words) {
        list += (list.empty() ? "" : ", ") + word;
    }
    return list;
}

std::string range_of(const NumberQuestion& question) {
    return fmt::format("{}number from {:g} to {:g}{}", question.is_whole ? "whole " : "", question.minimum,
                       question.maximum, question.unit.empty() ? "" : " " + question.unit);
}

bool is_allowed(const NumberQuestion& question, double value) {
    return value >= question.minimum && value <= question.maximum && (!question.is_whole || value == std::floor(value));
}

}  // namespace

Answers::Answers(const std::string& file, const std::vector<std::string>& pairs) {
    std::string lines;
    for (const std::string& pair : pairs) {
        lines += toml_line(pair);
    }
    if (!lines.empty()) {
        sources_.push_back(std::make_unique<Source>(Source{TomlFile::from_text(lines, command_line)}));
    }
    if (!file.empty()) {
        sources_.push_back(std::make_unique<Source>(Source{TomlFile::open(file)}));
    }
}

void Answers::add_known(const std::string& file) {
    sources_.push_back(std::make_unique<Source>(Source{TomlFile::open(file), false}));
}

TomlFile::Table& Answers::Source::table(const std::string& name) {
    if (const auto found = tables.find(name); found != tables.end()) {
        return found->second;
    }
    if (name.empty()) {
        return tables.emplace(name, file.root()).first->second;
    }
    const auto [parent, last] = split(name);
    return tables.emplace(name, table(parent).table(last)).first->second;
}

Answers::Source* Answers::source_of(const std::string& key) {
    const auto [table, last] = split(key);
    Source* first = nullptr;
    for (const auto& source : sources_) {
        TomlFile::Table& in = source->table(table);
        in.know(last);
        first = first == nullptr && in.has(last) ? source.get() : first;
    }
    return first;
}

void Answers::ask_on(std::istream& in, std::ostream& out) {
    in_ = &in;
    out_ = &out;
}

bool Answers::has(const std::string& key) {
    return source_of(key) != nullptr;
}

std::optional<std::string> Answers::line_from_terminal(const std::string& prompt) {
    if (in_ == nullptr) {
        return std::nullopt;
    }
    *out_ << prompt << std::flush;
    std::string line;
    if (!std::getline(*in_, line)) {
        in_ = nullptr;
        *out_ << '\n';
        return std::nullopt;
    }
    return trimmed(line);
}

std::optional<double> Answers::number_from_terminal(const NumberQuestion& question) {
    const std::string usual = question.usual ? fmt::format(" [{:g}]", *question.usual) : "";
    const std::string unit = question.unit.empty() ? "" : ", " + question.unit;
    while (const auto line = line_from_terminal(fmt::format("{}{}{}: ", question.words, unit, usual))) {
        if (line->empty() && question.usual) {
            return question.usual;
        }
        double value = std::nan("");
        if (is_number(*line)) {
            std::from_chars(line->data(), line->data() + line->size(), value);
        }
        if (is_allowed(question, value)) {
            return value;
        }
        *out_ << "  expected a " << range_of(question) << '\n';
    }
    return std::nullopt;
}

double Answers::number(const NumberQuestion& question) {
    const bool is_of_missing = question.usual && std::isnan(*question.usual);
    std::optional<double> value;
    if (Source* source = source_of(question.key)) {
        const auto [table, last] = split(question.key);
        value = question.is_whole
                    ? static_cast<double>(
                          source->table(table).integer(last, static_cast<std::int64_t>(question.minimum),
                                                       static_cast<std::int64_t>(question.maximum), {}, question.unit))
                    : source->table(table).number(last, question.minimum, question.maximum, {}, question.unit);
    } else if (!is_of_missing) {
        value = number_from_terminal(question);
    }
    value = value ? value : question.usual;
    if (!value) {
        miss(fmt::format("{}{}", question.key, question.unit.empty() ? "" : " in " + question.unit));
    }
    if (!value || std::isnan(*value)) {
        return std::nan("");
    }
    take(question.key, question.is_whole ? fmt::format("{:.0f}", *value) : toml_number(*value));
    return *value;
}

void Answers::miss(const std::string& answer) {
    if (std::find(missing_.begin(), missing_.end(), answer) == missing_.end()) {
        missing_.push_back(answer);
    }
}

std::int64_t Answers::integer(const NumberQuestion& question) {
    NumberQuestion whole = question;
    whole.is_whole = true;
    const double value = number(whole);
    return std::isnan(value) ? 0 : static_cast<std::int64_t>(value);
}

std::string Answers::word(const WordQuestion& question) {
    std::optional<std::string> value;
    const std::string choices = question.choices.empty() ? "" : " (" + joined(question.choices) + ")";
    if (Source* source = source_of(question.key)) {
        const auto [table, last] = split(question.key);
        TomlFile::Table& in = source->table(table);
        value = question.choices.empty() ? in.text(last) : question.choices[in.choice(last, question.choices)];
    }
    while (!value) {
        const auto line = line_from_terminal(
            fmt::format("{}{}{}: ", question.words, choices, question.usual ? " [" + *question.usual + "]" : ""));
        if (!line) {
            break;
        }
        const bool is_known = question.choices.empty() || std::find(question.choices.begin(), question.choices.end(),
                                                                    *line) != question.choices.end();
        if (line->empty() && question.usual) {
            break;
        }
        if (!line->empty() && is_known) {
            value = line;
        }
    }
    value = value ? value : question.usual;
    if (!value) {
        miss(question.key + choices);
        return {};
    }
    take(question.key, toml_string(*value));
    return *value;
}

void Answers::require_all(bool is_last) const {
    std::string unknown;
    try {
        if (is_last) {
            reject_unknown_keys();
        }
    } catch (const InputError& error) {
        unknown = error.what();
    }
    if (!missing_.empty()) {  // with the misspelt key, which is often the one that is missing
        throw InputError(fmt::format("missing answer{}: {}; give each as KEY=VALUE or in --answers FILE{}{}",
                                     missing_.size() == 1 ? "" : "s", joined(missing_), unknown.empty() ? "" : "; ",
                                     unknown));
    }
    if (!unknown.empty()) {
        throw InputError(unknown);
    }
}

void Answers::reject_unknown_keys() const {
    for (const auto& source : sources_) {
        for (const auto& [name, table] : source->tables) {
            if (source->is_strict) {
                table.reject_unknown_keys();
            }
        }
    }
}

void Answers::take(const std::string& key, const std::string& value) {
    const auto is_same = [&](const auto& taken) { return taken.first == key; };
    if (std::none_of(taken_.begin(), taken_.end(), is_same)) {
        taken_.emplace_back(key, value);
    }
}

std::string Answers::text() const {
    std::string lines;
    for (const auto& [key, value] : taken_) {
        lines += fmt::format("{} = {}\n", key, value);
    }
    return lines;
}

}  // namespace millforce::host
