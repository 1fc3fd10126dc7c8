// SPDX-License-Identifier: Apache-2.0
#include "calibration/calibration_report.hpp"

#include "files/input_error.hpp"

#include <fmt/format.h>

#include <cmath>

#include <utility>

namespace millforce::host {

namespace {

void refuse_beyond_range(const CalibrationKey& key, double value) {
    const auto [low, high] = std::pair(key.minimum, key.maximum);
    if (!(value >= static_cast<double>(low) && value <= static_cast<double>(high))) {
        throw InputError(fmt::format("the data give '{}' = {:.6g} {}; expected a value from {} to {}", key.name, value,
                                     key.unit, low, high));
    }
}

}  // namespace

void print_fitted(std::ostream& out, const FittedValue& fitted) {
    if (std::isnan(fitted.standard_error)) {
        out << fmt::format("  {:<40} {:>12.6g}   not fitted\n", fitted.key.name, fitted.value);
        return;
    }
    out << fmt::format("  {:<40} {:>12.6g} ± {:<10.3g} {}\n", fitted.key.name, fitted.value, fitted.standard_error,
                       fitted.key.unit);
}

void print_left_out(std::ostream& out, const FittedValue& left_out) {
    out << fmt::format(
        "  {:<40} {:>12.6g} ± {:<10.3g} {}: not determined by these data; fitted without it, not written\n",
        left_out.key.name, left_out.value, left_out.standard_error, left_out.key.unit);
}

void write_fitted(TomlWriter& toml, const FittedValue& fitted) {
    refuse_beyond_range(fitted.key, fitted.value);
    toml.key(fitted.key.name, fitted.value);
    if (fitted.standard_error > 0.0) {
        toml.key(std::string(fitted.key.name) + "_se", fitted.standard_error);
    }
}

void write_positive(TomlWriter& toml, const CalibrationKey& key, double value) {
    refuse_beyond_range(key, value);
    if (!(value > 0.0)) {
        throw InputError(
            fmt::format("the data give '{}' = {:.6g} {}; expected more than 0", key.name, value, key.unit));
    }
    toml.key(key.name, value);
}

std::string list_of_files(const std::vector<std::filesystem::path>& files) {
    std::string result;
    for (const auto& file : files) {
        result += (result.empty() ? "" : ", ") + file.filename().string();
    }
    return result;
}

}  // namespace millforce::host
