// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace millforce::host {

/// The folder for the results, made where it is missing. That it cannot be made, or `first_file` not be written in it,
/// is told now (InputError), and not after a long run.
std::filesystem::path results_folder(const std::string& name, const std::string& first_file);

}  // namespace millforce::host
