// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Why a frame, or a value of a frame, was not used. Everything that is not used is counted, by reason.

namespace millforce::cia402 {

enum class Reject : std::uint8_t {
    foreign_id,           ///< belongs to nothing that is configured: usual on a bus that others use too
    not_standard_data,    ///< 29-bit id or remote frame: CANopen devices of this kind use neither
    frame_length,         ///< more than 8 bytes
    pdo_length,           ///< not the number of bytes that the mapping says: the drive is mapped otherwise
    pdo_not_operational,  ///< from a drive that is not operational: its content is undefined
    pdo_late,             ///< after the sample of its SYNC was handed over, or before the first SYNC
    pdo_repeated,         ///< a second one in one SYNC period; it replaced the first
    current_range,        ///< beyond the largest share of the rated current
    velocity_range,       ///< beyond the largest velocity of the axis
    position_step,        ///< a position or count moved more than the drive can
    units_disagree,       ///< position and velocity give different speeds: one of the units is wrong
    sync_length,          ///< SYNC carries 0 or 1 bytes
    sync_early,           ///< less than half a period after the last: a duplicate
    heartbeat_malformed,  ///< not one byte, or no NMT state
    emergency_malformed,  ///< not eight bytes
    sdo_malformed,        ///< not eight bytes, or a command that is no expedited transfer
    sdo_unexpected,       ///< answers nothing that was asked
    sdo_value_range,      ///< a rated value that no drive has
};
inline constexpr std::size_t reject_reasons = static_cast<std::size_t>(Reject::sdo_value_range) + 1;

/// Counts saturate: a full counter stays full.
class RejectCounters {
  public:
    void add(Reject reason) {
        std::uint32_t& count = count_[static_cast<std::size_t>(reason)];
        count += count < UINT32_MAX ? 1U : 0U;
    }
    [[nodiscard]] std::uint32_t operator[](Reject reason) const { return count_[static_cast<std::size_t>(reason)]; }
    /// Of all reasons but `foreign_id`.
    [[nodiscard]] std::uint64_t total() const {
        std::uint64_t sum = 0;
        for (std::size_t k = 1; k < reject_reasons; ++k) {
            sum += count_[k];
        }
        return sum;
    }

  private:
    std::array<std::uint32_t, reject_reasons> count_{};
};

}  // namespace millforce::cia402
