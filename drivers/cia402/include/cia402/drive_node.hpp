// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cia402/drive_settings.hpp"
#include "cia402/rejects.hpp"
#include "cia402/sdo_client.hpp"
#include "cia402/signal_table.hpp"
#include "cia402/status.hpp"
#include "cia402/travel_check.hpp"
#include "hal/can_frame.hpp"

/// One drive as seen from the bus: prepared by SDO, started by NMT, watched by heartbeat, read by PDO.

namespace millforce::cia402 {

enum class NodeState : std::uint8_t {
    unused,       ///< no drive in this role
    preparing,    ///< SDO transfers; entered at start, after a boot-up and when a lost drive is heard again
    refused,      ///< an SDO was aborted or a rated value is absurd; tried again after a second
    starting,     ///< NMT start was sent, or a listener waits; left by the drive's first sign of being operational
    operational,  ///< PDOs are used; left by a heartbeat of another state, or by none
    lost,         ///< the heartbeat stayed away; left by the next heartbeat
};

/// For the supervisor. Nothing here latches but the counters and `emergency`. A drive with a fault still reports its
/// current, and the sample carries it: the supervisor decides what a fault means for the cut.
struct NodeHealth {
    NodeState state = NodeState::unused;
    PowerState power = PowerState::unknown;
    bool emergency_active = false;     ///< an error code other than 00xx was the last
    Emergency emergency{};             ///< the last one, whatever it says
    bool units_disagree = false;       ///< velocity is withheld meanwhile
    std::uint32_t sdo_abort_code = 0;  ///< code of the last refusal
    std::uint32_t silent_cycles = 0;   ///< SYNC periods since the last PDO; saturates
    std::uint32_t times_lost = 0;
};

/// What a drive reported in one SYNC period.
struct DriveReading {
    bool has_current = false;
    bool has_velocity = false;
    bool has_count = false;
    float current_A = 0.0F;
    float velocity_mm_s = 0.0F;
    std::uint32_t count = 0;
    std::uint32_t index_count = 0;
    std::uint8_t index_number = 0;  ///< 0: no pulse yet; then 1…255 and again from 1
};

/// Cost of on_frame: a walk over the mapped objects (at most 8). One thread.
class DriveNode {
  public:
    DriveNode() = default;
    DriveNode(const DriveSettings& settings, const BusSettings& bus, bool is_spindle);

    /// True where the frame's id belongs to this drive.
    bool on_frame(const hal::CanFrame& frame, std::uint64_t time_us, RejectCounters& rejects);
    void poll(std::uint64_t time_us, RejectCounters& rejects);
    [[nodiscard]] bool take_frame(hal::CanFrame& frame);

    void begin_cycle();
    void end_cycle();
    /// All PDOs that come at every SYNC have arrived, or none is expected.
    [[nodiscard]] bool is_complete() const;
    /// Values of this SYNC period; what is missing or rejected is absent. Once per period.
    [[nodiscard]] DriveReading read(std::uint64_t sync_time_us, RejectCounters& rejects);

    [[nodiscard]] const NodeHealth& health() const { return health_; }
    [[nodiscard]] std::uint8_t node_id() const { return settings_.node_id; }
    [[nodiscard]] float rated_current_A() const { return rated_current_A_; }
    [[nodiscard]] float rated_torque_Nm() const { return rated_torque_Nm_; }

  private:
    void on_pdo(std::size_t place, const hal::CanFrame& frame, std::uint64_t time_us, RejectCounters& rejects);
    void on_heartbeat(const hal::CanFrame& frame, std::uint64_t time_us, RejectCounters& rejects);
    void on_emergency(const hal::CanFrame& frame, RejectCounters& rejects);

    void enter_start_of_life(std::uint64_t time_us);
    void prepare(std::uint64_t time_us, RejectCounters& rejects);
    void ask_or_start(std::uint64_t time_us);
    void send_start(std::uint64_t time_us);
    void refuse(std::uint64_t time_us, std::uint32_t abort_code);
    [[nodiscard]] bool take_answer(RejectCounters& rejects);

    [[nodiscard]] bool is_fresh(Signal signal, std::uint64_t now_us) const;
    void read_current(std::uint64_t now_us, DriveReading& reading, RejectCounters& rejects) const;
    void read_count(std::uint64_t now_us, DriveReading& reading, RejectCounters& rejects);
    void read_index(std::uint64_t now_us, std::uint32_t raw_count, DriveReading& reading);
    void read_velocity(std::uint64_t now_us, DriveReading& reading, RejectCounters& rejects);
    [[nodiscard]] bool moved_mm(std::uint64_t now_us, float& way_mm, float& elapsed_s);
    [[nodiscard]] float periods_since(std::uint64_t before_us, std::uint64_t now_us) const;

    DriveSettings settings_{};
    bool is_master_ = false;
    bool is_spindle_ = false;
    std::uint32_t sync_period_us_ = 1000;
    SignalTable signals_{};
    SdoClient sdo_{};
    NodeHealth health_{};

    std::uint8_t step_ = 0;
    bool polled_ = false;
    bool nmt_to_send_ = false;
    NmtCommand nmt_command_ = NmtCommand::start;
    std::uint64_t next_try_us_ = 0;
    std::uint64_t heartbeat_us_ = 0;
    float rated_current_A_ = 0.0F;
    float rated_torque_Nm_ = 0.0F;

    std::array<std::uint64_t, largest_pdo_count> pdo_time_us_{};
    std::array<bool, largest_pdo_count> pdo_received_{};  ///< since the drive became operational
    std::array<bool, largest_pdo_count> pdo_in_cycle_{};

    bool has_last_count_ = false;
    std::uint32_t last_raw_count_ = 0;
    std::uint64_t last_count_us_ = 0;
    std::uint32_t count_ = 0;
    bool has_index_ = false;
    std::uint32_t last_raw_index_number_ = 0;
    std::uint32_t index_count_ = 0;
    std::uint8_t index_number_ = 0;
    bool has_last_position_ = false;
    std::uint32_t last_position_ = 0;
    std::uint64_t last_position_us_ = 0;
    TravelCheck travel_check_{};
};

}  // namespace millforce::cia402
