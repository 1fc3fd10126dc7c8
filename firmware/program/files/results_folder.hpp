// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace millforce::host {

/// The folder for the results, created if it is missing. If it cannot be created, or `first_file` cannot be written in
/// it, this fails now (InputError) and not after a long run.
std::filesystem::path results_folder(const std::string& name, const std::string& first_file);

}  // namespace millforce::host
