// SPDX-License-Identifier: Apache-2.0
#include "files/progress.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace millforce::host {

namespace {

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Empty while it is too early to say.
std::string time_left(double passed_s, double fraction) {
    constexpr double early_s = 3.0;
    constexpr double early_share = 0.02;
    if (passed_s < early_s || fraction < early_share) {
        return {};
    }
    const double left_s = passed_s * std::max(1.0 - fraction, 0.0) / fraction;
    return left_s < 90.0 ? fmt::format(", about {:.0f} s left", left_s)
                         : fmt::format(", about {:.0f} min left", std::ceil(left_s / 60.0));
}

}  // namespace

Progress::Progress(std::string what, unsigned calls_per_look)
    : what_(std::move(what)),
      terminal_(::isatty(STDERR_FILENO) == 1),
      calls_per_look_(calls_per_look),
      start_s_(now_s()),
      last_s_(start_s_) {}

Progress::~Progress() {
    if (shown_) {
        fmt::print(stderr, "\r\x1b[K");
        std::fflush(stderr);
    }
}

bool Progress::is_time_to_show() {
    constexpr double quiet_s = 0.5;
    constexpr double between_s = 0.1;
    const double now = now_s();
    if (!terminal_ || now - start_s_ < quiet_s || now - last_s_ < between_s) {
        return false;
    }
    last_s_ = now;
    shown_ = true;
    return true;
}

void Progress::update(double fraction) {
    if (++calls_ % calls_per_look_ == 0 && is_time_to_show()) {
        fmt::print(stderr, "\r{}: {:.0f} %{}\x1b[K", what_, 100.0 * fraction, time_left(last_s_ - start_s_, fraction));
        std::fflush(stderr);
    }
}

void Progress::show(const std::string& state) {
    if (is_time_to_show()) {
        fmt::print(stderr, "\r{}: {}\x1b[K", what_, state);
        std::fflush(stderr);
    }
}

}  // namespace millforce::host
