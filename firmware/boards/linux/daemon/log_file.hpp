// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace millforce::host {

/// A file that grows by whole lines while others may rename or empty it, and the disk may be full. What cannot be
/// written is dropped and counted; the file then ends with its last whole line. One thread.
class LogFile {
  public:
    /// `missing`: the line that stands for n dropped lines, with "{}" for n. Empties the file, or creates it. Throws
    /// InputError: it cannot be written, or a running program writes it.
    LogFile(std::string name, std::string missing);
    ~LogFile();
    LogFile(const LogFile&) = delete;
    LogFile& operator=(const LogFile&) = delete;

    /// Keeps a line, with its end, for the next flush().
    void add(std::string_view line) { lines_ += line; }
    /// Writes what was added; what the file does not take is dropped. Returns 0 or the errno.
    int flush();
    /// Opens the file again by its name, which may be a new file now. Where that fails the old one stays. Returns 0 or
    /// the errno.
    int reopen();

    [[nodiscard]] const std::string& name() const { return name_; }
    /// How often flush() could not write all.
    [[nodiscard]] std::uint64_t failures() const { return failures_; }

  private:
    [[nodiscard]] std::string missing_line() const;
    [[nodiscard]] std::size_t write(std::string_view text, int& error) const;
    void cut_off(std::size_t bytes) const;

    std::string name_;
    std::string missing_;
    int descriptor_;
    std::string lines_{};
    std::uint64_t lost_ = 0;
    std::uint64_t reported_lost_ = 0;
    std::uint64_t failures_ = 0;
};

}  // namespace millforce::host
