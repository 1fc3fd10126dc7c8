// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/can_frame.hpp"
#include "hal/reset_cause.hpp"

/// Why, on the bus: CANopen emergency frames (CiA 301, 7.2.7), id 0x80 + node.
///
/// | bytes | what |
/// |---|---|
/// | 0, 1 | error code of CiA 301, U16; 0: no error, or the one named by `reason` has ended |
/// | 2 | error register: bit 0 while there is any error |
/// | 3 | Reason |
/// | 4…7 | detail, U32 |

namespace millforce::emergency {

enum class Reason : std::uint8_t {
    started = 0,          ///< detail: hal::ResetCause. An error after a watchdog, a brown-out or an unknown cause
    processor_fault = 1,  ///< detail: program counter; sent at the fault and after the reset that it causes
    no_parameters = 2,    ///< detail: firmware::BlockError
    supply_low = 3,       ///< below the voltage that the board watches for
    inputs_missing = 4,   ///< detail: hal::Present of the inputs that are present
    tick_fault = 5,       ///< detail: control::Fault
    bus_was_off = 6,      ///< detail: how many times since the start; sent when the bus is back
    tool_unknown = 7,     ///< detail: the number that the CNC tells, 0: none. The override is the operator's
};
inline constexpr std::size_t reason_count = static_cast<std::size_t>(Reason::tool_unknown) + 1;

/// What is wrong, and which of it has not been sent yet. One thread.
class Emergencies {
  public:
    explicit Emergencies(std::uint8_t node_id) : node_id_(node_id) {}

    /// Reports a change of `is_there`, and nothing where it is as before.
    void set(Reason reason, bool is_there, std::uint32_t detail);
    /// The same, and reports a change of the detail while it is there.
    void follow(Reason reason, bool is_there, std::uint32_t detail);
    /// Reports an event that has no end.
    void report(Reason reason, std::uint16_t code, std::uint32_t detail);
    void report_start(hal::ResetCause cause);
    [[nodiscard]] bool has(Reason reason) const { return (there_ & bit(reason)) != 0; }
    /// True once for each frame that is to be sent.
    [[nodiscard]] bool take_frame(hal::CanFrame& frame);
    [[nodiscard]] hal::CanFrame frame_of(Reason reason, std::uint16_t code, std::uint32_t detail) const;

  private:
    static std::uint32_t bit(Reason reason) { return 1U << static_cast<unsigned>(reason); }

    struct Entry {
        std::uint16_t code = 0;
        std::uint32_t detail = 0;
    };
    std::uint8_t node_id_;
    std::array<Entry, reason_count> entries_{};
    std::uint32_t there_ = 0;
    std::uint32_t unreported_ = 0;
};

/// CiA 301, table 26.
std::uint16_t error_code(Reason reason);

}  // namespace millforce::emergency
