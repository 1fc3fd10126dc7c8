// SPDX-License-Identifier: Apache-2.0
#include "files/results_folder.hpp"

#include <fmt/format.h>

#include <system_error>

#include "files/atomic_file.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

std::filesystem::path results_folder(const std::string& name, const std::string& first_file) {
    std::filesystem::path folder(name);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw InputError(fmt::format("{}: cannot create the folder: {}", name, error.message()));
    }
    const AtomicFile can_be_written(folder / first_file);
    return folder;
}

}  // namespace millforce::host
