// SPDX-License-Identifier: Apache-2.0
#include "calibration/duplicate_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace millforce::host {

bool DuplicateRows::is_copy(const CsvReader& csv) {
    const bool is_new = seen_.insert(csv.header_text() + '\n' + csv.row_text()).second;
    if (!is_new) {
        places_.push_back(row_place(csv));
    }
    return !is_new;
}

void DuplicateRows::report(std::ostream& out) const {
    if (!places_.empty()) {
        out << fmt::format("{} an earlier row exactly and {} not counted again: {}\n",
                           places_.size() == 1 ? "1 row repeats" : fmt::format("{} rows repeat", places_.size()),
                           places_.size() == 1 ? "is" : "are", list_of_places(places_));
    }
}

std::string row_place(const CsvReader& csv) {
    return fmt::format("{}:{}", std::filesystem::path(csv.file_name()).filename().string(), csv.line_number());
}

std::string list_of_places(const std::vector<std::string>& places) {
    constexpr std::size_t most = 10;
    const std::size_t listed = std::min(places.size(), most);
    std::string text =
        fmt::format("{}", fmt::join(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(listed), ", "));
    return places.size() > most ? fmt::format("{} and {} more", text, places.size() - most) : text;
}

}  // namespace millforce::host
