// SPDX-License-Identifier: Apache-2.0
#include "files/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "files/input_error.hpp"
#include "files/nearest_name.hpp"
#include "files/printable.hpp"
#include "files/toml_limits.hpp"

namespace millforce::host {

namespace {

// Parameter files are a few kilobytes; anything far larger is not one.
constexpr std::uintmax_t largest_file_bytes = 16U << 20U;

std::string shown(const toml::node& node) {
    std::ostringstream text;
    text << std::boolalpha;
    node.visit([&](const auto& value) {
        if constexpr (toml::is_string<decltype(value)>) {
            text << '"' << printable(value.get()) << '"';
        } else if constexpr (toml::is_table<decltype(value)>) {
            text << "a table";
        } else if constexpr (toml::is_array<decltype(value)>) {
            text << "an array";
        } else {
            text << value.get();
        }
    });
    return text.str();
}

std::string joined(const std::vector<std::string>& words) {
    std::string list;
    for (const std::string& word : words) {
        list += (list.empty() ? "" : ", ") + word;
    }
    return list;
}

std::string after_number(std::string_view unit) {
    return unit.empty() || unit == "1" ? "" : fmt::format(" {}", unit);
}

}  // namespace

TomlFile TomlFile::open(const std::string& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) {
        throw InputError(fmt::format("{}: is a folder, expected a TOML file of parameters", path));
    }
    if (!std::filesystem::is_regular_file(path, error)) {
        throw InputError(fmt::format("{}: no such file", path));
    }
    if (std::filesystem::file_size(path, error) > largest_file_bytes) {
        throw InputError(fmt::format("{}: larger than 16 MiB, expected a TOML file of parameters", path));
    }
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) {
        throw InputError(fmt::format("{}: cannot be read", path));
    }
    return from_text(text.str(), path);
}

TomlFile TomlFile::from_text(const std::string& text, const std::string& name) {
    check_toml_limits(text, name);
    try {
        return {toml::parse(text, name), name};
    } catch (const toml::parse_error& error) {
        throw InputError(fmt::format("{}:{}:{}: not valid TOML: {}", name, error.source().begin.line,
                                     error.source().begin.column, error.description()));
    }
}

std::string TomlFile::Table::full(const std::string& key) const {
    return name_.empty() ? key : name_ + "." + key;
}

std::string TomlFile::Table::place(const toml::node* node) const {
    return node != nullptr && node->source().begin.line > 0
               ? fmt::format("{}:{}:{}", file_, node->source().begin.line, node->source().begin.column)
               : file_;
}

void TomlFile::Table::fail(const std::string& key, const std::string& what) const {
    const toml::node* node = table_ != nullptr ? table_->get(key) : nullptr;
    const std::string value = node != nullptr ? fmt::format(" = {}", shown(*node)) : "";
    throw InputError(fmt::format("{}: {}{}: {}", place(node != nullptr ? node : table_), full(key), value, what));
}

const toml::node* TomlFile::Table::find(const std::string& key) {
    known_.push_back(key);
    return table_ != nullptr ? table_->get(key) : nullptr;
}

bool TomlFile::Table::has(const std::string& key) const {
    return table_ != nullptr && table_->contains(key);
}

std::optional<double> TomlFile::Table::number_in_range(const std::string& key, double minimum, double maximum,
                                                       const std::string& expected, bool has_fallback) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        if (!has_fallback) {
            fail(key, fmt::format("missing, expected {}", expected));
        }
        return std::nullopt;
    }
    const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value) || *value < minimum || *value > maximum) {
        fail(key, fmt::format("expected {}", expected));
    }
    return value;
}

double TomlFile::Table::number(const std::string& key, double minimum, double maximum, std::optional<double> fallback,
                               std::string_view unit) {
    const std::string expected = fmt::format("a number from {} to {}{}", minimum, maximum, after_number(unit));
    const auto value = number_in_range(key, minimum, maximum, expected, fallback.has_value());
    return value ? *value : *fallback;
}

std::int64_t TomlFile::Table::integer(const std::string& key, std::int64_t minimum, std::int64_t maximum,
                                      std::optional<std::int64_t> fallback, std::string_view unit) {
    const std::string expected = fmt::format("an integer from {} to {}{}", minimum, maximum, after_number(unit));
    const auto value = number_in_range(key, static_cast<double>(minimum), static_cast<double>(maximum), expected,
                                       fallback.has_value());
    if (value && *value != std::floor(*value)) {
        fail(key, fmt::format("expected {}", expected));
    }
    return value ? static_cast<std::int64_t>(*value) : *fallback;
}

std::string TomlFile::Table::text(const std::string& key, std::optional<std::string> fallback) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        if (!fallback) {
            fail(key, "missing, expected a text in quotes");
        }
        return *fallback;
    }
    if (!node->is_string()) {
        fail(key, "expected a text in quotes");
    }
    return node->as_string()->get();
}

std::vector<std::string> TomlFile::Table::texts(const std::string& key) {
    const toml::node* node = find(key);
    std::vector<std::string> texts;
    if (node == nullptr) {
        return texts;
    }
    if (!node->is_array()) {
        fail(key, "expected an array of texts in quotes");
    }
    for (const toml::node& element : *node->as_array()) {
        if (!element.is_string()) {
            fail(key, fmt::format("element {} is {}, expected a text in quotes", texts.size() + 1, shown(element)));
        }
        texts.push_back(element.as_string()->get());
    }
    return texts;
}

bool TomlFile::Table::boolean(const std::string& key, bool fallback) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        return fallback;
    }
    if (!node->is_boolean()) {
        fail(key, "expected true or false");
    }
    return node->as_boolean()->get();
}

std::size_t TomlFile::Table::choice(const std::string& key, const std::vector<std::string>& choices,
                                    std::optional<std::size_t> fallback) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        if (!fallback) {
            fail(key, fmt::format("missing, expected one of {}", joined(choices)));
        }
        return *fallback;
    }
    std::string word;
    if (node->is_string()) {
        word = node->as_string()->get();
    } else if (node->is_boolean()) {
        word = node->as_boolean()->get() ? "true" : "false";
    }
    for (std::size_t k = 0; k < choices.size(); ++k) {
        if (choices[k] == word) {
            return k;
        }
    }
    fail(key, fmt::format("expected one of {}", joined(choices)));
}

std::vector<TomlFile::Table> TomlFile::Table::tables(const std::string& key) {
    const toml::node* node = find(key);
    std::vector<Table> result;
    if (node == nullptr) {
        return result;
    }
    if (!node->is_array_of_tables()) {
        fail(key, fmt::format("expected [[{}]] tables", full(key)));
    }
    for (const toml::node& element : *node->as_array()) {
        result.push_back(Table(element.as_table(), file_, fmt::format("{}[{}]", full(key), result.size())));
    }
    return result;
}

TomlFile::Table TomlFile::Table::table(const std::string& key) {
    const toml::node* node = find(key);
    if (node != nullptr && !node->is_table()) {
        fail(key, fmt::format("expected a table [{}]", full(key)));
    }
    return Table(node != nullptr ? node->as_table() : nullptr, file_, full(key));
}

void TomlFile::Table::reject_unknown_keys() const {
    if (table_ == nullptr) {
        return;
    }
    for (const auto& [key, node] : *table_) {
        const std::string name(key.str());
        if (std::find(known_.begin(), known_.end(), name) != known_.end()) {
            continue;
        }
        const std::string nearest = nearest_name(name, known_);
        const std::string hint = nearest.empty() ? "known keys: " + joined(known_) : "did you mean " + nearest + "?";
        throw InputError(fmt::format("{}: {}: unknown key; {}", place(&node), full(printable(name)), hint));
    }
}

}  // namespace millforce::host
