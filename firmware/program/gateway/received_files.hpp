// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <string_view>

namespace millforce::host {

/// Files for a folder that come from elsewhere, and may hold anything: a file is written, whole, only after the
/// program's own reader has taken it. None is ever removed.
class ReceivedFiles {
  public:
    struct Kind {
        std::string_view ending;  ///< of names, e.g. ".toml"
        std::size_t most_bytes;
        /// Read together with what is in the folder: two files may contradict each other.
        bool with_others;
        /// Throws InputError where the file is not sound.
        std::function<void(const std::filesystem::path&)> read;
    };

    ReceivedFiles(std::filesystem::path folder, Kind kind);

    /// `is_own`: for this machine alone; it then holds against one for all. The reason why it is refused; empty: it is
    /// in the folder.
    [[nodiscard]] std::string receive(const std::string& name, std::string_view content, bool is_own);

  private:
    [[nodiscard]] std::string fault_of(const std::string& name, std::string_view content) const;
    [[nodiscard]] bool is_there(const std::string& name, std::string_view content) const;

    std::filesystem::path folder_;
    Kind kind_;
    std::set<std::string> own_{};
};

/// `T<number>.toml`, as --tools reads them.
[[nodiscard]] ReceivedFiles::Kind tool_files();
[[nodiscard]] ReceivedFiles::Kind map_files();

}  // namespace millforce::host
