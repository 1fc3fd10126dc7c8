// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "hal/can_frame.hpp"
#include "stm32/registers.hpp"

/// The CAN controller bxCAN. RM0090 32

namespace millforce::stm32 {

enum class CanBitRate : std::uint8_t { kbit_125, kbit_250, kbit_500, kbit_1000 };

/// Entered and left by poll() alone.
enum class CanState : std::uint8_t {
    entering_setup,  ///< waits for the controller to leave the bus
    joining,         ///< waits for 11 recessive bits
    absent,          ///< the controller does not answer: no clock, or no such chip. Final
    running,
    error_warning,  ///< an error counter at 96; frames flow
    error_passive,  ///< at 128; the same
    bus_off,        ///< nothing is sent; ends after 128 × 11 recessive bits, by itself
};
constexpr const char* name(CanState state) {
    constexpr const char* names[] = {"entering setup", "joining",       "absent", "running",
                                     "error warning",  "error passive", "bus-off"};
    return names[static_cast<unsigned>(state) % 7U];
}

struct CanHealth {
    std::uint32_t bus_offs = 0;
    std::uint32_t overruns = 0;   ///< frames that came while the receive queue was full, at least
    std::uint32_t unsent = 0;     ///< no free mailbox, or off the bus
    std::uint8_t last_error = 0;  ///< ESR.LEC: 1 stuff, 2 form, 3 acknowledge, 4 and 5 bit, 6 CRC
    std::uint8_t transmit_errors = 0;
    std::uint8_t receive_errors = 0;
};

/// Frames with 11 and 29 bits, data and remote, over three mailboxes in the order of send() and one queue of three
/// frames. Nothing waits: poll() as often as frames come, then receive() until it says no. No interrupt, no heap. One
/// thread.
class CanController {
  public:
    static constexpr std::size_t filter_capacity = 28;

    explicit CanController(CanRegisters& registers) : registers_(registers) {}

    /// `filters`: what receive() gives; none: all frames. More than filter_capacity: all frames too. For a bus clock of
    /// 42 MHz; 14 quanta a bit, the sample at 86 %.
    void start(CanBitRate rate, std::span<const hal::CanFilter> filters);
    /// `patience`: polls after which a controller that did not answer is absent.
    void poll(std::uint32_t patience);
    /// False where the frame is dropped: no mailbox is free, or the controller is off the bus.
    bool send(const hal::CanFrame& frame);
    [[nodiscard]] bool receive(hal::CanFrame& frame);
    /// send() would take a frame.
    [[nodiscard]] bool has_room() const;
    /// All that send() took has left.
    [[nodiscard]] bool is_all_sent() const;
    /// Frames that wait are given up.
    void abort_all();
    /// Off the bus at once, with what is being sent; start() comes back.
    void leave_bus();

    [[nodiscard]] CanState state() const { return state_; }
    [[nodiscard]] bool is_on_bus() const { return state_ >= CanState::running && state_ != CanState::bus_off; }
    [[nodiscard]] const CanHealth& health() const { return health_; }

  private:
    void set_up();
    void write_filters();
    void watch_errors();
    [[nodiscard]] CanState error_state() const;
    [[nodiscard]] bool is_free(unsigned mailbox) const;

    CanRegisters& registers_;
    CanBitRate rate_ = CanBitRate::kbit_500;
    std::span<const hal::CanFilter> filters_{};
    CanState state_ = CanState::entering_setup;
    std::uint32_t polls_ = 0;
    CanHealth health_{};
};

}  // namespace millforce::stm32
