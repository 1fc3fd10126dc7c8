// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "daemon/journal.hpp"
#include "daemon/latency.hpp"
#include "daemon/pause_watch.hpp"
#include "daemon/service.hpp"
#include "firmware_can/can_controller.hpp"
#include "parameters/machine_bus.hpp"
#include "run_log/bus_clock.hpp"
#include "socketcan/can_socket.hpp"
#include "telemetry/telemetry_feed.hpp"

namespace millforce::host {

struct CanDaemonSettings {
    bool records = false;  ///< every frame of the bus goes to the journal; else the kernel keeps out what is of no use
    BusTime time{};
    TelemetryFeed* telemetry = nullptr;         ///< for who watches; outlives the daemon
    firmware::WaySource<float>* way = nullptr;  ///< what lies ahead of one tool; outlives the daemon
};

/// The controller on a CAN interface: socket, CanController and journal in one loop, until `stop` is set. Then the
/// override says hold, and the heartbeat `stopped`, before run() returns. No heap in the loop; it blocks in the socket
/// alone. One thread.
class CanDaemon final : private firmware::TickListener {
  public:
    /// `tools` outlives this, and so does `watcher`, which sees each tick before its override is sent.
    CanDaemon(const socketcan::CanSocketSettings& interface, const MachineBus& bus, const ToolSet& tools,
              Journal& journal, const CanDaemonSettings& settings, firmware::TickListener* watcher = nullptr);

    void run(const std::atomic<bool>& stop);

    [[nodiscard]] const socketcan::LinkHealth& link() const { return socket_.health(); }
    [[nodiscard]] const firmware::CanController& controller() const { return controller_; }
    /// From a SYNC on the bus to the override frame that was worked out of its sample, on a clock.
    [[nodiscard]] const LatencyHistogram& sync_to_override() const { return latency_; }
    [[nodiscard]] std::uint64_t overruns() const { return socket_.health().overruns; }

  private:
    void on_tick(const firmware::CanController& controller) override;
    void step();
    void look_for_pause(std::uint64_t turn_us, std::uint64_t time_us);
    void hold_where_needed();
    void receive_frames();
    void read_beside_bus(std::uint64_t unix_us);
    void send_all();
    void end(std::uint64_t duration_us);
    void record_ticks();
    void add_for_watchers(const firmware::CanController& controller, TelemetrySample& sample) const;
    void report(std::uint64_t now_us);
    [[nodiscard]] firmware::Conditions conditions(std::uint64_t now_us);
    [[nodiscard]] firmware::Conditions recent(const firmware::Conditions& now, std::uint64_t now_us);
    [[nodiscard]] std::uint64_t now_us() const;
    [[nodiscard]] std::uint64_t bus_time_us(std::uint64_t monotonic_us) const;
    [[nodiscard]] bool has_cycle_ended(std::uint64_t monotonic_us) const;
    static socketcan::CanSocketSettings socket_settings(socketcan::CanSocketSettings settings,
                                                        const firmware::CanController& controller, bool records);

    Journal& journal_;
    firmware::TickListener* watcher_;
    TelemetryFeed* telemetry_;
    firmware::WaySource<float>* way_;
    std::uint32_t override_id_;
    TickEntries entries_;
    std::array<TelemetrySample, 16> unrecorded_{};  ///< ticks whose override is not out yet
    std::size_t unrecorded_count_ = 0;
    firmware::CanController controller_;
    socketcan::CanSocket socket_;
    BusClock clock_;
    std::uint32_t sync_id_;
    std::uint8_t node_id_;
    std::uint64_t sync_heard_us_ = 0;  ///< on CLOCK_MONOTONIC
    LocalDrives local_drives_;
    LocalOutputs local_outputs_;
    LatencyHistogram latency_{};
    ServiceWatchdog watchdog_{};
    PauseWatch pause_watch_;
    std::uint64_t resumed_us_ = 0;  ///< bus time of the end of the last pause
    bool is_paused_ = false;        ///< and no sample has come since
    EstimateEntry newest_{};
    std::uint64_t measured_tick_us_ = 0;
    std::uint64_t next_status_us_ = 0;
    firmware::Conditions reported_{};
    bool has_reported_ = false;
    std::array<std::uint64_t, firmware::condition_count> seen_us_{};
    std::uint32_t frames_lost_ = 0;
    std::uint64_t frames_lost_us_ = 0;
};

}  // namespace millforce::host
