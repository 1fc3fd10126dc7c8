// SPDX-License-Identifier: Apache-2.0
#include "calibration/calibration_report.hpp"

#include "files/input_error.hpp"

#include <fmt/format.h>

#include <cmath>

#include <utility>

namespace millforce::host {

void print_fitted(std::ostream& out, const FittedValue& fitted) {
    if (std::isnan(fitted.standard_error)) {
        out << fmt::format("  {:<40} {:>12.6g}   not fitted\n", fitted.key.name, fitted.value);
        return;
    }
    out << fmt::format("  {:<40} {:>12.6g} ± {:<10.3g} {}\n", fitted.key.name, fitted.value, fitted.standard_error,
                       fitted.key.unit);
}

void write_fitted(TomlWriter& toml, const FittedValue& fitted) {
    const auto [low, high] = std::pair(fitted.key.minimum, fitted.key.maximum);
    if (!(fitted.value >= static_cast<double>(low) && fitted.value <= static_cast<double>(high))) {
        throw InputError(fmt::format("the data give '{}' = {:.6g} {}; expected a value from {} to {}", fitted.key.name,
                                     fitted.value, fitted.key.unit, low, high));
    }
    toml.key(fitted.key.name, fitted.value);
    toml.key(std::string(fitted.key.name) + "_se", fitted.standard_error);
}

std::string list_of_files(const std::vector<std::filesystem::path>& files) {
    std::string result;
    for (const auto& file : files) {
        result += (result.empty() ? "" : ", ") + file.filename().string();
    }
    return result;
}

}  // namespace millforce::host
