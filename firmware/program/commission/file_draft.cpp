// SPDX-License-Identifier: Apache-2.0
#include "commission/file_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "commission/fitted_values.hpp"
#include "files/atomic_file.hpp"
#include "files/toml_writer.hpp"
#include "parameters/parameter_table.hpp"

namespace millforce::host {

namespace {

/// "x" stands for "axis" in the parameter table.
bool is_table(const char* row_table, const std::string& table) {
    const auto names = tables_in_file(row_table);
    return std::any_of(names.begin(), names.end(), [&](const char* name) { return table == name; });
}

std::string toml_texts(const std::vector<std::string>& values) {
    std::string list;
    for (const std::string& value : values) {
        list += (list.empty() ? "" : ", ") + toml_string(value);
    }
    return "[" + list + "]";
}

}  // namespace

void FileDraft::put(const std::string& table, const std::string& key, std::string text, const std::string& source) {
    tables_[table][key] = {std::move(text), source};
}

void FileDraft::set_heading(const std::string& key, const std::string& value) {
    std::erase_if(headings_, [&](const auto& heading) { return heading.first == key; });
    headings_.emplace_back(key, value);
}

void FileDraft::set(const std::string& table, const std::string& key, double value, const std::string& source) {
    put(table, key, toml_number(value), source);
}

void FileDraft::set_integer(const std::string& table, const std::string& key, std::int64_t value,
                            const std::string& source) {
    put(table, key, fmt::to_string(value), source);
}

void FileDraft::set_flag(const std::string& table, const std::string& key, bool value, const std::string& source) {
    put(table, key, value ? "true" : "false", source);
}

void FileDraft::set_text(const std::string& table, const std::string& key, const std::string& value,
                         const std::string& source) {
    put(table, key, toml_string(value), source);
}

void FileDraft::set_texts(const std::string& table, const std::string& key, const std::vector<std::string>& values,
                          const std::string& source) {
    put(table, key, toml_texts(values), source);
}

void FileDraft::merge(const std::filesystem::path& fitted, const std::string& source) {
    for (const FittedKey& key : fitted_keys(fitted)) {
        set(key.table, key.key, key.value, source);
        if (key.standard_error) {
            set(key.table, key.key + "_se", *key.standard_error);
        }
    }
}

bool FileDraft::has(const std::string& table, const std::string& key) const {
    const auto found = tables_.find(table);
    return found != tables_.end() && found->second.contains(key);
}

std::vector<std::string> FileDraft::table_names() const {
    std::vector<std::string> names;
    for (const ParameterRow& row : parameter_table()) {
        for (const char* name : tables_in_file(row.table)) {
            if (tables_.contains(name) && std::find(names.begin(), names.end(), name) == names.end()) {
                names.emplace_back(name);
            }
        }
    }
    return names;
}

void FileDraft::write_key(std::ostream& out, const std::string& table, const char* key, const char* unit,
                          const char* sentence) const {
    const Table& values = tables_.at(table);
    const auto found = values.find(key);
    if (found == values.end()) {
        return;
    }
    const std::string_view unit_text = unit;
    out << "# " << sentence << (unit_text.empty() || unit_text == "1" ? "" : fmt::format(" In {}.", unit)) << '\n';
    const Value& value = found->second;
    out << key << " = " << value.text << (value.source.empty() ? "" : "  # " + value.source) << '\n';
    if (const auto error = values.find(std::string(key) + "_se"); error != values.end()) {
        out << error->first << " = " << error->second.text << '\n';
    }
}

void FileDraft::write(std::ostream& out) const {
    for (const auto& [key, value] : headings_) {
        out << key << " = " << toml_string(value) << '\n';
    }
    for (const std::string& table : table_names()) {
        out << "\n[" << table << "]\n";
        for (const ParameterRow& row : parameter_table()) {
            if (row.file == file_ && is_table(row.table, table)) {
                write_key(out, table, row.key, row.unit, row.sentence);
            }
        }
        for (const InformationRow& row : information_table()) {
            if (row.file == file_ && is_table(row.table, table)) {
                write_key(out, table, row.key, row.unit, row.sentence);
            }
        }
        for (const TextRow& row : text_table()) {
            if (row.file == file_ && is_table(row.table, table)) {
                write_key(out, table, row.key, "", row.sentence);
            }
        }
    }
}

void FileDraft::save(const std::filesystem::path& path) const {
    AtomicFile file(path);
    write(file.stream());
    file.commit();
}

}  // namespace millforce::host
