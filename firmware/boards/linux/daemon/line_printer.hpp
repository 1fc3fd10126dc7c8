// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <semaphore>
#include <string_view>
#include <thread>

#include "run_log/spsc_ring.hpp"

namespace millforce::host {

/// Lines for whoever watches, from a real-time thread: a thread beside it writes them, so that a terminal or a pipe
/// that does not take them holds up nothing. Lines that did not fit are counted, and reported where they are missing.
/// Made before the caller becomes real-time: the writer inherits its scheduler. One thread calls print().
class LinePrinter {
  public:
    explicit LinePrinter(std::FILE* stream);
    /// Writes what is left.
    ~LinePrinter();
    LinePrinter(const LinePrinter&) = delete;
    LinePrinter& operator=(const LinePrinter&) = delete;

    /// Neither waits nor allocates. Cut off after `longest_line` bytes.
    void print(std::string_view line) noexcept;
    template <typename First, typename... Others>
    void print(fmt::format_string<const First&, const Others&...> text, const First& first, const Others&... others) {
        Text line{};
        print(written_into(line, text, first, others...));
    }

    static constexpr std::size_t longest_line = 160;
    static constexpr std::size_t capacity = 64;

  private:
    using Text = std::array<char, longest_line>;
    struct Line {
        Text text{};
        std::size_t length = 0;
        std::uint64_t lost_before = 0;
    };

    /// Takes no memory: there may be none.
    template <typename... Values>
    static std::string_view written_into(Text& line, fmt::format_string<const Values&...> text,
                                         const Values&... values) {
        const std::size_t length = fmt::format_to_n(line.data(), line.size(), text, values...).size;
        return {line.data(), std::min(length, line.size())};
    }
    void run();
    void write_all();
    void report_lost(std::uint64_t lost);

    std::FILE* stream_;
    SpscRing<Line, capacity> lines_{};
    std::uint64_t lost_ = 0;  // of the caller; the writer reads it after the end
    std::uint64_t reported_lost_ = 0;
    std::atomic<bool> ended_{false};
    std::counting_semaphore<> has_news_{0};
    std::thread writer_{};
};

}  // namespace millforce::host
