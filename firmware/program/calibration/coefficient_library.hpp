// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cutting_law.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace millforce::host {

/// Published or measured coefficients of one tool and workpiece, Kim & Chung's law: K_s = k_s t_a^p_s, r_1 = k_1
/// t_a^p_1.
struct LibraryEntry {
    std::string name;       ///< name by which it is asked for
    std::string tool;       ///< free text
    std::string workpiece;  ///< free text
    std::string source;     ///< who measured it
    estimation::CuttingLaw<double> law;
};

/// Reads a coefficient database (TOML): one [[coefficients]] table for each entry, with name, tool, workpiece, source,
/// k_s_N_per_mm2, p_s, k_1, p_1, K_s_relative_sd, r_1_relative_sd. Throws InputError: no entry, a name twice, or what
/// TomlFile rejects.
std::vector<LibraryEntry> read_coefficient_library(const std::filesystem::path& file);

/// The entry of this name, or the only one where the name is empty. Throws InputError that lists the names.
LibraryEntry library_entry(const std::filesystem::path& file, const std::string& name);

}  // namespace millforce::host
