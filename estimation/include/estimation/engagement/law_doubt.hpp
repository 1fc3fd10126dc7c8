// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace millforce::estimation {

/// Whether the forces of this cut have contradicted the law for so long that a fit proves little: the forces of a wrong
/// signal move with the cut, and may be those of another cut for a while.
///
/// Each tooth period counts +4 where the forces contradict the law (J > 16, side_choice.hpp) and −1 where they fit it,
/// between 0 and 1000 windows. The law is in doubt from two contradicting windows on, until the count is back at 0:
/// after at most 1000 windows that fit. Where the law holds, one window in 3000 contradicts it. Air ends the doubt. Not
/// thread-safe.
class LawDoubt {
  public:
    /// Of an estimate: the tooth periods since the one before, and those of its window.
    void follow(bool is_contradicted, int tooth_periods, int window_periods) {
        constexpr int weight = 4;
        constexpr int enough_windows = 2;
        constexpr int most_windows = 1000;
        count_ += is_contradicted ? weight * tooth_periods : -tooth_periods;
        count_ = std::clamp(count_, 0, most_windows * window_periods);
        is_open_ = count_ > 0 && (is_open_ || count_ >= weight * enough_windows * window_periods);
    }
    void forget() { *this = {}; }

    [[nodiscard]] bool is_open() const { return is_open_; }

  private:
    int count_ = 0;  // tooth periods
    bool is_open_ = false;
};

}  // namespace millforce::estimation
