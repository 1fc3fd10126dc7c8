// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/can_frame.hpp"
#include "zynqmp/registers.hpp"

/// The CAN controller of a Zynq UltraScale+. UG1085 chapter 20, UG1087 module CAN

namespace millforce::zynqmp {

/// Entered and left by start() and poll() alone.
enum class CanState : std::uint8_t {
    off,      ///< not started
    absent,   ///< the controller does not take its setup: no clock, or held in reset. Final until start()
    joining,  ///< waits for 11 recessive bits
    running,
    error_warning,  ///< an error counter at 96; frames flow
    error_passive,  ///< at 128; the same
    bus_off,        ///< taken off the bus by its errors, and kept off it; start() comes back
};
constexpr const char* name(CanState state) {
    constexpr const char* names[] = {"off",           "absent",        "joining", "running",
                                     "error warning", "error passive", "bus off"};
    return names[static_cast<unsigned>(state) % 7U];
}

/// Time quanta are made from the reference clock (100 MHz on a ZCU102) by `prescaler`; a bit is one of them plus the
/// two segments.
struct CanBitTiming {
    std::uint32_t prescaler = 10;      ///< 1…256
    std::uint32_t first_segment = 15;  ///< quanta before the sample, 1…16
    std::uint32_t second_segment = 4;  ///< and behind it, 1…8
    std::uint32_t largest_jump = 1;    ///< 1…4
};
/// 20 quanta a bit of a 100 MHz clock, the sample at 80 %.
inline constexpr CanBitTiming kbit_500{10, 15, 4, 1};
inline constexpr CanBitTiming kbit_1000{5, 15, 4, 1};

struct CanHealth {
    std::uint32_t bus_offs = 0;
    std::uint32_t overruns = 0;    ///< times that frames came while the queue of 64 was full
    std::uint32_t unsent = 0;      ///< no room, or off the bus
    std::uint8_t last_errors = 0;  ///< ESR: 1 CRC, 2 form, 4 stuff, 8 bit, 16 acknowledge
    std::uint8_t transmit_errors = 0;
    std::uint8_t receive_errors = 0;
};

/// Frames with 11 and 29 bits, data and remote, over a queue of 64 each way, in the order of send(). All frames pass:
/// four filters are too few for a bus with drives. A controller does not hear its own frames. Nothing waits: call
/// poll() in each round, then receive() until it returns false. No interrupt, no heap. One thread.
class CanController {
  public:
    explicit CanController(CanRegisters& registers) : registers_(registers) {}

    void start(const CanBitTiming& timing);
    void poll();
    /// False where the frame is dropped: the queue is full, or the controller is off the bus.
    bool send(const hal::CanFrame& frame);
    [[nodiscard]] bool receive(hal::CanFrame& frame);

    [[nodiscard]] CanState state() const { return state_; }
    [[nodiscard]] bool is_on_bus() const { return state_ >= CanState::running && state_ != CanState::bus_off; }
    [[nodiscard]] bool has_room() const;
    [[nodiscard]] const CanHealth& health() const { return health_; }

  private:
    void watch_errors();
    [[nodiscard]] CanState error_state() const;

    CanRegisters& registers_;
    CanState state_ = CanState::off;
    CanHealth health_{};
};

}  // namespace millforce::zynqmp
