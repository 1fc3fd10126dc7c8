// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace millforce::host {

/// A key of a file that a calibration wrote, with what the parameter table says of it.
struct FittedKey {
    std::string table;
    std::string key;
    double value = 0.0;
    std::optional<double> standard_error;
    std::string unit;
    std::string sentence;
};

/// Numbers only. Throws InputError where the file is no TOML.
std::vector<FittedKey> fitted_keys(const std::filesystem::path& file);

}  // namespace millforce::host
