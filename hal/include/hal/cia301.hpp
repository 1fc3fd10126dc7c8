// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Numbers of CiA 301 (CANopen) that more than one driver needs: this controller is a node of a bus as its drives are.

namespace millforce::hal::cia301 {

/// CAN identifiers of the predefined connection set; those with a plus add the node id 1…127.
namespace cob_id {
inline constexpr std::uint32_t nmt = 0x000;
inline constexpr std::uint32_t sync = 0x080;
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

[[nodiscard]] constexpr std::uint8_t byte_of(NmtState state) {
    return static_cast<std::uint8_t>(state);
}

}  // namespace millforce::hal::cia301
