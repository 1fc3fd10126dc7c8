// SPDX-License-Identifier: Apache-2.0
#include "files/overwriting.hpp"

#include "files/input_error.hpp"

#include <fmt/format.h>

namespace millforce::host {

void refuse_overwriting(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs) {
    const auto is = [](const std::filesystem::path& one, const std::filesystem::path& other) {
        std::error_code error;
        return std::filesystem::equivalent(one, other, error);
    };
    std::error_code none;
    if (output.empty() || std::filesystem::is_directory(output, none)) {
        return;
    }
    const std::filesystem::path folder = std::filesystem::absolute(output).parent_path();
    for (const std::filesystem::path& input : inputs) {
        const bool is_in_input = output.extension() == ".toml" && is(folder, input);
        if (is(output, input) || is_in_input) {
            throw InputError(
                fmt::format("{}: is read and would be overwritten; expected another file to write", output.string()));
        }
    }
}

}  // namespace millforce::host
