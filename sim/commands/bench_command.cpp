// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands/command_line.hpp"
#include "commands/plant_commands.hpp"
#include "files/input_error.hpp"
#include "firmware/tick.hpp"
#include "loop/recorder.hpp"
#include "loop/simulation.hpp"
#include "recording/recording.hpp"

namespace millforce::sim {

namespace {

/// Retired instructions of this thread, where the kernel and the processor let them be counted.
class InstructionCounter {
  public:
    InstructionCounter() {
        perf_event_attr attributes{};
        attributes.type = PERF_TYPE_HARDWARE;
        attributes.size = sizeof(attributes);
        attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
        attributes.exclude_kernel = 1;
        attributes.exclude_hv = 1;
        descriptor_ = static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
    }
    ~InstructionCounter() {
        if (descriptor_ >= 0) {
            close(descriptor_);
        }
    }
    InstructionCounter(const InstructionCounter&) = delete;
    InstructionCounter& operator=(const InstructionCounter&) = delete;

    [[nodiscard]] bool works() const { return descriptor_ >= 0; }
    [[nodiscard]] std::uint64_t read_count() const {
        std::uint64_t count = 0;
        return works() && read(descriptor_, &count, sizeof(count)) == sizeof(count) ? count : 0;
    }

  private:
    int descriptor_ = -1;
};

struct TickCost {
    std::uint64_t plain = 0;
    std::uint64_t with_estimate = 0;
    std::uint64_t worst = 0;
    double mean = 0.0;
};

template <typename Read>
TickCost tick_cost(const Scenario& scenario, const std::vector<host::RecordedStep>& recording, Read read) {
    firmware::ForceControlTick<float> tick(scenario.parameters);
    std::vector<std::uint64_t> plain;
    std::vector<std::uint64_t> estimating;
    std::uint64_t sum = 0;
    for (const host::RecordedStep& recorded : recording) {
        const float before_s = static_cast<float>(tick.estimator().since_period_s());
        const std::uint64_t start = read();
        firmware::step_and_work(tick, recorded.sample, recorded.program);
        const std::uint64_t cost = read() - start;
        sum += cost;
        const bool new_period = static_cast<float>(tick.estimator().since_period_s()) < before_s;
        (new_period ? estimating : plain).push_back(cost);
    }
    const auto median = [](std::vector<std::uint64_t>& values) {
        std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
        return values[values.size() / 2];
    };
    TickCost cost;
    cost.plain = plain.empty() ? 0 : median(plain);
    cost.with_estimate = estimating.empty() ? 0 : median(estimating);
    cost.worst = estimating.empty() ? 0 : *std::max_element(estimating.begin(), estimating.end());
    cost.mean = static_cast<double>(sum) / static_cast<double>(recording.size());
    return cost;
}

void print_cost(const char* unit, const TickCost& cost) {
    fmt::print("{:<22}{:>12}{:>12}{:>12}{:>12.0f}\n", unit, cost.plain, cost.with_estimate, cost.worst, cost.mean);
}

/// The figures of the images, from the tree that this program was built in; nothing where it was installed elsewhere.
void print_target_figures() {
    std::error_code error;
    std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    for (; !folder.empty() && folder != folder.root_path(); folder = folder.parent_path()) {
        const std::filesystem::path script = folder / "toolchains" / "target-figures";
        if (std::filesystem::exists(script, error)) {
            fmt::print("\n");
            std::fflush(stdout);
            const pid_t child = fork();
            if (child == 0) {
                execl(script.c_str(), script.c_str(), nullptr);
                _exit(127);
            }
            waitpid(child, nullptr, 0);
            return;
        }
    }
}

int bench(const std::string& path) {
    const Scenario scenario = read_scenario(path);
    MillforceController controller(scenario.parameters);
    std::vector<host::RecordedStep> recording;
    Recorder recorder(controller, [&](const host::RecordedStep& step) { recording.push_back(step); });
    const Simulated run = simulate(scenario, recorder, "millforce");
    fmt::print("simulation of {}: {:.1f} s in {:.2f} s, {:.0f} × real time\n\n", scenario.name,
               run.result.figures.time_s, run.result.figures.time_s / run.result.figures.real_time_factor,
               run.result.figures.real_time_factor);
    fmt::print("cost of one tick       {:>12}{:>12}{:>12}{:>12}\n", "between", "estimating", "worst", "mean");
    const auto nanoseconds = [] {
        return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
    };
    print_cost("ns", tick_cost(scenario, recording, nanoseconds));
    const InstructionCounter counter;
    if (counter.works()) {
        print_cost("instructions", tick_cost(scenario, recording, [&] { return counter.read_count(); }));
    } else {
        fmt::print(
            "instructions          not counted: this kernel has no hardware counters; "
            "toolchains/target-figures counts those of emulated processors\n");
    }
    fmt::print("\nRAM of the tick: {} bytes\n", sizeof(firmware::ForceControlTick<float>));
    print_target_figures();
    return 0;
}

}  // namespace

void add_bench(host::Command& program) {
    auto scenario = std::make_shared<std::string>();
    auto exit_code_of_control = std::make_shared<std::optional<int>>();
    host::Command command =
        program.subcommand("bench", "Print the performance tables; 'bench control' compares feed controllers");
    command.option("scenario", *scenario, "Scenario to run").value_name("SCENARIO.toml");
    add_bench_control(command, exit_code_of_control);
    command.on_run([scenario, exit_code_of_control] {
        if (*exit_code_of_control) {
            return **exit_code_of_control;
        }
        if (scenario->empty()) {
            throw host::InputError("bench: expected SCENARIO.toml or 'control'");
        }
        return bench(*scenario);
    });
}

}  // namespace millforce::sim
