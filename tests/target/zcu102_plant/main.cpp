// SPDX-License-Identifier: Apache-2.0
// The plant of the bus in the loop, on the Cortex-A53 of an emulated zcu102: SCENARIO.toml [TOOL]. It lays the
// controller's parameters where a boot loader would, starts the Cortex-R5F, mills, and prints the figures as TOML. Exit
// codes: 0 milled, 2 bad input, 3 the R5F does not start, 5 no CAN controller, 6 a system call that is not served, 68 a
// fault.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "bus/plant_on_can.hpp"
#include "bus/plant_wiring.hpp"
#include "files/input_error.hpp"
#include "firmware/parameter_block.hpp"
#include "loop/scenario.hpp"
#include "loop/simulation.hpp"
#include "target/zcu102/a53.hpp"
#include "target/zcu102_plant/can_port.hpp"
#include "target/zcu102_plant/host_calls.hpp"
#include "target/zcu102_plant/turns.hpp"

namespace {

using namespace millforce;

/// A good part of a period would make the controller's SYNC late; a small one costs the emulator time.
constexpr std::uint64_t turn_us = 100;
constexpr std::uintptr_t parameters_of_r5f = 0x00F0'0000;  // firmware/boards/zcu102/memory.ld

sim::PlantOnCanSettings plant_settings(const sim::Scenario& scenario, std::uint32_t tool) {
    sim::PlantOnCanSettings settings = sim::plant_on_bus(scenario, "zcu102");
    settings.computes_ahead = true;
    settings.tool = tool;
    return settings;
}

void lay_parameters(std::span<const std::uint8_t> block) {
    std::memcpy(reinterpret_cast<void*>(parameters_of_r5f), block.data(), block.size());
}

/// The scenario's tool under its number, between two that bear a tenth of its force.
void lay_tools(const sim::Scenario& scenario, std::uint32_t number) {
    firmware::ToolParameters<float> weak = scenario.parameters.tool;
    weak.tooth_force_limit_N *= 0.1F;
    const std::array<firmware::NumberedTool, 3> tools{firmware::NumberedTool{number - 1, weak},
                                                      firmware::NumberedTool{number, scenario.parameters.tool},
                                                      firmware::NumberedTool{number + 1, weak}};
    firmware::LargestParameterBlock block{};
    lay_parameters(firmware::encode_tools(scenario.parameters.machine, tools, 1, block));
}

/// `tool`: 0: the block has one tool, without a number.
void start_controller(const sim::Scenario& scenario, std::uint32_t tool) {
    if (tool != 0) {
        lay_tools(scenario, tool);
    } else {
        lay_parameters(firmware::encoded(scenario.parameters, 1));
    }
    if (start_processor(target::cortex_r5f, target::image_of_r5f) != 0) {
        target::exit_emulator(3);
    }
}

/// The board is switched on when the plant is there: time begins with its first sample.
class PlantOnBoard final : public sim::PlantOnCan {
  public:
    PlantOnBoard(const sim::Scenario& scenario, std::uint32_t tool, std::unique_ptr<target::BarePort> port)
        : PlantOnBoard(scenario, tool, *port, std::move(port)) {}

    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override {
        if (!is_on_) {
            is_on_ = true;
            calls_before_ = host_calls();
            wire.begin_time();
            start_controller(scenario_, tool_);
            target::take_turns(turn_us);
        }
        if (is_ready()) {
            longest_computing_us = std::max(longest_computing_us, wire.now_us() - answered_us_);
        }
        const hal::FeedOverride answer = PlantOnCan::step(sample, program);
        target::BarePort::let_controller_work();
        answered_us_ = wire.now_us();
        return answer;
    }

    /// Of the host, since the board was switched on.
    [[nodiscard]] unsigned long calls() const { return host_calls() - calls_before_; }

    target::BarePort& wire;
    std::uint64_t longest_computing_us = 0;  ///< of a sample, with the turns that were given away meanwhile

  private:
    PlantOnBoard(const sim::Scenario& scenario, std::uint32_t tool, target::BarePort& bare,
                 std::unique_ptr<host::CanPort> port)
        : PlantOnCan(plant_settings(scenario, tool), std::move(port)), wire(bare), scenario_(scenario), tool_(tool) {}

    const sim::Scenario& scenario_;
    std::uint32_t tool_;
    bool is_on_ = false;
    unsigned long calls_before_ = 0;
    std::uint64_t answered_us_ = 0;
};

void mill(const char* scenario_file, std::uint32_t tool) {
    const sim::Scenario scenario = sim::read_scenario(scenario_file);
    auto port = std::make_unique<target::BarePort>();
    port->poll(0);
    if (!port->is_on_bus()) {
        target::exit_emulator(5);
    }
    PlantOnBoard plant(scenario, tool, std::move(port));
    const sim::RunFigures figures = sim::simulate(scenario, plant, "zcu102").result.figures;
    const unsigned long calls = plant.calls();
    fmt::print("finished = {}\n", figures.finished);
    fmt::print("time_s = {}\n", figures.time_s);
    fmt::print("peak_over_limit = {}\n", figures.peak_over_limit);
    fmt::print("late_over_limit_s = {}\n", figures.late_over_limit_s);
    fmt::print("teeth_broken = {}\n", figures.teeth_broken);
    fmt::print("syncs = {}\n", plant.syncs());
    fmt::print("sent = {}\n", plant.wire.sent);
    fmt::print("received = {}\n", plant.wire.received);
    fmt::print("lost = {}\n", plant.wire.lost());
    fmt::print("longest_delay_us = {}\n", plant.longest_delay_us());
    fmt::print("longest_computing_us = {}\n", plant.longest_computing_us);
    fmt::print("calls_of_host = {}\n", calls);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc != 2 && argc != 3) {
            throw host::InputError("expected SCENARIO.toml [TOOL]");
        }
        mill(argv[1], argc == 3 ? static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10)) : 0);
        return 0;
    } catch (const std::exception& error) {
        fmt::print("{}\n", error.what());
        return 2;
    }
}
