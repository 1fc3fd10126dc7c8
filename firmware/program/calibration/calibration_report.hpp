// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/calibration_keys.hpp"
#include "files/toml_writer.hpp"

#include <filesystem>
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

/// Writes KEY and KEY_se. Throws InputError where the value lies outside of what the parameter files allow: such a fit
/// is of data that are no machine's, and a file that cannot be read back is of no use.
void write_fitted(TomlWriter& toml, const FittedValue& fitted);

/// "a.csv, b.csv" for a TOML comment.
std::string list_of_files(const std::vector<std::filesystem::path>& files);

}  // namespace millforce::host
