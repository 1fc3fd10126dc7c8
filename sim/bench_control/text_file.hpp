// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "files/atomic_file.hpp"

namespace millforce::sim {

/// The whole text, or the file as it was. Throws InputError.
inline void write_text_file(const std::filesystem::path& path, std::string_view text) {
    host::AtomicFile file(path);
    file.stream().write(text.data(), static_cast<std::streamsize>(text.size()));
    file.commit();
}

}  // namespace millforce::sim
