// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace millforce::host {

inline constexpr double no_estimate = std::numeric_limits<double>::quiet_NaN();

/// A column that has been found in a table; given to NumberTable::number().
struct CsvColumn {
    std::size_t index = 0;
};

/// Named columns of numbers, read row by row, wherever they come from: a CSV file (CsvReader), or arrays in memory. A
/// missing number is NaN. Errors are InputError with the place of the row.
class NumberTable {
  public:
    virtual ~NumberTable() = default;

    const std::vector<std::string>& column_names() const { return names_; }
    /// What the table is called in messages: the file's name.
    const std::string& file_name() const { return file_; }

    /// The column of this name, or InputError. `reason` ends the message: why it is needed.
    CsvColumn require(std::string_view name, std::string_view reason = {}) const;

    /// The column of this name, if there is one. Named twice: InputError.
    std::optional<CsvColumn> find(std::string_view name) const;

    /// Advances to the next row; false at the end of the table.
    virtual bool next_row() = 0;

    /// The number in this column of the current row; NaN where there is none.
    virtual double number(CsvColumn column) const = 0;

    /// The same for a column that may be missing: NaN.
    double number(std::optional<CsvColumn> column) const;

    /// The number in this column, or InputError where there is none.
    double required_number(CsvColumn column) const;

    /// As required_number, and within [low, high].
    double required_number(CsvColumn column, double low, double high) const;

    /// Share of the table that has been read, 0…1: for a progress display.
    virtual double fraction_read() const = 0;

    /// Throws InputError "FILE:1: MESSAGE" about the names of the columns.
    [[noreturn]] void fail_names(std::string_view message) const;
    /// Throws InputError "FILE:LINE: column 'NAME': MESSAGE" about the current row.
    [[noreturn]] void fail(CsvColumn column, std::string_view message) const;

  protected:
    NumberTable() = default;
    NumberTable(const NumberTable&) = default;
    NumberTable(NumberTable&&) = default;
    NumberTable& operator=(const NumberTable&) = default;
    NumberTable& operator=(NumberTable&&) = default;

    /// "FILE:1" and "FILE:LINE", for messages about the names and about the current row.
    virtual std::string place_of_names() const = 0;
    virtual std::string place_of_row() const = 0;
    /// The value as it was given, for messages.
    virtual std::string shown(CsvColumn column) const = 0;

    std::string file_;
    std::vector<std::string> names_;
};

}  // namespace millforce::host
