// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "files/number_table.hpp"

namespace millforce::python {

/// Arrays in memory as a table. Rows count on from one filling to the next.
class ArrayTable : public host::NumberTable {
  public:
    explicit ArrayTable(std::vector<std::string> names);

    /// In the order of the names, each with `rows` numbers, which must stay until they are read.
    void fill(std::vector<const double*> columns, std::size_t rows);

    bool next_row() override;
    using NumberTable::number;
    /// Infinity is refused, as in a file.
    double number(host::CsvColumn column) const override;
    double fraction_read() const override;

  protected:
    std::string place_of_names() const override { return file_; }
    std::string place_of_row() const override;
    std::string shown(host::CsvColumn column) const override;

  private:
    std::vector<const double*> columns_;
    std::size_t rows_ = 0;
    std::size_t read_ = 0;  ///< rows of this filling; the current one is the last of them
    std::size_t rows_before_ = 0;
};

}  // namespace millforce::python
