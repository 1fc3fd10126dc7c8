// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "program/arguments.hpp"

extern "C" char** environ;

namespace millforce::test {

/// A running millforce, its standard output and error on pipes, or the error in a file. Ended with the object, if
/// nothing else ended it.
class Program {
  public:
    explicit Program(const std::vector<std::string>& arguments, const std::string& error_file = {}) {
        std::array<int, 2> out{};
        std::array<int, 2> error{};
        if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(error.data(), O_CLOEXEC) != 0) {
            throw std::runtime_error("no pipe");
        }
        const Arguments words(arguments);
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
        ::posix_spawn_file_actions_adddup2(&actions, error[1], STDERR_FILENO);
        if (!error_file.empty()) {
            ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, error_file.c_str(),
                                               O_WRONLY | O_CREAT | O_APPEND, 0666);
        }
        const int failed = ::posix_spawn(&process_, MILLFORCE_PROGRAM, &actions, nullptr, words.argv(), environ);
        ::posix_spawn_file_actions_destroy(&actions);
        ::close(out[1]);
        ::close(error[1]);
        if (failed != 0) {
            throw std::runtime_error("cannot run " MILLFORCE_PROGRAM);
        }
        pipes_ = {out[0], error[0]};
    }
    ~Program() {
        if (process_ > 0) {
            interrupt(SIGKILL);
            wait();
        }
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void interrupt(int signal) const { ::kill(process_, signal); }
    [[nodiscard]] pid_t process() const { return process_; }

    /// As if who reads its standard error had ended.
    void close_reader_of_error() {
        ::close(pipes_[1]);
        pipes_[1] = -1;
    }
    /// It takes 4 kB then, and not 64.
    void narrow_pipe_of_error() const { ::fcntl(pipes_[1], F_SETPIPE_SZ, 4096); }
    /// Reads its standard error until this is in it; false: it was not in two minutes.
    bool says(const std::string& part) { return reads(1, part, std::chrono::seconds(120)); }
    /// The same of its standard output.
    bool prints(const std::string& part, std::chrono::seconds patience) { return reads(0, part, patience); }

    /// Reads to the end of both pipes, then takes the status.
    void wait() {
        std::array<pollfd, 2> waiting{{{pipes_[0], POLLIN, 0}, {pipes_[1], POLLIN, 0}}};
        while (waiting[0].fd >= 0 || waiting[1].fd >= 0) {
            ::poll(waiting.data(), waiting.size(), -1);
            for (std::size_t k = 0; k < 2; ++k) {
                std::array<char, 4096> buffer{};
                if (waiting[k].fd >= 0 && waiting[k].revents != 0) {
                    const ssize_t count = ::read(waiting[k].fd, buffer.data(), buffer.size());
                    text_[k].append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
                    waiting[k].fd = count > 0 ? waiting[k].fd : -1;
                }
            }
        }
        ::close(pipes_[0]);
        ::close(pipes_[1]);
        ::waitpid(process_, &status_, 0);
        process_ = 0;
    }

    int exit_code() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1; }
    int ended_by_signal() const { return WIFSIGNALED(status_) ? WTERMSIG(status_) : 0; }
    const std::string& out() const { return text_[0]; }
    const std::string& error() const { return text_[1]; }

  private:
    bool reads(std::size_t stream, const std::string& part, std::chrono::seconds patience) {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (text_[stream].find(part) == std::string::npos && std::chrono::steady_clock::now() < end) {
            pollfd waiting{pipes_[stream], POLLIN, 0};
            if (::poll(&waiting, 1, 100) > 0) {
                std::array<char, 4096> buffer{};
                const ssize_t count = ::read(pipes_[stream], buffer.data(), buffer.size());
                text_[stream].append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
            }
        }
        return text_[stream].find(part) != std::string::npos;
    }

    pid_t process_ = 0;
    int status_ = 0;
    std::array<int, 2> pipes_{};
    std::array<std::string, 2> text_;
};

struct Ended {
    int exit_code;
    std::string out;
    std::string error;
};

inline Ended run_millforce(const std::vector<std::string>& arguments) {
    Program program(arguments);
    program.wait();
    return {program.exit_code(), program.out(), program.error()};
}

/// "" where the program refused as it should: exit code 2, nothing on standard output, and one line on standard error
/// that holds all of `parts`. Else what is wrong.
inline std::string not_refused(const Ended& ended, const std::vector<std::string>& parts) {
    const bool one_line = std::count(ended.error.begin(), ended.error.end(), '\n') == 1 && ended.error.back() == '\n';
    std::string wrong;
    wrong += ended.exit_code != 2 ? "exit code " + std::to_string(ended.exit_code) + "; " : "";
    wrong += !ended.out.empty() ? "standard output: " + ended.out + "; " : "";
    wrong += !one_line || !ended.error.starts_with("millforce: ") ? "not one line; " : "";
    for (const std::string& part : parts) {
        wrong += ended.error.find(part) == std::string::npos ? "no '" + part + "'; " : "";
    }
    return wrong.empty() ? wrong : wrong + "error was: " + ended.error;
}

inline std::string text_of(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// `text` with its first `from` replaced by `to`; throws where there is none, so that a test cannot test nothing.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t place = text.find(from);
    if (place == std::string::npos) {
        throw std::runtime_error("no '" + from + "' in the text");
    }
    return text.replace(place, from.size(), to);
}

}  // namespace millforce::test
