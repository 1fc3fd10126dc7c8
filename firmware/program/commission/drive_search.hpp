// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hal/can_frame.hpp"

namespace millforce::host {

/// A CAN bus as the search for drives needs it: a socket, or drives in memory.
struct SearchBus {
    std::function<void(const hal::CanFrame&)> send;
    /// The next frame, within a few milliseconds; nothing: none came.
    std::function<std::optional<hal::CanFrame>()> receive;
    std::function<std::uint64_t()> now_us;
};

/// What a node says of itself. An object that it does not have is nothing.
struct FoundDrive {
    std::uint8_t node_id = 0;
    std::uint32_t device_type = 0;                  ///< 0x1000
    std::optional<std::uint32_t> vendor_id;         ///< 0x1018:1
    std::optional<std::uint32_t> product_code;      ///< 0x1018:2
    std::optional<std::uint32_t> rated_current_mA;  ///< 0x6075
    std::optional<std::uint32_t> rated_torque_mNm;  ///< 0x6076
    std::optional<std::uint32_t> encoder_counts;    ///< 0x608F:1 over 0x608F:2, per turn of the motor
    std::optional<std::uint32_t> velocity_unit;     ///< 0x60A9
    bool has_index_latch = false;                   ///< 0x60BA and 0x60D5

    [[nodiscard]] bool is_cia402() const { return (device_type & 0xFFFFU) == 402; }
    /// "node 2: CiA 402, vendor 0x…, rated 12 A, 8 N·m, …"
    [[nodiscard]] std::string words() const;
    /// mm/s of one unit of 0x606C, from 0x60A9. A unit in turns needs the travel per turn. Nothing: another unit.
    [[nodiscard]] std::optional<double> velocity_mm_s(double travel_per_turn_mm) const;
};

/// Asks all nodes 1 … 127 for their device type (SDO), then those that answer for their ratings and units. Reads only:
/// no drive is started, stopped or changed. Takes 0.3 s, and 0.3 s more for each object that a node does not answer.
std::vector<FoundDrive> find_drives(const SearchBus& bus);

}  // namespace millforce::host
