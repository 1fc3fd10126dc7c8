// SPDX-License-Identifier: Apache-2.0
#include "gateway/received_files.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <utility>

#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/tool_set.hpp"
#include "part_map/part_map_file.hpp"

namespace millforce::host {

namespace {

constexpr std::string_view letters_of_names = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";

bool is_plain_name(const std::string& name, std::string_view ending) {
    return name.size() > ending.size() && name.size() <= 64 && name.front() != '.' && name.ends_with(ending) &&
           name.find_first_not_of(letters_of_names) == std::string::npos;
}

/// A folder of its own for one file under its own name, and copies of others; gone afterwards.
class Trial {
  public:
    Trial(const std::string& name, std::string_view content, const std::filesystem::path& others,
          std::string_view ending) {
        std::string pattern = (std::filesystem::temp_directory_path() / "millforce-gateway-XXXXXX").string();
        if (::mkdtemp(pattern.data()) == nullptr) {
            throw InputError("no temporary folder");
        }
        folder_ = pattern;
        std::error_code error;
        for (const auto& entry : std::filesystem::directory_iterator(others, error)) {
            if (entry.path().filename().string().ends_with(ending)) {
                std::filesystem::copy_file(entry.path(), file(entry.path().filename().string()), error);
            }
        }
        std::ofstream(file(name), std::ios::binary) << content;
    }
    ~Trial() {
        std::error_code error;
        std::filesystem::remove_all(folder_, error);
    }
    Trial(const Trial&) = delete;
    Trial& operator=(const Trial&) = delete;

    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }
    /// A message without the folder's name.
    [[nodiscard]] std::string plain(std::string text) const {
        const std::string prefix = folder_.string() + "/";
        for (std::size_t place = text.find(prefix); place != std::string::npos; place = text.find(prefix)) {
            text.erase(place, prefix.size());
        }
        return text;
    }

  private:
    std::filesystem::path folder_;
};

}  // namespace

ReceivedFiles::Kind tool_files() {
    constexpr std::size_t most_bytes = std::size_t{64} * 1024;
    return {".toml", most_bytes, true, [](const std::filesystem::path& file) {
                (void)read_tool_folder(file.parent_path());  // the names, too
            }};
}

ReceivedFiles::Kind map_files() {
    constexpr std::size_t most_bytes = std::size_t{16} * 1024 * 1024;
    return {".map", most_bytes, false, [](const std::filesystem::path& file) { (void)read_part_map(file); }};
}

ReceivedFiles::ReceivedFiles(std::filesystem::path folder, Kind kind)
    : folder_(std::move(folder)), kind_(std::move(kind)) {}

bool ReceivedFiles::is_there(const std::string& name, std::string_view content) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
    return text.str() == content;
}

std::string ReceivedFiles::fault_of(const std::string& name, std::string_view content) const {
    if (!is_plain_name(name, kind_.ending)) {
        return fmt::format("'{}': expected a name of letters_of_names, digits, '-', '_' and '.' that ends with {}",
                           printable(name), kind_.ending);
    }
    if (content.size() > kind_.most_bytes) {
        return fmt::format("{}: {} bytes, expected at most {}", name, content.size(), kind_.most_bytes);
    }
    const Trial trial(name, content, kind_.with_others ? folder_ : std::filesystem::path(), kind_.ending);
    try {
        kind_.read(trial.file(name));
    } catch (const InputError& error) {
        return without_controls(trial.plain(error.what()));
    }
    return {};
}

std::string ReceivedFiles::receive(const std::string& name, std::string_view content, bool is_own) {
    try {
        if (std::string fault = fault_of(name, content); !fault.empty()) {
            return fault;
        }
        if (!is_own && own_.contains(name)) {
            return fmt::format("{}: this machine has one of its own", name);
        }
        if (is_own) {
            own_.insert(name);
        }
        if (!is_there(name, content)) {
            AtomicFile file(folder_ / name);
            file.stream().write(content.data(), static_cast<std::streamsize>(content.size()));
            file.commit();
        }
    } catch (const std::exception& error) {  // of the file system, too: C code calls this
        return without_controls(error.what());
    }
    return {};
}

}  // namespace millforce::host
