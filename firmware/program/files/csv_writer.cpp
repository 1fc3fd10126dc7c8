// SPDX-License-Identifier: Apache-2.0
#include "files/csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <stdexcept>

namespace millforce::host {

std::string CsvWriter::cell(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

std::string CsvWriter::cell(float value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

CsvWriter::CsvWriter(std::ostream& out, std::span<const std::string_view> column_names)
    : out_(out), columns_(column_names.size()) {
    for (std::size_t k = 0; k < columns_; ++k) {
        out_ << (k > 0 ? "," : "") << column_names[k];
    }
    out_ << '\n';
}

void CsvWriter::row(std::span<const double> values) {
    if (values.size() != columns_) {
        throw std::logic_error(fmt::format("CsvWriter: {} values for {} columns", values.size(), columns_));
    }
    text_.clear();
    for (std::size_t k = 0; k < columns_; ++k) {
        if (k > 0) {
            text_ += ',';
        }
        if (std::isfinite(values[k])) {
            fmt::format_to(std::back_inserter(text_), "{}", values[k]);
        }
    }
    text_ += '\n';
    out_ << text_;
}

}  // namespace millforce::host
