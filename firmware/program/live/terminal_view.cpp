// SPDX-License-Identifier: Apache-2.0
#include "live/terminal_view.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "files/console.hpp"
#include "files/input_error.hpp"
#include "files/printable.hpp"

namespace millforce::host {

namespace {

// A screen of its own, without cursor and line wrap; and back.
constexpr std::string_view enter = "\x1b[?1049h\x1b[?25l\x1b[?7l\x1b[2J";
constexpr std::string_view leave = "\x1b[?7h\x1b[?25h\x1b[?1049l";
constexpr std::uint64_t drawing_period_us = 250'000;

/// For the handler of a signal: the terminal of the view, -1: none; and whether the view's screen is on it.
std::atomic<int> shown_terminal{-1};
std::atomic<bool> is_on_screen{false};

bool write_now(int terminal, std::string_view text) {
    pollfd waiting{terminal, POLLOUT, 0};
    return ::poll(&waiting, 1, 0) == 1 && (waiting.revents & POLLOUT) != 0 &&
           ::write(terminal, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

bool is_in_foreground(int terminal) {
    return ::tcgetpgrp(terminal) == ::getpgrp();
}

void leave_screen() {
    if (const int terminal = shown_terminal.load(); terminal >= 0 && is_on_screen.exchange(false)) {
        write_now(terminal, leave);
    }
}

/// Ctrl-Z: the shell finds its own screen. The view returns with its next drawing in the foreground.
void stop_without_view(int) {
    const int error = errno;
    leave_screen();
    ::raise(SIGSTOP);
    errno = error;
}

void handle_stop(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGTSTP, &action, nullptr);
}

/// By an opening of its own, so that it alone never waits for a terminal that is stopped with Ctrl-S. One of another
/// user cannot be opened: then standard output is used as it is.
int open_terminal() {
    std::array<char, 256> name{};
    int terminal = -1;
    if (::ttyname_r(STDOUT_FILENO, name.data(), name.size()) == 0) {
        terminal = ::open(name.data(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    }
    return terminal >= 0 ? terminal : ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
}

bool is_locale_unicode() {
    for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"}) {
        if (const char* value = std::getenv(variable); value != nullptr && value[0] != '\0') {
            return std::strstr(value, "UTF-8") != nullptr || std::strstr(value, "utf8") != nullptr;
        }
    }
    return false;
}

template <typename Clock>
std::uint64_t now_us() {
    const auto time = Clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(time).count());
}

}  // namespace

TerminalView::TerminalView(const std::string& title) : has_unicode_(is_locale_unicode()) {
    const char* kind = std::getenv("TERM");
    if (::isatty(STDOUT_FILENO) == 0 || kind == nullptr || std::strcmp(kind, "dumb") == 0) {
        throw InputError(
            "--view: standard output is no terminal to draw on, expected one; --web shows it in a browser");
    }
    state_.title = title;
    terminal_ = open_terminal();
    shown_terminal.store(terminal_);
    handle_stop(stop_without_view);
    capture_errors();
}

TerminalView::~TerminalView() {
    leave_screen();
    shown_terminal.store(-1);
    handle_stop(SIG_DFL);
    if (errors_ >= 0) {
        read_errors();
        ::dup2(true_errors_, STDERR_FILENO);
        for (const std::string& line : error_lines_) {
            print_line(stderr, line);
        }
        ::close(true_errors_);
        ::close(errors_);
    }
    ::close(terminal_);
}

/// Lines between those of the view would spoil it.
void TerminalView::capture_errors() {
    std::array<int, 2> ends{};
    if (::isatty(STDERR_FILENO) == 0 || ::pipe2(ends.data(), O_CLOEXEC) != 0) {
        return;
    }
    errors_ = ends[0];
    ::fcntl(errors_, F_SETFL, O_NONBLOCK);
    true_errors_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[1]);
}

void TerminalView::read_errors() {
    constexpr std::size_t most_lines = 1000;
    constexpr std::size_t longest_line = 4096;
    std::array<char, 4096> bytes{};
    for (ssize_t count = 0; (count = ::read(errors_, bytes.data(), bytes.size())) > 0;) {
        for (const char letter : std::string_view(bytes.data(), static_cast<std::size_t>(count))) {
            if (letter != '\n' && error_line_.size() < longest_line) {
                error_line_ += letter;
            }
            if (letter == '\n') {
                state_.add_event(now_us<std::chrono::system_clock>(), error_line_);
                if (error_lines_.size() < most_lines) {
                    error_lines_.push_back(error_line_);
                }
                error_line_.clear();
            }
        }
    }
}

void TerminalView::on_turn() {
    if (errors_ >= 0) {
        read_errors();
    }
    if (const std::uint64_t time_us = now_us<std::chrono::steady_clock>(); time_us >= drawn_us_ + drawing_period_us) {
        drawn_us_ = time_us;
        draw();
    }
}

ViewSize TerminalView::size() const {
    winsize found{};
    ::ioctl(terminal_, TIOCGWINSZ, &found);
    ViewSize size{80, 24, has_unicode_};
    if (found.ws_col > 0 && found.ws_row > 0) {
        size.columns = found.ws_col;
        size.rows = found.ws_row;
    }
    return size;
}

void TerminalView::draw() {
    if (!is_in_foreground(terminal_)) {
        return;
    }
    const ViewSize now = size();
    const bool has_changed = now.columns != drawn_size_.columns || now.rows != drawn_size_.rows;
    drawn_size_ = now;
    std::string text;
    if (!is_on_screen.exchange(true)) {
        text = enter;
    } else if (has_changed) {
        text = "\x1b[2J";
    }
    if (state_.newest) {
        const std::uint64_t time_us = now_us<std::chrono::steady_clock>();
        const std::uint64_t tick_us = state_.newest->sample.monotonic_us;
        state_.age_s = time_us > tick_us ? 1e-6 * static_cast<double>(time_us - tick_us) : 0.0;
    }
    std::size_t row = 0;
    for (const std::string& line : view_lines(state_, now)) {
        text += fmt::format("\x1b[{};1H{}\x1b[K", ++row, line);
    }
    write_now(terminal_, text + "\x1b[J");
}

}  // namespace millforce::host
