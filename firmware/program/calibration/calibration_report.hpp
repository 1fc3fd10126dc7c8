// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/calibration_keys.hpp"
#include "files/toml_writer.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace millforce::host {

/// Exit codes of the program's commands; bad input is an InputError, for which the program returns 2.
inline constexpr int exit_done = 0;
inline constexpr int exit_bound_broken = 1;

/// A fitted value as it is printed and written.
struct FittedValue {
    CalibrationKey key;
    double value = 0.0;
    double standard_error = 0.0;
};

/// Prints one aligned line "name  value ± standard error  unit"; a value without a standard error was not fitted.
void print_fitted(std::ostream& out, const FittedValue& fitted);

/// Prints that the value is smaller than its standard error, so that the data were fitted without it and it is not
/// written.
void print_left_out(std::ostream& out, const FittedValue& left_out);

/// Writes KEY and KEY_se; a standard error of 0 is not written. Throws InputError if the value lies outside
/// the range of the parameter files: such data do not come from a machine, and the file could not be read back.
void write_fitted(TomlWriter& toml, const FittedValue& fitted);

/// Writes a standard deviation, or another value that only bad data make 0 or less. Throws InputError as write_fitted.
void write_positive(TomlWriter& toml, const CalibrationKey& key, double value);

/// Of the parameters `candidates` of a fit: the one whose standard error exceeds its value by the largest factor, if
/// there is any. A parameter that the data do not determine at all comes first.
template <typename Fit>
std::optional<int> most_vague(const Fit& fit, const std::vector<int>& candidates, double error_scale = 1.0) {
    std::optional<int> vague;
    double largest = 1.0;
    for (const int j : candidates) {
        const double ratio = error_scale * fit.standard_error(j) / std::abs(fit.parameters(j));
        const double excess = std::isnan(ratio) ? std::numeric_limits<double>::infinity() : ratio;
        if (excess > largest) {
            largest = excess;
            vague = j;
        }
    }
    return vague;
}

/// "a.csv, b.csv" for a TOML comment.
std::string list_of_files(const std::vector<std::filesystem::path>& files);

}  // namespace millforce::host
