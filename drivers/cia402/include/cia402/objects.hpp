// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/drive_wiring.hpp"

/// Numbers of CiA 301 (CANopen) and CiA 402 (drives) that the driver uses.

namespace millforce::cia402 {

/// Indices of the object dictionary.
namespace object {
inline constexpr std::uint16_t producer_heartbeat_time_ms = 0x1017;
inline constexpr std::uint16_t tpdo_communication = 0x1800;  ///< + PDO number 0…3
inline constexpr std::uint16_t tpdo_mapping = 0x1A00;        ///< + PDO number 0…3
inline constexpr std::uint16_t statusword = 0x6041;          ///< U16
inline constexpr std::uint16_t position_actual = 0x6064;     ///< I32, position units
inline constexpr std::uint16_t velocity_actual = 0x606C;     ///< I32, velocity units
inline constexpr std::uint16_t rated_current_mA = 0x6075;    ///< U32
inline constexpr std::uint16_t rated_torque_mNm = 0x6076;    ///< U32
inline constexpr std::uint16_t torque_actual = 0x6077;       ///< I16, per mille of rated torque
inline constexpr std::uint16_t current_actual = 0x6078;      ///< I16, per mille of rated current
}  // namespace object

/// CAN identifiers of the predefined connection set; those with a plus add the node id 1…127.
namespace cob_id {
inline constexpr std::uint32_t nmt = 0x000;
inline constexpr std::uint32_t sync = hal::default_sync_id;
inline constexpr std::uint32_t emergency = 0x080;     ///< +
inline constexpr std::uint32_t tpdo1 = 0x180;         ///< +, then 0x280, 0x380, 0x480
inline constexpr std::uint32_t sdo_response = 0x580;  ///< +, server to client
inline constexpr std::uint32_t sdo_request = 0x600;   ///< +, client to server
inline constexpr std::uint32_t heartbeat = 0x700;     ///< +
}  // namespace cob_id

inline constexpr std::uint8_t largest_node_id = 127;

/// First byte of an NMT command; the second is the node id, 0: all.
enum class NmtCommand : std::uint8_t {
    start = 0x01,
    stop = 0x02,
    enter_pre_operational = 0x80,
    reset_node = 0x81,
    reset_communication = 0x82,
};

/// What a heartbeat carries.
enum class NmtState : std::uint8_t {
    boot_up = 0x00,
    stopped = 0x04,
    operational = 0x05,
    pre_operational = 0x7F,
};

}  // namespace millforce::cia402
