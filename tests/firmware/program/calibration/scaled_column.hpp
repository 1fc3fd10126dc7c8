// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>

/// Tables as they are when a column was recorded in another unit.

namespace millforce::test {

inline std::string text_of_file(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The table with each number of the column times the factor; empty cells stay empty.
inline std::string scaled(const std::string& table, std::string_view column, double factor) {
    std::istringstream lines(table);
    std::ostringstream result;
    std::string line;
    std::size_t place = std::string::npos;
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        std::string cell;
        const bool is_header = place == std::string::npos;
        for (std::size_t k = 0; std::getline(cells, cell, ','); ++k) {
            place = is_header && cell == column ? k : place;
            const bool is_scaled = !is_header && k == place && !cell.empty();
            result << (k > 0 ? "," : "")
                   << (is_scaled ? fmt::format("{:.12g}", factor * std::strtod(cell.c_str(), nullptr)) : cell);
        }
        result << (line.ends_with(',') ? ",\n" : "\n");
    }
    return result.str();
}

}  // namespace millforce::test
