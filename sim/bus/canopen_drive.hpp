// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "hal/can_frame.hpp"

namespace millforce::sim {

/// A servo drive's CANopen side (CiA 301, CiA 402), for closed loops over a bus without a drive: NMT slave, SDO server
/// with expedited transfers and abort codes, four transmit PDOs that can be mapped, SYNC consumer, heartbeat producer,
/// EMCY. It knows its master by frames alone and shares no code with the drivers.
struct CanopenDriveSettings {
    std::uint8_t node_id = 1;
    double rated_current_A = 12.0;
    double rated_torque_Nm = 8.0;
    std::uint32_t encoder_counts_per_rev = 8192;  ///< 0x608F
    std::uint32_t velocity_unit = 0xFA010300;     ///< 0x60A9: µm/s
    std::uint16_t heartbeat_ms = 0;
    /// Objects of TPDO 1 as delivered: index << 16 | subindex << 8 | bits.
    std::vector<std::uint32_t> first_pdo{0x60640020, 0x60780010, 0x60410010};
};

class CanopenDrive {
  public:
    explicit CanopenDrive(const CanopenDriveSettings& settings);

    /// Off: says and hears nothing. On: boots, with everything forgotten that was written.
    void set_power(bool on);
    void on_frame(const hal::CanFrame& frame, std::uint64_t time_us);
    void poll(std::uint64_t time_us);
    [[nodiscard]] std::vector<hal::CanFrame> take_frames();

    /// What the motor does; the next SYNC latches it. Currents and torques saturate at the objects' 16 bits.
    void set_position(std::int32_t units) { set(0x6064, 0, static_cast<std::uint32_t>(units)); }
    void set_velocity(std::int32_t units_s) { set(0x606C, 0, static_cast<std::uint32_t>(units_s)); }
    void set_current_A(double current_A);
    void set_torque_Nm(double torque_Nm);
    void set_statusword(std::uint16_t word) { set(0x6041, 0, word); }
    /// The index pulse: latches a position (0x60BA) and counts (0x60D5).
    void latch_index(std::int32_t position);
    void raise_emergency(std::uint16_t error_code, std::uint8_t error_register);

    [[nodiscard]] std::uint8_t nmt_state() const { return nmt_state_; }
    /// An object's value, 0 if it does not exist.
    [[nodiscard]] std::uint32_t object(std::uint16_t index, std::uint8_t subindex) const;
    [[nodiscard]] std::uint64_t aborts() const { return aborts_; }

  private:
    struct Entry {
        std::uint32_t value = 0;
        std::uint8_t bytes = 4;
        bool writable = false;
        bool mappable = false;
    };
    using Key = std::uint32_t;  // index << 8 | subindex
    static constexpr Key key(std::uint16_t index, std::uint8_t subindex) {
        return (std::uint32_t{index} << 8U) | subindex;
    }

    void build_dictionary();
    void set(std::uint16_t index, std::uint8_t subindex, std::uint32_t value);
    void boot();
    void on_nmt(const hal::CanFrame& frame);
    void on_sync();
    void on_sdo(const hal::CanFrame& frame);
    void answer_read(Key where);
    void answer_write(Key where, const hal::CanFrame& frame);
    [[nodiscard]] std::uint32_t refusal_of_write(Key where, const Entry& entry, std::uint32_t value) const;
    [[nodiscard]] std::uint32_t refusal_of_mapping(Key where, std::uint32_t value) const;
    void abort(Key where, std::uint32_t code);
    void send_pdo(unsigned number);
    void send(std::uint32_t id, std::vector<std::uint8_t> bytes);

    CanopenDriveSettings settings_;
    std::unordered_map<Key, Entry> dictionary_;
    std::vector<hal::CanFrame> outgoing_;
    std::array<unsigned, 4> syncs_since_pdo_{};
    std::uint8_t nmt_state_ = 0;
    bool powered_ = true;
    std::uint64_t time_us_ = 0;
    std::uint64_t next_heartbeat_us_ = 0;
    std::uint64_t aborts_ = 0;
};

}  // namespace millforce::sim
