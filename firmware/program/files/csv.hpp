// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace millforce::host {

/// A column that has been found in a CSV file; given to CsvReader::number().
struct CsvColumn {
    std::size_t index = 0;
};

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
class CsvReader {
  public:
    explicit CsvReader(const std::filesystem::path& file);

    const std::vector<std::string>& column_names() const { return names_; }
    const std::string& header_text() const { return header_text_; }
    const std::string& file_name() const { return file_; }
    /// The comments, without # and the spaces around.
    const std::vector<std::string>& comments() const { return comments_; }

    /// The column of this name, or InputError. `reason` ends the message: why it is needed.
    CsvColumn require(std::string_view name, std::string_view reason = {}) const;

    /// The column of this name, if there is one. Named twice: InputError.
    std::optional<CsvColumn> find(std::string_view name) const;

    /// Advances to the next row; false at the end of the file.
    bool next_row();

    /// The number in this column of the current row; NaN where the cell is empty.
    double number(CsvColumn column) const;

    /// The same for a column that may be missing: NaN.
    double number(std::optional<CsvColumn> column) const;

    /// The number in this column, or InputError where the cell is empty.
    double required_number(CsvColumn column) const;

    /// As required_number, and within [low, high].
    double required_number(CsvColumn column, double low, double high) const;

    /// The cell's text, unquoted and trimmed.
    std::string_view text(CsvColumn column) const { return cells_[column.index]; }

    /// The current row as in the file, without its line end and surplus commas.
    const std::string& row_text() const { return line_; }

    std::size_t line_number() const { return line_number_; }

    /// Share of the file that has been read, 0…1: for a progress display.
    double fraction_read() const;

    /// Throws InputError "FILE:LINE: column 'NAME': MESSAGE" about the current row.
    [[noreturn]] void fail(CsvColumn column, std::string_view message) const;

  private:
    [[noreturn]] void fail_line(std::string_view message) const;
    bool read_line();
    void split();
    void drop_last_cell();
    void read_header();

    std::string file_;
    std::ifstream in_;
    std::vector<std::string> names_;
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

inline constexpr double no_estimate = std::numeric_limits<double>::quiet_NaN();

}  // namespace millforce::host
