// SPDX-License-Identifier: Apache-2.0
#include "module/array_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "files/csv.hpp"

namespace millforce::python {

ArrayTable::ArrayTable(std::vector<std::string> names) {
    file_ = "samples";
    names_ = std::move(names);
}

void ArrayTable::fill(std::vector<const double*> columns, std::size_t rows) {
    rows_before_ += read_;
    columns_ = std::move(columns);
    rows_ = rows;
    read_ = 0;
}

bool ArrayTable::next_row() {
    if (read_ == rows_) {
        return false;
    }
    ++read_;
    return true;
}

double ArrayTable::number(host::CsvColumn column) const {
    const double value = columns_[column.index][read_ - 1];
    if (std::isinf(value) || std::abs(value) > host::largest_number) {
        fail(column, fmt::format("{} is beyond anything measured; expected a finite number, or NaN for none", value));
    }
    return value;
}

double ArrayTable::fraction_read() const {
    return rows_ > 0 ? static_cast<double>(read_) / static_cast<double>(rows_) : 1.0;
}

std::string ArrayTable::place_of_row() const {
    return fmt::format("{}: row {}", file_, rows_before_ + read_ - 1);
}

std::string ArrayTable::shown(host::CsvColumn column) const {
    return fmt::format("{}", columns_[column.index][read_ - 1]);
}

}  // namespace millforce::python
