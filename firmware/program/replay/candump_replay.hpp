// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "firmware_can/can_controller.hpp"
#include "parameters/machine_bus.hpp"
#include "run_log/bus_clock.hpp"

namespace millforce::host {

/// Runs the controller of `millforce run` on a candump log.
///
/// Where the log holds the start of a controller (the boot-up in its heartbeat), the replay begins there, and again at
/// each further one: it then asks the drives as that run did, and takes the answers from the log. Else it begins with
/// the first line as a listener; rated values that machine.toml does not give are taken from SDO answers in the log.
class CandumpReplay {
  public:
    struct Settings {
        std::string log;
        std::string interface;  ///< empty: the only one of the log
        MachineBus bus{};
        firmware::Parameters<float> parameters{};
        const firmware::ToolSource* tools = nullptr;  ///< outlive the replay; null: one tool
        BusTime time{};                               ///< time of the run
        firmware::WaySource<float>* way = nullptr;    ///< what lies ahead of one tool; outlives the replay
    };

    /// Reads the log through once. Throws InputError: a line that candump does not write, an interface that does not
    /// exist or is not given although there are several, rated values that are in neither file nor log.
    explicit CandumpReplay(const Settings& settings);

    /// `on_tick` is called after each tick, `progress` with the share read.
    void run(const std::function<void(const firmware::CanController&)>& on_tick,
             const std::function<void(double share)>& progress);

    [[nodiscard]] std::uint64_t frames() const { return frames_; }
    [[nodiscard]] std::uint64_t ticks() const { return ticks_; }
    /// Frames that a recorder noted as missing, lines of CAN FD and error frames.
    [[nodiscard]] std::uint64_t not_used() const { return not_used_; }
    [[nodiscard]] bool is_listener() const { return !has_start_; }
    [[nodiscard]] const firmware::CanController& controller() const { return *controller_; }

  private:
    class Listener;
    void survey();
    void note_rated_value(const hal::CanFrame& frame);
    void take_rated_values();
    [[nodiscard]] bool is_start(const hal::CanFrame& frame) const;

    Settings settings_;
    bool has_start_ = false;
    std::uint64_t frames_ = 0;
    std::uint64_t ticks_ = 0;
    std::uint64_t not_used_ = 0;
    std::array<std::uint32_t, cia402::drive_capacity> rated_current_mA_{};
    std::array<std::uint32_t, cia402::drive_capacity> rated_torque_mNm_{};
    std::unique_ptr<firmware::CanController> controller_{};
};

}  // namespace millforce::host
