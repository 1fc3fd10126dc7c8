// SPDX-License-Identifier: Apache-2.0
#include "import/text_cells.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

namespace millforce::host {

namespace {

bool is_blank(char letter) {
    return letter == ' ' || letter == '\t';
}

/// The end of the quoted cell that begins at `place`: where its closing quote is, or npos.
std::size_t unquoted(std::string_view line, std::size_t place, std::string& cell) {
    for (std::size_t k = place + 1; k < line.size(); ++k) {
        if (line[k] == '"') {
            const bool is_doubled = k + 1 < line.size() && line[k + 1] == '"';
            if (!is_doubled) {
                return k;
            }
            ++k;
        }
        cell += line[k];
    }
    return std::string_view::npos;
}

std::size_t next_separator(std::string_view line, char separator, std::size_t from) {
    return separator == any_space ? line.find_first_of(" \t", from) : line.find(separator, from);
}

bool says_none(std::string_view cell) {
    constexpr std::array<std::string_view, 7> words{"nan", "n/a", "na", "null", "none", "-", "--"};
    std::string lower(cell.substr(0, 5));
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return cell.size() <= 4 && std::find(words.begin(), words.end(), lower) != words.end();
}

}  // namespace

std::string_view without_spaces(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) {
        text.remove_prefix(1);
    }
    while (!text.empty() && is_blank(text.back())) {
        text.remove_suffix(1);
    }
    return text;
}

bool split_cells(std::string_view line, char separator, std::vector<std::string>& cells) {
    if (separator == any_space) {
        line = without_spaces(line);
    }
    std::size_t count = 0;
    for (std::size_t next = 0; next != std::string_view::npos;) {
        while (next < line.size() && is_blank(line[next]) &&
               line[next] != (separator == any_space ? '\0' : separator)) {
            ++next;
        }
        if (count == cells.size()) {
            cells.emplace_back();
        }
        std::string& cell = cells[count++];
        cell.clear();
        std::size_t end = 0;
        if (next < line.size() && line[next] == '"') {
            const std::size_t closing = unquoted(line, next, cell);
            if (closing == std::string_view::npos) {
                return false;
            }
            end = next_separator(line, separator, closing + 1);
            if (!without_spaces(line.substr(closing + 1, end == std::string_view::npos ? end : end - closing - 1))
                     .empty()) {
                return false;
            }
        } else {
            end = next_separator(line, separator, next);
            cell = without_spaces(line.substr(next, end == std::string_view::npos ? end : end - next));
        }
        next = end == std::string_view::npos ? end : end + 1;
    }
    cells.resize(count);
    return true;
}

CellNumber NumberReader::read(std::string_view cell) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    constexpr std::string_view no_number = "expected a number";
    constexpr std::size_t longest_number = 400;  // a double in full, with leading zeros
    if (cell.empty() || says_none(cell)) {
        return {none, {}};
    }
    if (cell.size() > longest_number) {
        return {none, no_number};
    }
    std::array<char, longest_number> digits{};
    std::copy(cell.begin(), cell.end(), digits.begin());
    const std::size_t comma = cell.find(',');
    const char mark = comma != std::string_view::npos ? ',' : cell.find('.') != std::string_view::npos ? '.' : '\0';
    if (comma != std::string_view::npos) {
        digits[comma] = '.';
    }
    const char* begin = digits.data() + (cell.front() == '+' && cell.size() > 1 && cell[1] != '-' ? 1 : 0);
    const char* end = digits.data() + cell.size();
    double value = 0.0;
    const auto [rest, error] = std::from_chars(begin, end, value);
    const bool has_both = comma != std::string_view::npos && cell.find('.') != std::string_view::npos;
    if (has_both || (mark != '\0' && mark_ != '\0' && mark != mark_)) {
        return {none, "expected one decimal mark in the whole file, and no thousands separators"};
    }
    if (error != std::errc{} || rest != end || !std::isfinite(value)) {
        return {none, no_number};
    }
    mark_ = mark != '\0' ? mark : mark_;
    return {value, {}};
}

}  // namespace millforce::host
