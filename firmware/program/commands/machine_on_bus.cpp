// SPDX-License-Identifier: Apache-2.0
#include "commands/machine_on_bus.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <thread>

#include "commands/can_interface.hpp"
#include "daemon/can_daemon.hpp"
#include "daemon/journal.hpp"
#include "daemon/line_printer.hpp"
#include "daemon/service.hpp"
#include "files/input_error.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/tool_set.hpp"
#include "socketcan/can_socket.hpp"

namespace millforce::host {

namespace {

using namespace std::chrono_literals;

/// Samples of the daemon's ticks, for the recorder.
class Samples final : public firmware::TickListener {
  public:
    Samples(StepRecorder& recorder, StepWatch& watch) : recorder_(recorder), watch_(watch) {}

    void on_tick(const firmware::CanController& controller) override {
        const hal::DriveSample& sample = controller.sample();
        if (is_over_ || (has_sample_ && sample.time_us == last_us_)) {
            return;  // a tick without a new sample
        }
        has_sample_ = true;
        last_us_ = sample.time_us;
        count_.fetch_add(1, std::memory_order_relaxed);
        is_over_ = recorder_.add(sample);
        for (const std::string& line : watch_.take_news()) {
            printer_.print(line);
        }
    }
    [[nodiscard]] bool is_over() const { return is_over_; }
    [[nodiscard]] std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }

  private:
    StepRecorder& recorder_;
    StepWatch& watch_;
    LinePrinter printer_{stdout};
    bool has_sample_ = false;
    std::uint32_t last_us_ = 0;
    std::atomic<bool> is_over_{false};
    std::atomic<std::uint64_t> count_{0};
};

/// Ends the step where it is over, where there is enough and the machine is silent, or where the operator interrupts.
class Ending {
  public:
    Ending(const Samples& samples, const StepRecorder& recorder, const std::atomic<bool>& interrupted)
        : thread_([this, &samples, &recorder, &interrupted] { watch(samples, recorder, interrupted); }) {}
    ~Ending() {
        is_left_ = true;
        thread_.join();
    }
    Ending(const Ending&) = delete;
    Ending& operator=(const Ending&) = delete;

    [[nodiscard]] const std::atomic<bool>& flag() const { return stop_; }

  private:
    void watch(const Samples& samples, const StepRecorder& recorder, const std::atomic<bool>& interrupted) {
        constexpr int turns_of_silence = 40;  // 2 s
        std::uint64_t last_count = 0;
        int silent_turns = 0;
        while (!is_left_) {
            std::this_thread::sleep_for(50ms);
            silent_turns = samples.count() == last_count ? silent_turns + 1 : 0;
            last_count = samples.count();
            const bool is_silent = silent_turns >= turns_of_silence && recorder.is_enough();
            stop_ = stop_ || interrupted || samples.is_over() || is_silent;
        }
    }

    std::atomic<bool> stop_{false};
    std::atomic<bool> is_left_{false};
    std::thread thread_;
};

}  // namespace

MachineOnInterface::MachineOnInterface(const std::string& interface, const BusPace& pace)
    : interface_(interface), pace_(pace) {
    static_cast<void>(socket_on(interface));  // throws
}

std::vector<FoundDrive> MachineOnInterface::find_drives() {
    socketcan::CanSocket socket(socket_on(interface_));
    socket.poll(socketcan::monotonic_us());
    if (!socket.is_up()) {
        throw InputError(fmt::format("{}: the interface is not there or not up; expected 'ip link set {} up'",
                                     interface_, interface_));
    }
    SearchBus bus;
    // The queue of an interface holds ten frames, and the search asks all nodes at once.
    bus.send = [&socket](const hal::CanFrame& frame) {
        for (int attempt = 0; attempt < 100 && !socket.send(frame); ++attempt) {
            std::this_thread::sleep_for(1ms);
        }
    };
    bus.receive = [&socket]() -> std::optional<hal::CanFrame> {
        hal::CanFrame frame;
        std::uint64_t time_us = 0;
        socket.poll(socketcan::monotonic_us());
        if (socket.receive(frame, time_us)) {
            return frame;
        }
        socket.wait(2'000);
        return socket.receive(frame, time_us) ? std::optional(frame) : std::nullopt;
    };
    bus.now_us = [] { return socketcan::monotonic_us(); };
    return host::find_drives(bus);
}

bool MachineOnInterface::record(const std::filesystem::path& machine, const std::filesystem::path& tool,
                                StepRecorder& recorder, StepWatch& watch) {
    const ToolSet tools(read_machine_parameters(machine.string()), ToolChoice{tool.string(), {}});
    const auto bus = read_machine_bus(machine.string());
    if (!bus) {
        throw InputError(fmt::format("{}: no drive on the bus; expected the tables [bus]", machine.string()));
    }
    const BusTime time{pace_.slow_motion, pace_.lock_step, bus->drives.sync_id, bus->drives.sync_period_us};
    const std::atomic<bool>& interrupted = stop_on_signal();
    Samples samples(recorder, watch);
    const auto journal = std::make_unique<Journal>(JournalSettings{interface_, {}, {}, false, ToolForces(tools)});
    CanDaemonSettings settings;
    settings.time = time;
    const auto daemon = std::make_unique<CanDaemon>(socket_on(interface_), *bus, tools, *journal, settings, &samples);
    {
        const Ending ending(samples, recorder, interrupted);
        if (!pace_.lock_step) {
            become_real_time();
        }
        daemon->run(ending.flag());
        leave_real_time();
    }
    journal->finish();
    return !interrupted;
}

}  // namespace millforce::host
