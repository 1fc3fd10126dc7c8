// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "files/csv.hpp"

#include <cstddef>
#include <ostream>
#include <string>
#include <unordered_set>
#include <vector>

namespace millforce::host {

/// Finds rows that repeat an earlier row letter by letter, in the same file or in another one: a copy is no second
/// measurement, and would make the standard errors too small. Holds the text of all rows.
class DuplicateRows {
  public:
    /// Whether the reader's current row is there already.
    bool is_copy(const CsvReader& csv);

    /// One line that names them, if there were any.
    void report(std::ostream& out) const;

  private:
    std::unordered_set<std::string> seen_;
    std::vector<std::string> places_;
};

/// "cuts.csv:3": the reader's current row, for messages.
std::string row_place(const CsvReader& csv);

/// "cuts.csv:3, cuts.csv:9", at most ten of them, and how many more there are.
std::string list_of_places(const std::vector<std::string>& places);

}  // namespace millforce::host
