// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <signal.h>
#include <time.h>

#include <cstdint>

// What millforce-hal and millforce-can have in common: the request to stop, and the time.

inline volatile sig_atomic_t stop_asked = 0;

/// From now on SIGINT and SIGTERM set stop_asked.
inline void ask_to_stop_on_signals() {
    struct sigaction action {};
    action.sa_handler = [](int) { stop_asked = 1; };
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

inline std::uint64_t monotonic_us() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000U + static_cast<std::uint64_t>(now.tv_nsec) / 1000U;
}
