// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "can_frames.hpp"
#include "socketcan/can_socket.hpp"

/// The other side of a vcan interface: can-utils, iproute2, and processes of our own.

namespace millforce::vcan {

/// Where the driver under test is, and where its peers are: both on vcan0, or on two controllers of one bus.
inline std::string interface_named_by(const char* variable) {
    const char* name = std::getenv(variable);
    return name != nullptr ? name : "vcan0";
}
inline std::string controller_interface() {
    return interface_named_by("MILLFORCE_CAN_CONTROLLER");
}
inline std::string peer_interface() {
    return interface_named_by("MILLFORCE_CAN_PEER");
}

/// SYNC periods are longer by this factor where the machine under the bus is emulated.
inline std::uint32_t slower() {
    const char* factor = std::getenv("MILLFORCE_CAN_SLOWER");
    return factor != nullptr ? static_cast<std::uint32_t>(std::atoi(factor)) : 1;
}

inline void sleep_ms(int duration_ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(duration_ms));
}

/// The exit code of a shell command; what it prints goes nowhere.
inline int shell(const std::string& command) {
    const int status = std::system((command + " >/dev/null 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// A process that is ended with the object.
class Child {
  public:
    explicit Child(const std::function<void()>& work) : pid_(fork()) {
        if (pid_ == 0) {
            work();
            _exit(0);
        }
    }
    explicit Child(const std::string& command)
        : Child([&] { execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr); }) {}
    ~Child() {
        send_signal(SIGCONT);
        send_signal(SIGKILL);
        wait();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    void send_signal(int signal) const {
        if (pid_ > 0) {
            kill(pid_, signal);
        }
    }
    [[nodiscard]] bool has_ended() {
        if (pid_ > 0 && waitpid(pid_, nullptr, WNOHANG) == pid_) {
            pid_ = 0;
        }
        return pid_ == 0;
    }
    void wait() {
        if (pid_ > 0) {
            waitpid(pid_, nullptr, 0);
        }
        pid_ = 0;
    }

  private:
    pid_t pid_;
};

inline std::string temporary_file(const std::string& name) {
    const char* folder = std::getenv("TMPDIR");
    return std::string(folder != nullptr ? folder : "/tmp") + "/" + std::to_string(getpid()) + "_" + name;
}

inline std::vector<std::string> lines_of(const std::string& file) {
    std::ifstream in(file);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) {
        lines.push_back(line);
    }
    return lines;
}

/// How long a peer may take: a virtual kernel on a busy host pauses for seconds, and where the host is itself virtual a
/// second of a part takes it ten.
inline constexpr std::chrono::seconds patience{120};

/// Does a step at a time until it holds; false where it does not for so long.
template <typename Holds, typename Step>
bool step_until(Holds holds, Step step) {
    const std::uint64_t end_us =
        socketcan::monotonic_us() + 1'000'000ULL * static_cast<std::uint64_t>(patience.count());
    while (!holds()) {
        if (socketcan::monotonic_us() > end_us) {
            return false;
        }
        step();
    }
    return true;
}
inline bool wait_until(const std::function<bool()>& holds) {
    return step_until(holds, [] { sleep_ms(50); });  // what is asked for reads a whole file as a rule
}

/// `candump -L` of an interface into a file, from when the constructor returns; with room for all that comes in a
/// pause.
class Candump {
  public:
    Candump(const std::string& interface, std::string file)
        : file_(std::move(file)),
          receivers_before_(receivers()),
          process_("stdbuf -oL candump -L -r 16000000 " + interface + " >" + file_) {
        wait_until([&] { return receivers() > receivers_before_; });
    }
    explicit Candump(const std::string& interface) : Candump(interface, temporary_file("candump")) {
        is_file_temporary_ = true;
    }
    ~Candump() {
        if (is_file_temporary_) {
            unlink(file_.c_str());
        }
    }
    Candump(const Candump&) = delete;
    Candump& operator=(const Candump&) = delete;

    /// Waits for so many frames that begin with this.
    [[nodiscard]] bool has(const std::string& begin, int count = 1) const {
        return wait_until([&] {
            const std::vector<std::string> all = frames();
            return std::count_if(all.begin(), all.end(), [&](const auto& it) { return it.starts_with(begin); }) >=
                   count;
        });
    }
    /// Waits until the bus has been quiet for half a second.
    [[nodiscard]] bool is_quiet() const {
        std::uintmax_t size = 0;
        return wait_until([&] {
            const std::uintmax_t before = std::exchange(size, std::filesystem::file_size(file_));
            sleep_ms(500);
            return before == size && size > 0;
        });
    }
    /// Those so far as `123#1122`, without time and interface.
    [[nodiscard]] std::vector<std::string> frames() const {
        std::vector<std::string> frames = lines_of(file_);
        for (std::string& line : frames) {
            line = line.substr(line.rfind(' ') + 1);
        }
        return frames;
    }

  private:
    /// Sockets that the kernel gives every frame.
    static std::size_t receivers() { return lines_of("/proc/net/can/rcvlist_all").size(); }

    std::string file_;
    bool is_file_temporary_ = false;
    std::size_t receivers_before_;
    Child process_;
};

inline socketcan::CanSocketSettings on(const std::string& interface) {
    socketcan::CanSocketSettings settings;
    settings.set_interface(interface);
    settings.look_period_us = 10'000;
    return settings;
}

/// A driver's socket that is open, and what it received.
class Listener {
  public:
    explicit Listener(const socketcan::CanSocketSettings& settings) : socket(settings) {
        socket.poll(socketcan::monotonic_us());
    }

    /// Polls and fetches for so long.
    void run_ms(int duration_ms) {
        const std::uint64_t end_us = socketcan::monotonic_us() + 1000ULL * static_cast<unsigned>(duration_ms);
        while (socketcan::monotonic_us() < end_us) {
            step();
        }
    }
    /// Until it holds; false where it does not.
    bool run_until(const std::function<bool()>& holds) {
        return step_until(holds, [this] { step(); });
    }

    socketcan::CanSocket socket;
    std::vector<hal::CanFrame> frames{};
    std::vector<std::uint64_t> times_us{};

  private:
    void step() {
        socket.wait(1000);
        socket.poll(socketcan::monotonic_us());
        hal::CanFrame frame;
        std::uint64_t time_us = 0;
        while (socket.receive(frame, time_us)) {
            frames.push_back(frame);
            times_us.push_back(time_us);
        }
    }
};

}  // namespace millforce::vcan
