// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>

#include "import/derivations.hpp"
#include "import/import_map.hpp"

namespace millforce::host {

/// Makes one column of the recording out of its source: continues what wraps, takes it to our unit, derives. Each
/// sample that goes in comes out once, in order, some of them later.
class SignalChain {
  public:
    explicit SignalChain(const ColumnMap& column);

    /// `raw`: in the source's unit; NaN: none. False where it does not fit `wrap`: more than that away from the last
    /// one.
    [[nodiscard]] bool add(double time_s, double raw);
    void finish();

    [[nodiscard]] bool has_sample() const { return !out_.empty(); }
    [[nodiscard]] const Sample& front() const { return out_.front(); }
    Sample take();
    /// Time of the first sample that has gone in and cannot come out yet; infinite where there is none.
    [[nodiscard]] double waits_since_s() const;
    [[nodiscard]] const ColumnMap& column() const { return column_; }
    [[nodiscard]] double last_raw() const { return unwrap_.last(); }

  private:
    void finish_samples(std::size_t from);

    ColumnMap column_;
    Unwrap unwrap_;
    std::unique_ptr<SampleDerivation> derivation_;
    std::deque<Sample> out_;
};

}  // namespace millforce::host
