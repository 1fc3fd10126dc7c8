// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "run_log/spsc_ring.hpp"

namespace millforce::host {

/// What happened in a run besides its ticks, in words for its page. From one thread, which may be the real-time one, to
/// one other.
class RunNotes {
  public:
    static constexpr std::size_t longest_note = 400;

    /// On the clock of the ticks. Neither waits nor allocates. Cut off after `longest_note` bytes; dropped where 64
    /// were not taken yet.
    void add(std::uint64_t time_us, std::string_view text) noexcept {
        Note note;
        note.time_us = time_us;
        note.length = std::min(text.size(), longest_note);
        std::copy_n(text.begin(), note.length, note.text.begin());
        notes_.push(note);
    }
    /// Calls `take(time_us, text)` for each that was not taken yet.
    template <typename Take>
    void take_all(Take take) {
        for (Note note; notes_.pop(note);) {
            take(note.time_us, std::string_view(note.text.data(), note.length));
        }
    }

  private:
    struct Note {
        std::uint64_t time_us = 0;
        std::array<char, longest_note> text{};
        std::size_t length = 0;
    };

    SpscRing<Note, 1U << 6U> notes_{};
};

}  // namespace millforce::host
