#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "target/lock_step.hpp"

namespace millforce {

/// A controller image in an emulator, spoken to over two pipes.
class EmulatedController {
  public:
    EmulatedController(const std::string& processor, const firmware::Parameters<float>& parameters) {
        std::string name = (std::filesystem::temp_directory_path() / "millforce-loop-XXXXXX").string();
        folder_ = mkdtemp(name.data());
        const std::string requests = folder_ + "/requests";
        const std::string answers = folder_ + "/answers";
        if (mkfifo(requests.c_str(), 0600) != 0 || mkfifo(answers.c_str(), 0600) != 0) {
            return;
        }
        const std::string source = MILLFORCE_SOURCE_DIR;
        const std::string runner = source + "/toolchains/run-on-mps2";
        const std::string image = source + "/build/" + processor + "/tests/target/lock_step_controller.elf";
        child_ = fork();
        if (child_ == 0) {
            execl(runner.c_str(), runner.c_str(), processor.c_str(), image.c_str(), requests.c_str(), answers.c_str(),
                  nullptr);
            _exit(127);
        }
        requests_ = open_when_alive(requests, O_WRONLY);
        answers_ = requests_ < 0 ? -1 : open_when_alive(answers, O_RDONLY);
        const lock_step::ParameterValues values = lock_step::values_of(parameters);
        works_ = answers_ >= 0 && write(requests_, &values, sizeof(values)) == static_cast<ssize_t>(sizeof(values));
    }

    ~EmulatedController() {
        close(requests_);
        close(answers_);
        if (child_ > 0) {
            waitpid(child_, nullptr, 0);
        }
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    EmulatedController(const EmulatedController&) = delete;
    EmulatedController& operator=(const EmulatedController&) = delete;

    [[nodiscard]] bool works() const { return works_; }

    lock_step::Answer step(const lock_step::Request& request) {
        lock_step::Answer answer{};
        works_ = works_ && write(requests_, &request, sizeof(request)) == static_cast<ssize_t>(sizeof(request));
        auto* next = reinterpret_cast<char*>(&answer);
        std::size_t left = sizeof(answer);
        while (works_ && left > 0) {
            const ssize_t count = read(answers_, next, left);
            works_ = count > 0;
            next += works_ ? count : 0;
            left -= works_ ? static_cast<std::size_t>(count) : 0;
        }
        return answer;
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

    std::string folder_;
    pid_t child_ = -1;
    int requests_ = -1;
    int answers_ = -1;
    bool works_ = false;
};

}  // namespace millforce
