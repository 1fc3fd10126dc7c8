// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <thread>

#include "run_log/spsc_ring.hpp"
#include "firmware/tick_record.hpp"
#include "run_report/run_history.hpp"

namespace millforce::host {

/// Fills the history of a run from a real-time thread: a thread beside it does the work. Ticks that did not fit are
/// counted. Made before the caller becomes real-time: the writer inherits its scheduler. Ticks come from one thread,
/// notes from one other or the same.
class RunRecorder {
  public:
    /// `history` is this object's alone until finish().
    explicit RunRecorder(RunHistory& history);
    ~RunRecorder();
    RunRecorder(const RunRecorder&) = delete;
    RunRecorder& operator=(const RunRecorder&) = delete;

    /// Neither waits nor allocates.
    void tick(std::uint64_t time_us, const firmware::TickRecord& record, std::uint32_t tool) noexcept;
    /// On the clock of the ticks. Neither waits nor allocates. Cut off after `longest_note` bytes.
    void note(std::uint64_t time_us, std::string_view text) noexcept;

    /// Takes what is left and ends the thread.
    void finish();

    static constexpr std::size_t longest_note = 400;

  private:
    struct Tick {
        std::uint64_t time_us = 0;
        firmware::TickRecord record{};
        std::uint32_t tool = 0;
    };
    struct Note {
        std::uint64_t time_us = 0;
        std::array<char, longest_note> text{};
        std::size_t length = 0;
    };

    void run();
    void take_all();

    RunHistory& history_;
    SpscRing<Tick, 1U << 12U> ticks_{};
    SpscRing<Note, 1U << 6U> notes_{};
    std::atomic<std::uint64_t> lost_{0};
    std::atomic<bool> ended_{false};
    std::thread taker_{};
};

}  // namespace millforce::host
