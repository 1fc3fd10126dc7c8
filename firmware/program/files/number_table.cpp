// SPDX-License-Identifier: Apache-2.0
#include "files/number_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/input_error.hpp"
#include "files/nearest_name.hpp"
#include "files/printable.hpp"

namespace millforce::host {

std::optional<CsvColumn> NumberTable::find(std::string_view name) const {
    const auto first = std::find(names_.begin(), names_.end(), name);
    if (first == names_.end()) {
        return std::nullopt;
    }
    if (std::find(first + 1, names_.end(), name) != names_.end()) {
        fail_names(fmt::format("column '{}' stands there twice; expected once", name));
    }
    return CsvColumn{static_cast<std::size_t>(first - names_.begin())};
}

CsvColumn NumberTable::require(std::string_view name, std::string_view reason) const {
    if (const auto column = find(name)) {
        return *column;
    }
    const std::string nearest = nearest_name(name, names_);
    const std::string hint = nearest.empty() ? fmt::format("found only: {}", name_list(names_))
                                             : fmt::format("the nearest is '{}'", printable(nearest));
    fail_names(fmt::format("no column '{}'{}{}; {}", name, reason.empty() ? "" : ", ", reason, hint));
}

double NumberTable::number(std::optional<CsvColumn> column) const {
    return column ? number(*column) : no_estimate;
}

double NumberTable::required_number(CsvColumn column) const {
    const double value = number(column);
    if (std::isnan(value)) {
        fail(column, "the cell is empty; expected a number");
    }
    return value;
}

double NumberTable::required_number(CsvColumn column, double low, double high) const {
    const double value = required_number(column);
    if (!(value >= low && value <= high)) {
        fail(column, fmt::format("'{}' is out of range; expected {} to {}", shown(column), low, high));
    }
    return value;
}

void NumberTable::fail_names(std::string_view message) const {
    throw InputError(fmt::format("{}: {}", place_of_names(), message));
}

void NumberTable::fail(CsvColumn column, std::string_view message) const {
    throw InputError(fmt::format("{}: column '{}': {}", place_of_row(), printable(names_[column.index]), message));
}

}  // namespace millforce::host
