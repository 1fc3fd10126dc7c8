// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Small work on the text of files that other programs have written.

namespace millforce::host {

/// Without spaces and tabs at both ends.
[[nodiscard]] std::string_view without_spaces(std::string_view text);

/// The separator ' ' stands for any number of spaces and tabs.
inline constexpr char any_space = ' ';

/// Splits a line into cells without the spaces around them. A cell may be quoted; "" within is a quote. False where a
/// quote is not closed, or text follows a closing one. The strings of `cells` are reused: no allocation per line.
[[nodiscard]] bool split_cells(std::string_view line, char separator, std::vector<std::string>& cells);

/// A number out of a text.
struct CellNumber {
    double value = 0.0;          ///< NaN: the cell says that there is none
    std::string_view problem{};  ///< empty where the value counts, else what was expected
};

/// Reads numbers with a decimal point or a decimal comma. A file has one of them: the other one after it could be a
/// thousands separator, and is a problem. Empty cells and "nan", "n/a", "null", "-" are none. Infinity is a problem.
class NumberReader {
  public:
    [[nodiscard]] CellNumber read(std::string_view cell);
    /// '.' or ',' once a number had one; else '\0'.
    [[nodiscard]] char decimal_mark() const { return mark_; }

  private:
    char mark_ = '\0';
};

}  // namespace millforce::host
