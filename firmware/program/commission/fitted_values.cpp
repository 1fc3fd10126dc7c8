// SPDX-License-Identifier: Apache-2.0
#include "commission/fitted_values.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

#include "files/input_error.hpp"
#include "parameters/parameter_table.hpp"

namespace millforce::host {

namespace {

bool stands_for(const char* row_table, const std::string& table) {
    const auto names = tables_in_file(row_table);
    return std::any_of(names.begin(), names.end(), [&](const char* name) { return table == name; });
}

void describe(FittedKey& key) {
    const auto is_row = [&](const auto& row) { return key.key == row.key && stands_for(row.table, key.table); };
    const auto take = [&](const auto& rows) {
        if (const auto row = std::find_if(rows.begin(), rows.end(), is_row); row != rows.end()) {
            key.unit = row->unit;
            key.sentence = row->sentence;
        }
    };
    take(information_table());
    take(parameter_table());
}

}  // namespace

std::vector<FittedKey> fitted_keys(const std::filesystem::path& file) {
    std::vector<FittedKey> keys;
    try {
        const toml::table root = toml::parse_file(file.string());
        for (const auto& [name, table] : root) {
            if (!table.is_table()) {
                continue;
            }
            const toml::table& values = *table.as_table();
            for (const auto& [key, value] : values) {
                const auto number = value.value<double>();
                if (!number || key.str().ends_with("_se")) {
                    continue;
                }
                FittedKey fitted{std::string(name.str()), std::string(key.str()), *number, {}, {}, {}};
                fitted.standard_error = values[fitted.key + "_se"].value<double>();
                describe(fitted);
                keys.push_back(fitted);
            }
        }
    } catch (const toml::parse_error& error) {
        throw InputError(fmt::format("{}:{}: {}; expected what a calibration wrote", file.string(),
                                     error.source().begin.line, error.description()));
    }
    return keys;
}

}  // namespace millforce::host
