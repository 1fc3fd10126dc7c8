// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "program/arguments.hpp"

namespace millforce::test {

/// A millforce whose standard output and error are a terminal.
class OnTerminal {
  public:
    OnTerminal(const std::vector<std::string>& arguments, unsigned short columns, unsigned short rows) {
        const Arguments words(arguments);
        const winsize size{rows, columns, 0, 0};
        process_ = ::forkpty(&terminal_, nullptr, nullptr, &size);
        if (process_ == 0) {
            ::setenv("TERM", "xterm", 1);
            ::setenv("LC_ALL", "C", 1);
            ::execv(MILLFORCE_PROGRAM, words.argv());
            ::_exit(127);
        }
        if (process_ < 0) {
            throw std::runtime_error("no terminal");
        }
    }
    ~OnTerminal() {
        if (process_ > 0) {
            ::kill(process_, SIGKILL);
            ::waitpid(process_, nullptr, 0);
        }
        ::close(terminal_);
    }
    OnTerminal(const OnTerminal&) = delete;
    OnTerminal& operator=(const OnTerminal&) = delete;

    /// Reads what it writes until this is in it, for half a minute at most; `forget()` begins again.
    bool shows(const std::string& part) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (text_.find(part) == std::string::npos && std::chrono::steady_clock::now() < end) {
            pollfd waiting{terminal_, POLLIN, 0};
            if (::poll(&waiting, 1, 100) > 0 && !read()) {
                break;
            }
        }
        return text_.find(part) != std::string::npos;
    }
    void forget() { text_.clear(); }
    /// What is between the next two of these; empty: they do not come.
    std::string between(const std::string& begin, const std::string& end) {
        if (!shows(begin)) {
            return {};
        }
        text_.erase(0, text_.find(begin) + begin.size());
        return shows(end) ? text_.substr(0, text_.find(end)) : std::string();
    }
    [[nodiscard]] const std::string& text() const { return text_; }

    void resize(unsigned short columns, unsigned short rows) const {
        const winsize size{rows, columns, 0, 0};
        ::ioctl(terminal_, TIOCSWINSZ, &size);
    }
    /// As if a key were pressed, e.g. "\x03" for Ctrl-C.
    void press(const std::string& keys) const { (void)!::write(terminal_, keys.data(), keys.size()); }
    void interrupt(int signal) const { ::kill(process_, signal); }
    /// Waits until it has stopped (Ctrl-Z).
    [[nodiscard]] bool is_stopped() const {
        int status = 0;
        return ::waitpid(process_, &status, WUNTRACED) == process_ && WIFSTOPPED(status);
    }
    /// Reads to the end; the exit code.
    int end() {
        while (read()) {
        }
        int status = 0;
        ::waitpid(process_, &status, 0);
        process_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

  private:
    bool read() {
        std::array<char, 4096> bytes{};
        const ssize_t count = ::read(terminal_, bytes.data(), bytes.size());
        text_.append(bytes.data(), static_cast<std::size_t>(count > 0 ? count : 0));
        return count > 0;
    }

    int terminal_ = -1;
    pid_t process_ = -1;
    std::string text_{};
};

}  // namespace millforce::test
