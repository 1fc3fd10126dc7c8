// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/can_frame.hpp"
#include "program_status/program_status_frame.hpp"

namespace millforce::program_status {

/// The firmware's parameters have the defaults (parameters.hpp).
struct ProgramStatusReceiverSettings {
    std::uint32_t id = 0;          ///< 0: there is no such frame on the bus
    std::uint32_t timeout_us = 0;  ///< without a fresh frame for so long the CNC is silent
};

enum class ReceiveError : std::uint8_t {
    length,
    checksum,
    reserved_bits,
    counter_repeated,  ///< a duplicate, or a sender whose program has stopped
    counter_backwards,
};
inline constexpr std::size_t receive_errors = static_cast<std::size_t>(ReceiveError::counter_backwards) + 1;

enum class ProgramSource : std::uint8_t {
    never_heard,  ///< no frame yet: F is not known
    fresh,
    silent,  ///< it was there and stays away: the feed is to be held
};

/// The controller's side, a pure state machine. What it says depends on the frames and their times alone. One thread.
class ProgramStatusReceiver {
  public:
    explicit ProgramStatusReceiver(const ProgramStatusReceiverSettings& settings) : settings_(settings) {}

    /// True if the frame is valid and new.
    bool on_frame(const hal::CanFrame& frame, std::uint64_t time_us);
    [[nodiscard]] ProgramSource source(std::uint64_t now_us) const;
    /// Never heard: nothing is known. Silent: the last status with the feed held.
    [[nodiscard]] hal::ProgramStatus program(std::uint64_t now_us) const;
    /// True once for each time that the reset bit rose.
    [[nodiscard]] bool take_reset();
    [[nodiscard]] std::uint32_t errors(ReceiveError error) const { return errors_[static_cast<std::size_t>(error)]; }

  private:
    bool reject(ReceiveError error);

    ProgramStatusReceiverSettings settings_;
    ProgramStatusFrame newest_{};
    bool was_heard_ = false;
    bool reset_asked_ = false;
    std::uint64_t fresh_us_ = 0;
    std::array<std::uint32_t, receive_errors> errors_{};
};

}  // namespace millforce::program_status
