// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/cia301.hpp"

/// How a drive reports its current and velocity over a bus, and the CAN ids that a machine uses where its file gives no
/// others. Parameters and bus drivers share them.

namespace millforce::hal {

enum class CurrentSource : std::uint8_t {
    current,  ///< CiA 402 object 0x6078, per mille of rated current 0x6075
    torque,   ///< 0x6077, per mille of rated torque 0x6076, over the torque constant
};

/// What a drive's rated current means. Samples carry A rms.
enum class CurrentBasis : std::uint8_t {
    rms,
    peak,  ///< amplitude of the phase current: √2 times rms
};

enum class VelocitySource : std::uint8_t {
    velocity,  ///< 0x606C
    position,  ///< difference of 0x6064 between two SYNCs
};

inline constexpr std::uint16_t default_sync_id = cia301::cob_id::sync;
inline constexpr std::uint8_t default_override_node_id = 126;
inline constexpr std::uint16_t default_override_id =
    cia301::cob_id::tpdo1 + default_override_node_id;              ///< TPDO 1 of this node
inline constexpr std::uint16_t default_program_status_id = 0x1FD;  ///< TPDO 1 of node 125

}  // namespace millforce::hal
