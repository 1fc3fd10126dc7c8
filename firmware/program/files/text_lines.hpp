// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace millforce::host {

/// The lines of a text file of any size: one is held in memory. A byte order mark of UTF-8 and CRLF are taken.
///
/// InputError "FILE:LINE: …": a file that cannot be read, UTF-16 (Excel's "Unicode text"), a NUL byte, a line of more
/// than 1 MiB.
class TextLines {
  public:
    explicit TextLines(const std::string& file);

    /// Advances; false at the end.
    bool next();
    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] std::size_t number() const { return number_; }
    /// This line is the last one, and has no line end: it may be cut off.
    [[nodiscard]] bool has_no_end() const { return has_no_end_; }

    [[nodiscard]] const std::string& file() const { return file_; }
    /// "FILE:LINE"
    [[nodiscard]] std::string place() const;
    /// Share of the file that has been read, 0…1.
    [[nodiscard]] double fraction_read() const;
    [[noreturn]] void fail(std::string_view message) const;

  private:
    std::string file_;
    std::ifstream in_;
    std::string text_;
    std::size_t number_ = 0;
    bool has_no_end_ = false;
    std::uintmax_t bytes_read_ = 0;
    std::uintmax_t bytes_ = 0;
};

/// Opens a file to read. InputError where it is a folder or cannot be opened.
[[nodiscard]] std::ifstream open_to_read(const std::string& file);

}  // namespace millforce::host
