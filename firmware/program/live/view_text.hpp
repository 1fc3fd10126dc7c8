// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "telemetry/event_watch.hpp"
#include "telemetry/telemetry.hpp"

/// What the terminal's view shows, as lines of text. No terminal is needed for it.

namespace millforce::host {

struct ViewEvent {
    std::uint64_t unix_us = 0;
    std::string text;
};

struct ViewState {
    std::string title;
    std::optional<Telemetry> newest{};
    double age_s = 0.0;              ///< of the newest
    std::deque<ViewEvent> events{};  ///< newest first
    float deepest_mm = 0.0F;         ///< largest depth seen: scale of its bar

    void take(const Telemetry& telemetry);
    /// What was said within the last second already, by whomever, is not said again.
    void add_event(std::uint64_t unix_us, const std::string& text);
};

struct ViewSize {
    std::size_t columns = 80;
    std::size_t rows = 24;
    bool has_unicode = true;
};

/// At most `rows` lines of at most `columns` characters, without control characters.
[[nodiscard]] std::vector<std::string> view_lines(const ViewState& state, const ViewSize& size);

}  // namespace millforce::host
