// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "files/text_lines.hpp"
#include "import/source_reader.hpp"
#include "import/text_cells.hpp"

namespace millforce::host {

enum class TableNames : std::uint8_t {
    whole,
    end_of_path,  ///< "vel_estimate" is the column "odrv0.axis0.encoder.vel_estimate", if no other ends so
};

/// A table in a text file, as oscilloscopes, drives and scripts write it.
///
/// The line of column names is the first one that has all names asked for; before it, and up to the first row of
/// numbers (units, say), anything may stand. It may begin with "#". Where all columns are asked for by number, the
/// first line with numbers in them is the first row. The separator is that of this line: tab, semicolon or comma.
/// Numbers have a decimal point or a decimal comma. Lines that begin with "#", "%" or "//" are comments, and empty
/// lines do not count.
///
/// Every row has as many cells as the first line; a last line without line end that has fewer is cut off, and left out.
class TableSource final : public SourceReader {
  public:
    TableSource(const std::string& file, const std::vector<SourceName>& sources, TableNames names);

    [[nodiscard]] bool next() override;
    [[nodiscard]] std::string place() const override { return lines_.place(); }
    [[nodiscard]] double fraction_read() const override { return lines_.fraction_read(); }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] std::vector<std::string> notes() const override;
    [[nodiscard]] std::vector<std::string> names() const override { return column_names_; }
    [[nodiscard]] bool has(std::size_t k) const override { return columns_[k] != no_column; }

  private:
    static constexpr std::size_t no_column = static_cast<std::size_t>(-1);

    void find_first_line();
    bool takes_as_names(const std::vector<std::string>& cells);
    bool takes_as_row(const std::vector<std::string>& cells);
    void remember_nearest(const std::vector<std::string>& cells, std::size_t found);
    [[noreturn]] void fail_without_names() const;
    [[nodiscard]] std::vector<std::size_t> columns_named(const std::vector<std::string>& cells,
                                                         const SourceName& source) const;
    [[nodiscard]] bool is_comment() const;
    [[nodiscard]] bool split_row();
    bool read_row();
    [[nodiscard]] std::string column_shown(std::size_t k) const;

    TextLines lines_;
    std::vector<SourceName> sources_;
    TableNames naming_;
    NumberReader numbers_;
    char separator_ = ',';
    std::vector<std::string> column_names_;
    std::vector<std::size_t> columns_;  ///< one for each source
    std::vector<std::string> cells_;
    std::size_t width_ = 0;
    std::size_t first_line_ = 0;
    bool has_names_ = false;
    bool row_is_waiting_ = false;  ///< the first line is a row already
    bool has_row_ = false;
    std::uint64_t comments_ = 0;
    std::uint64_t before_first_row_ = 0;
    std::uint64_t cut_off_ = 0;
    struct {
        std::vector<std::string> cells;
        std::size_t line = 0;
        std::size_t found = 0;
    } nearest_;
};

}  // namespace millforce::host
