// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace millforce::host {

/// Finds out that this process was stopped, by SIGSTOP, a debugger or a computer without time for it: its loop did not
/// turn for longer than a working loop takes. What it had received until then may be old. One thread; no heap.
class PauseWatch {
  public:
    /// `longest_turn_us`: the longest that a turn of the loop takes, its waiting included.
    explicit PauseWatch(std::uint64_t longest_turn_us) : longest_turn_us_(longest_turn_us) {}

    /// At each turn, before anything received is used, with a monotonic time; true: there was a pause before it.
    bool look(std::uint64_t now_us) {
        const std::uint64_t elapsed_us = last_us_ == 0 || now_us < last_us_ ? 0 : now_us - last_us_;
        last_us_ = now_us;
        if (elapsed_us <= longest_turn_us_) {
            return false;
        }
        pause_us_ = elapsed_us;
        return true;
    }
    /// How long the last pause was; 0: there was none.
    [[nodiscard]] std::uint64_t pause_us() const { return pause_us_; }

  private:
    std::uint64_t longest_turn_us_;
    std::uint64_t last_us_ = 0;
    std::uint64_t pause_us_ = 0;
};

}  // namespace millforce::host
