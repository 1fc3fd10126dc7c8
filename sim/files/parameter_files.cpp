#include "files/parameter_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "files/toml_reader.hpp"

namespace millforce::sim {

namespace {

using Row = firmware::ParameterRow<float>;

std::vector<std::string> words_of(const char* choices) {
    std::vector<std::string> words{""};
    for (const char* c = choices; *c != '\0'; ++c) {
        if (*c == '|') {
            words.emplace_back();
        } else {
            words.back() += *c;
        }
    }
    return words;
}

void read_row(const Row& row, TomlFile::Table& table, std::size_t axis, firmware::Parameters<float>& parameters) {
    const bool has_default = !std::isnan(row.default_value);
    if (row.choices != nullptr) {
        const std::optional<std::size_t> fallback =
            has_default ? std::optional<std::size_t>(static_cast<std::size_t>(row.default_value)) : std::nullopt;
        row.field(parameters, axis) = static_cast<float>(table.choice(row.key, words_of(row.choices), fallback));
        return;
    }
    const std::optional<double> fallback =
        has_default ? std::optional<double>(static_cast<double>(row.default_value)) : std::nullopt;
    row.field(parameters, axis) = static_cast<float>(
        table.number(row.key, static_cast<double>(row.minimum), static_cast<double>(row.maximum), fallback));
}

/// Free text that belongs to the file but to no algorithm.
void accept_description(TomlFile::Table& root) {
    root.text("name", "");
    root.text("description", "");
}

void read_file(firmware::ParameterFile file, const std::string& path, firmware::Parameters<float>& parameters) {
    TomlFile toml = TomlFile::open(path);
    TomlFile::Table root = toml.root();
    accept_description(root);
    std::map<std::string, TomlFile::Table> tables;
    const auto table_named = [&](const std::string& name) -> TomlFile::Table& {
        const auto found = tables.find(name);
        return found != tables.end() ? found->second : tables.emplace(name, root.table(name)).first->second;
    };
    for (const Row& row : firmware::parameter_table<float>) {
        if (row.file != file) {
            continue;
        }
        const bool is_axis = std::string_view(row.table) == "axis";
        for (std::size_t axis = 0; axis < (is_axis ? firmware::axis_tables.size() : 1); ++axis) {
            read_row(row, table_named(is_axis ? firmware::axis_tables[axis] : row.table), axis, parameters);
        }
    }
    root.reject_unknown_keys();
    for (const auto& [name, table] : tables) {
        table.reject_unknown_keys();
    }
}

}  // namespace

firmware::Parameters<float> read_parameters(const std::string& machine_path, const std::string& tool_path) {
    firmware::Parameters<float> parameters;
    read_file(firmware::ParameterFile::machine, machine_path, parameters);
    read_file(firmware::ParameterFile::tool, tool_path, parameters);
    return parameters;
}

std::string parameter_documentation() {
    std::string text = "| file | key | unit | default | range | meaning |\n|---|---|---|---|---|---|\n";
    for (const Row& row : firmware::parameter_table<float>) {
        const std::string table = std::string_view(row.table) == "axis" ? "x, y, z" : row.table;
        std::string fallback = std::isnan(row.default_value) ? "required" : fmt::format("{}", row.default_value);
        std::string range = fmt::format("{}…{}", row.minimum, row.maximum);
        if (row.choices != nullptr) {
            const std::vector<std::string> words = words_of(row.choices);
            range.clear();
            for (const std::string& word : words) {
                range += (range.empty() ? "" : ", ") + word;
            }
            fallback = words[static_cast<std::size_t>(row.default_value)];
        }
        text += fmt::format("| {}.toml | [{}] {} | {} | {} | {} | {} |\n",
                            row.file == firmware::ParameterFile::machine ? "machine" : "tool", table, row.key,
                            row.unit, fallback, range, row.sentence);
    }
    return text;
}

}  // namespace millforce::sim
