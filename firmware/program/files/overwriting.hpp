// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace millforce::host {

/// InputError where the output is one of the inputs, by whatever name or link, or a *.toml in an input that is a folder
/// (of tools).
void refuse_overwriting(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs);

}  // namespace millforce::host
