// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Bytes of a CANopen heartbeat (CiA 301), its id, and what the two sides agree on about it.

namespace millforce::override_frame {

inline constexpr std::uint32_t heartbeat_id = 0x700;  // + node id
inline constexpr std::uint8_t nmt_boot_up = 0x00;
inline constexpr std::uint8_t nmt_stopped = 0x04;
inline constexpr std::uint8_t nmt_operational = 0x05;
inline constexpr std::uint8_t nmt_pre_operational = 0x7F;

}  // namespace millforce::override_frame
