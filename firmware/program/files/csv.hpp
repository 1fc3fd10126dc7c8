// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/number_table.hpp"

namespace millforce::host {

/// Reads a CSV file of numbers, one row at a time.
///
/// Lines that begin with # before all others are comments. The next line names the columns; they may be in any order,
/// and columns that are not used may hold anything. Cells are separated by commas, may be quoted ("" is a quote), and
/// spaces around them do not count. An empty cell is "none": NaN. A byte order mark and CRLF line ends are taken. Empty
/// lines are skipped.
///
/// Everything else is an InputError "FILE:LINE: …": a file that cannot be opened, no header, a column missing (with the
/// nearest existing name), named twice, a row with another number of cells than the header, text, nan, inf or a number
/// beyond double in a column that is read, an open quote, a line of more than 1 MiB, a NUL byte.
///
/// One line is held in memory, whatever the size of the file.
class CsvReader : public NumberTable {
  public:
    explicit CsvReader(const std::filesystem::path& file);

    const std::string& header_text() const { return header_text_; }
    /// The comments, without # and the spaces around.
    const std::vector<std::string>& comments() const { return comments_; }

    bool next_row() override;
    using NumberTable::number;
    double number(CsvColumn column) const override;

    /// The cell's text, unquoted and trimmed.
    std::string_view text(CsvColumn column) const { return cells_[column.index]; }

    /// The current row as in the file, without its line end and surplus commas.
    const std::string& row_text() const { return line_; }

    std::size_t line_number() const { return line_number_; }

    double fraction_read() const override;

  protected:
    std::string place_of_names() const override;
    std::string place_of_row() const override;
    std::string shown(CsvColumn column) const override;

  private:
    [[noreturn]] void fail_line(std::string_view message) const;
    bool read_line();
    void split();
    void drop_last_cell();
    void read_header();

    std::ifstream in_;
    std::string header_text_;
    std::vector<std::string> comments_;
    std::string line_;
    std::vector<std::string> cells_;
    std::size_t line_number_ = 0;
    std::uintmax_t bytes_read_ = 0;
    std::uintmax_t bytes_ = 0;
};

/// Writes a CSV file of numbers: the shortest text that reads back as the same number, and an empty cell for NaN
/// ("no estimate") and infinity. Line ends are LF.
class CsvWriter {
  public:
    CsvWriter(std::ostream& out, std::span<const std::string_view> column_names);

    /// One row; as many values as there are columns.
    void row(std::span<const double> values);

    /// The cell for a number: the shortest text that reads back as the same double, or float.
    static std::string cell(double value);
    static std::string cell(float value);

  private:
    std::ostream& out_;
    std::size_t columns_;
    std::string text_;
};

/// Beyond it a number is no measurement, and CsvReader refuses it: far more than a time since 1970 in nanoseconds.
inline constexpr double largest_number = 1e18;
}  // namespace millforce::host
