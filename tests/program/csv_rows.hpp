// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace millforce::test {

using CsvRow = std::map<std::string, std::string>;

inline std::vector<std::string> csv_cells(const std::string& line) {
    std::vector<std::string> result{""};
    for (const char letter : line) {
        if (letter == ',') {
            result.emplace_back();
        } else {
            result.back() += letter;
        }
    }
    return result;
}

inline std::vector<CsvRow> csv_rows(const std::string& csv) {
    std::istringstream text(csv);
    std::string line;
    std::getline(text, line);
    const std::vector<std::string> names = csv_cells(line);
    std::vector<CsvRow> rows;
    while (std::getline(text, line)) {
        const std::vector<std::string> values = csv_cells(line);
        CsvRow row;
        for (std::size_t k = 0; k < names.size(); ++k) {
            row[names[k]] = values.at(k);
        }
        rows.push_back(row);
    }
    return rows;
}

/// The header and the first of every n rows.
inline std::string every_nth_row(const std::string& csv, int n) {
    std::istringstream text(csv);
    std::ostringstream kept;
    std::string line;
    std::getline(text, line);
    kept << line << '\n';
    for (int k = 0; std::getline(text, line); ++k) {
        if (k % n == 0) {
            kept << line << '\n';
        }
    }
    return kept.str();
}

}  // namespace millforce::test
