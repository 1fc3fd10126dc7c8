// SPDX-License-Identifier: Apache-2.0
#include "files/overwriting.hpp"

#include "files/input_error.hpp"

#include <fmt/format.h>

namespace millforce::host {

void refuse_overwriting(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs) {
    for (const std::filesystem::path& input : inputs) {
        std::error_code error;
        if (!output.empty() && std::filesystem::equivalent(output, input, error)) {
            throw InputError(
                fmt::format("{}: is read and would be overwritten; expected another file to write", output.string()));
        }
    }
}

}  // namespace millforce::host
