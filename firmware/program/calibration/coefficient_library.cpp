// SPDX-License-Identifier: Apache-2.0
#include "calibration/coefficient_library.hpp"

#include "files/input_error.hpp"
#include "files/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace millforce::host {

std::vector<LibraryEntry> read_coefficient_library(const std::filesystem::path& file) {
    TomlFile toml = TomlFile::open(file.string());
    TomlFile::Table root = toml.root();
    std::vector<LibraryEntry> entries;
    for (TomlFile::Table& table : root.tables("coefficients")) {
        LibraryEntry entry;
        entry.name = table.text("name");
        entry.tool = table.text("tool", "");
        entry.workpiece = table.text("workpiece", "");
        entry.source = table.text("source", "");
        entry.law.k_s_N_per_mm2 = table.number("k_s_N_per_mm2", 1.0, 1e5);
        entry.law.p_s = table.number("p_s", -0.9, 0.5, 0.0);
        entry.law.k_1 = table.number("k_1", 0.0, 10.0);
        entry.law.p_1 = table.number("p_1", -0.9, 0.5, 0.0);
        entry.law.K_s_relative_sd = table.number("K_s_relative_sd", 0.0, 1.0, 0.0);
        entry.law.r_1_relative_sd = table.number("r_1_relative_sd", 0.0, 1.0, 0.0);
        table.reject_unknown_keys();
        const bool twice = std::any_of(entries.begin(), entries.end(),
                                       [&](const LibraryEntry& other) { return other.name == entry.name; });
        if (twice) {
            table.fail("name", "twice in the file, expected another name");
        }
        entries.push_back(entry);
    }
    root.reject_unknown_keys();
    if (entries.empty()) {
        throw InputError(
            fmt::format("{}: no [[coefficients]] table; expected one for each tool and workpiece", file.string()));
    }
    return entries;
}

LibraryEntry library_entry(const std::filesystem::path& file, const std::string& name) {
    const std::vector<LibraryEntry> entries = read_coefficient_library(file);
    if (name.empty() && entries.size() == 1) {
        return entries.front();
    }
    std::string names;
    for (const LibraryEntry& entry : entries) {
        if (entry.name == name) {
            return entry;
        }
        names += (names.empty() ? "" : ", ") + entry.name;
    }
    throw InputError(name.empty() ? fmt::format("{}: {} entries; expected --entry with one of {}", file.string(),
                                                entries.size(), names)
                                  : fmt::format("{}: no entry '{}'; expected one of {}", file.string(), name, names));
}

}  // namespace millforce::host
