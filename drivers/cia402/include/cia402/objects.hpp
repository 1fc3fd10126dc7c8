// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/cia301.hpp"
#include "hal/drive_wiring.hpp"

/// Numbers of CiA 402 (drives) that the driver uses, and those of CiA 301 by their short names.

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

namespace cob_id = hal::cia301::cob_id;
using hal::cia301::largest_node_id;
using hal::cia301::NmtCommand;
using hal::cia301::NmtState;

}  // namespace millforce::cia402
