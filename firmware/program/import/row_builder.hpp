// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "import/signal_chain.hpp"
#include "import/source_reader.hpp"

namespace millforce::host {

/// Rows at equal times out of values that come at any.
struct Resampling {
    double rate_hz = 0.0;  ///< 0: a row for each record, as it comes
    double hold_s = 0.02;  ///< a value is held no longer than this, then it is missing
};

/// Builds the recording's rows out of records. With resampling, a row has the last value of each column, and a row
/// without any value is left out. Holds as many rows as the derivations need.
class RowBuilder {
  public:
    using Sink = std::function<void(double time_s, std::span<const double> values)>;

    /// `value_numbers`: of each column, the number of its value in a record.
    RowBuilder(const std::vector<ColumnMap>& columns, std::vector<std::size_t> value_numbers, Resampling resampling,
               Sink sink);

    /// The record that `source` is at. Times must grow; with resampling, they may be equal. InputError: a value that
    /// does not fit its `wrap`.
    void add(double time_s, const SourceReader& source);
    void finish();

  private:
    void give_rows();
    void give_rows_before(double limit_s);
    [[nodiscard]] bool hold_values(double time_s);
    [[nodiscard]] double next_sample_s(double limit_s) const;

    std::vector<SignalChain> chains_;
    std::vector<std::size_t> value_numbers_;
    Resampling resampling_;
    Sink sink_;
    std::vector<double> values_;
    std::vector<Sample> held_;
    std::uint64_t next_row_ = 0;
    double last_time_s_ = 0.0;
};

}  // namespace millforce::host
