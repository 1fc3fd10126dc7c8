// SPDX-License-Identifier: Apache-2.0
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "files/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace millforce::host {

namespace {

constexpr std::size_t longest_line = std::size_t{1} << 20U;

std::string_view trimmed(std::string_view text) {
    const auto is_space = [](char letter) { return letter == ' ' || letter == '\t'; };
    while (!text.empty() && is_space(text.front())) {
        text.remove_prefix(1);
    }
    while (!text.empty() && is_space(text.back())) {
        text.remove_suffix(1);
    }
    return text;
}

}  // namespace

CsvReader::CsvReader(const std::filesystem::path& file) {
    file_ = file.string();
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        throw InputError(fmt::format("{}: is a folder; expected a CSV file", file_));
    }
    in_.open(file, std::ios::binary);
    if (!in_) {
        throw InputError(fmt::format("{}: cannot be opened; expected a readable CSV file", file_));
    }
    bytes_ = std::filesystem::file_size(file, error);
    bytes_ = error ? 0 : bytes_;
    read_header();
}

double CsvReader::fraction_read() const {
    return bytes_ > 0 ? std::min(1.0, static_cast<double>(bytes_read_) / static_cast<double>(bytes_)) : 0.0;
}

void CsvReader::read_header() {
    do {
        if (!read_line()) {
            throw InputError(fmt::format("{}:1: the file is empty; expected a line of column names", file_));
        }
        if (line_number_ == 1 && line_.starts_with("\xEF\xBB\xBF")) {
            line_.erase(0, 3);
        }
        if (line_.starts_with('#')) {
            comments_.emplace_back(trimmed(std::string_view(line_).substr(1)));
            line_.clear();
        }
    } while (trimmed(line_).empty());
    split();
    while (cells_.size() > 1 && cells_.back().empty()) {
        drop_last_cell();
    }
    header_text_ = line_;
    names_ = cells_;
    const bool semicolons = names_.size() == 1 && names_[0].find(';') != std::string::npos;
    if (semicolons) {
        fail_line("the column names are separated by semicolons; expected commas (and a point in numbers)");
    }
    double ignored = 0.0;
    const std::string& first = names_[0];
    if (std::from_chars(first.data(), first.data() + first.size(), ignored).ptr == first.data() + first.size() &&
        !first.empty()) {
        fail_line(fmt::format("'{}' is a number; expected a line of column names", printable(first)));
    }
}

bool CsvReader::read_line() {
    line_.clear();
    std::streambuf* buffer = in_.rdbuf();
    bool any = false;
    for (int letter = buffer->sbumpc(); letter != std::char_traits<char>::eof(); letter = buffer->sbumpc()) {
        any = true;
        if (letter == '\n') {
            break;
        }
        if (letter == 0) {
            ++line_number_;
            fail_line("a NUL byte; expected text");
        }
        if (line_.size() >= longest_line) {
            ++line_number_;
            fail_line("more than 1 MiB without a line end; expected a CSV file");
        }
        line_ += static_cast<char>(letter);
    }
    if (!any) {
        return false;
    }
    ++line_number_;
    bytes_read_ += line_.size() + 1;
    if (line_.ends_with('\r')) {
        line_.pop_back();
    }
    return true;
}

void CsvReader::split() {
    std::size_t count = 0;
    std::size_t next = 0;
    bool more = true;
    while (more) {
        if (count == cells_.size()) {
            cells_.emplace_back();
        }
        std::string& cell = cells_[count++];
        cell.clear();
        const std::size_t start = line_.find_first_not_of(" \t", next);
        if (start != std::string::npos && line_[start] == '"') {
            std::size_t k = start + 1;
            while (k < line_.size() && (line_[k] != '"' || (k + 1 < line_.size() && line_[k + 1] == '"'))) {
                k += line_[k] == '"' ? 1U : 0U;
                cell += line_[k++];
            }
            if (k >= line_.size()) {
                fail_line(fmt::format("cell {}: a quote is opened and not closed on the same line", count));
            }
            next = line_.find(',', k);
            if (!trimmed(std::string_view(line_).substr(k + 1, std::min(next, line_.size()) - k - 1)).empty()) {
                fail_line(fmt::format("cell {}: text after a closing quote; expected a comma", count));
            }
        } else {
            const std::size_t end = line_.find(',', next);
            cell = trimmed(std::string_view(line_).substr(next, end == std::string::npos ? end : end - next));
            next = end;
        }
        more = next != std::string::npos;
        next = more ? next + 1 : next;
    }
    cells_.resize(count);
}

void CsvReader::drop_last_cell() {
    cells_.pop_back();
    line_.erase(line_.rfind(','));
}

bool CsvReader::next_row() {
    do {
        if (!read_line()) {
            return false;
        }
    } while (trimmed(line_).empty());
    split();
    // Spreadsheets leave empty cells behind the last column.
    while (cells_.size() > names_.size() && cells_.back().empty()) {
        drop_last_cell();
    }
    if (cells_.size() != names_.size()) {
        fail_line(fmt::format("{} cells; expected {}, as in the header{}", cells_.size(), names_.size(),
                              cells_.size() < names_.size() && in_.peek() == std::char_traits<char>::eof()
                                  ? " (the file seems to be cut off)"
                                  : ""));
    }
    return true;
}

double CsvReader::number(CsvColumn column) const {
    std::string_view cell = cells_[column.index];
    if (cell.empty()) {
        return no_estimate;
    }
    const std::string_view whole = cell;
    const bool signed_twice = cell.starts_with("+-");
    if (cell.starts_with('+')) {
        cell.remove_prefix(1);
    }
    double value = 0.0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error == std::errc::result_out_of_range && end == cell.data() + cell.size()) {
        value = std::strtod(std::string(cell).c_str(), nullptr);  // distinguishes underflow from overflow
    } else if (error != std::errc{} || end != cell.data() + cell.size() || signed_twice) {
        fail(column, fmt::format("'{}' is not a number; expected a number with a decimal point, or an empty cell",
                                 printable(whole)));
    }
    if (!std::isfinite(value)) {
        fail(column,
             fmt::format("'{}' is not finite; expected a finite number, or an empty cell for none", printable(whole)));
    }
    if (std::abs(value) > largest_number) {
        fail(column,
             fmt::format("'{}' is beyond anything measured; expected at most {:g}", printable(whole), largest_number));
    }
    return value;
}

std::string CsvReader::place_of_names() const {
    return fmt::format("{}:1", file_);
}

std::string CsvReader::place_of_row() const {
    return fmt::format("{}:{}", file_, line_number_);
}

std::string CsvReader::shown(CsvColumn column) const {
    return printable(cells_[column.index]);
}

void CsvReader::fail_line(std::string_view message) const {
    throw InputError(fmt::format("{}: {}", place_of_row(), message));
}

}  // namespace millforce::host
