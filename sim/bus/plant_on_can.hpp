// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "bus/can_port.hpp"
#include "bus/cnc_on_bus.hpp"
#include "bus/machine_on_bus.hpp"
#include "loop/override_source.hpp"
#include "run_log/bus_clock.hpp"

namespace millforce::sim {

struct PlantOnCanSettings {
    std::string interface;  ///< for messages
    MachineOnBusSettings machine{};
    CncOnBusSettings cnc{};
    std::uint32_t tool = 0;                  ///< number that the CNC tells; 0: it sends no frame of a tool
    std::uint64_t patience_us = 30'000'000;  ///< for a controller, at the start, on a clock
    host::BusTime time{};
    /// The sample that answers a SYNC was computed before it: so a plant that computes for a good part of a period does
    /// not answer late. Each SYNC then counts as exactly one period, as for drives whose own clocks follow it, because
    /// the time at which it is received depends more on the computing than on the SYNC. Otherwise the sample is
    /// computed once the SYNC's time is known.
    bool computes_ahead = false;
};

/// The simulated machine's side of a real CAN interface: its drives and its CNC, in real time, nothing shared with the
/// controller but frames. The plant keeps the time of the bus: its steps are stretched by at most a
/// third so that they end at the SYNC's stamp; where SYNC stays away for 5 ms the plant goes on by the clock, and its
/// CNC finds out by itself that the controller is dead.
///
/// Throws InputError where no controller is heard within the patience.
class PlantOnCan : public OverrideSource {
  public:
    PlantOnCan(const PlantOnCanSettings& settings, std::unique_ptr<host::CanPort> port);

    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override;
    void describe(TracePoint&) const override {}  // the controller keeps its own estimates
    [[nodiscard]] bool is_ready() const override { return is_ready_; }
    [[nodiscard]] PlantSteps plant_steps(const PlantSteps& usual) override;

    /// Longest time that the plant's computation was behind a SYNC.
    [[nodiscard]] std::uint64_t longest_delay_us() const { return longest_delay_us_; }
    [[nodiscard]] std::uint64_t syncs() const { return syncs_; }

  private:
    [[nodiscard]] std::uint64_t now_us() const { return clock_.of_monotonic(port_->now_us()); }
    void answer_sync();
    void await_sync();
    bool receive_until_sync();
    void send_all();
    void check_patience(std::uint64_t port_us) const;

    PlantOnCanSettings settings_;
    std::unique_ptr<host::CanPort> port_;
    host::BusClock clock_;
    MachineOnBus machine_;
    CncOnBus cnc_;
    hal::CanFrame sync_{};
    bool sync_is_pending_ = false;
    std::uint64_t heard_us_;  ///< by the port's clock: the last SYNC, or the start
    std::uint64_t plant_us_;  ///< how far the plant has got, on the bus's clock
    std::uint64_t due_us_;    ///< how far it must get for the next sample
    bool is_ready_ = false;
    std::uint64_t syncs_ = 0;
    std::uint64_t stepped_syncs_ = 0;
    std::uint64_t longest_delay_us_ = 0;
};

}  // namespace millforce::sim
