// SPDX-License-Identifier: Apache-2.0
#include "files/text_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "files/input_error.hpp"

namespace millforce::host {

std::ifstream open_to_read(const std::string& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        throw InputError(fmt::format("{}: is a folder; expected a file", file));
    }
    if (!std::filesystem::exists(file, error)) {
        throw InputError(fmt::format("{}: no such file", file));
    }
    std::ifstream in(file, std::ios::binary);
    if (!in) {
        throw InputError(fmt::format("{}: cannot be opened; expected a readable file", file));
    }
    return in;
}

TextLines::TextLines(const std::string& file) : file_(file), in_(open_to_read(file)) {
    std::error_code error;
    bytes_ = std::filesystem::file_size(file, error);
    bytes_ = error ? 0 : bytes_;
}

bool TextLines::next() {
    constexpr std::size_t longest_line = std::size_t{1} << 20U;
    constexpr int end_of_file = std::char_traits<char>::eof();
    text_.clear();
    std::streambuf* buffer = in_.rdbuf();
    int letter = buffer->sbumpc();
    if (letter == end_of_file) {
        return false;
    }
    ++number_;
    for (; letter != end_of_file && letter != '\n'; letter = buffer->sbumpc()) {
        if (letter == 0) {
            fail("a NUL byte; expected text in UTF-8 (not UTF-16)");
        }
        if (text_.size() >= longest_line) {
            fail("more than 1 MiB without a line end; expected a text file");
        }
        text_ += static_cast<char>(letter);
    }
    has_no_end_ = letter == end_of_file;
    bytes_read_ += text_.size() + 1;
    if (number_ == 1 && text_.starts_with("\xEF\xBB\xBF")) {
        text_.erase(0, 3);
    }
    if (text_.ends_with('\r')) {
        text_.pop_back();
    }
    return true;
}

std::string TextLines::place() const {
    return fmt::format("{}:{}", file_, number_);
}

double TextLines::fraction_read() const {
    return bytes_ > 0 ? std::min(1.0, static_cast<double>(bytes_read_) / static_cast<double>(bytes_)) : 0.0;
}

void TextLines::fail(std::string_view message) const {
    throw InputError(fmt::format("{}: {}", place(), message));
}

}  // namespace millforce::host
