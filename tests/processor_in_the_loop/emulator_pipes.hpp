// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "temporary_folder.hpp"

namespace millforce {

/// A program in an emulator, spoken to over two pipes whose names are the last two words of its command line.
class EmulatorPipes {
  public:
    EmulatorPipes() = default;
    ~EmulatorPipes() {
        close(to_);
        close(from_);
        if (child_ > 0) {
            waitpid(child_, nullptr, 0);
        }
    }
    EmulatorPipes(const EmulatorPipes&) = delete;
    EmulatorPipes& operator=(const EmulatorPipes&) = delete;

    /// A folder that ends with this object.
    [[nodiscard]] const test::TemporaryFolder& folder() const { return folder_; }

    /// `command`: a runner and its first arguments.
    void start(std::vector<std::string> command) {
        const std::string to = folder_.path("to").string();
        const std::string from = folder_.path("from").string();
        if (mkfifo(to.c_str(), 0600) != 0 || mkfifo(from.c_str(), 0600) != 0) {
            return;
        }
        command.push_back(to);
        command.push_back(from);
        child_ = fork();
        if (child_ == 0) {
            std::vector<char*> words;
            for (std::string& word : command) {
                words.push_back(word.data());
            }
            words.push_back(nullptr);
            execv(words[0], words.data());
            _exit(127);
        }
        to_ = open_when_alive(to, O_WRONLY);
        from_ = to_ < 0 ? -1 : open_when_alive(from, O_RDONLY);
        works_ = from_ >= 0;
    }

    [[nodiscard]] bool works() const { return works_; }

    template <typename Message>
    void tell(const Message& message) {
        const auto bytes = std::as_bytes(std::span(&message, 1));
        works_ = works_ && write(to_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
    }

    /// All zero where the emulator has ended.
    template <typename Message>
    Message hear() {
        Message message{};
        auto* next = reinterpret_cast<char*>(&message);
        std::size_t left = sizeof(message);
        while (works_ && left > 0) {
            const ssize_t count = read(from_, next, left);
            works_ = count > 0;
            next += works_ ? count : 0;
            left -= works_ ? static_cast<std::size_t>(count) : 0;
        }
        return message;
    }

  private:
    /// A pipe opens when the emulator has opened its other end; an emulator that has ended never will.
    int open_when_alive(const std::string& name, int mode) {
        constexpr int most_tries = 2000;
        for (int k = 0; k < most_tries; ++k) {
            const int file = open(name.c_str(), mode | (mode == O_WRONLY ? O_NONBLOCK : 0));
            if (file >= 0) {
                fcntl(file, F_SETFL, fcntl(file, F_GETFL) & ~O_NONBLOCK);
                return file;
            }
            if (waitpid(child_, nullptr, WNOHANG) == child_) {
                child_ = -1;
                return -1;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return -1;
    }

    test::TemporaryFolder folder_;
    pid_t child_ = -1;
    int to_ = -1;
    int from_ = -1;
    bool works_ = false;
};

}  // namespace millforce
