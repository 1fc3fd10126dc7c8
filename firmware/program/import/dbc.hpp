// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/can_frame.hpp"

namespace millforce::host {

/// Where a value is in a CAN message, and what it stands for: a line SG_ of a DBC file.
struct DbcSignal {
    enum class Number : std::uint8_t { integer, float_32, float_64 };

    std::string message;
    std::string name;
    std::uint32_t id = 0;   ///< identifier of the message
    bool extended = false;  ///< 29 bits
    unsigned message_bytes = 0;
    unsigned start_bit = 0;    ///< place as in the file: the lowest bit (Intel), or the highest (Motorola)
    unsigned bits = 0;         ///< 1…64
    bool is_motorola = false;  ///< byte order @0, the highest byte first; else Intel, @1
    bool is_signed = false;
    bool is_multiplexed = false;  ///< there in some of the frames only
    Number number = Number::integer;
    double factor = 1.0;
    double offset = 0.0;
    std::string unit;

    [[nodiscard]] std::string full_name() const { return message + "." + name; }
    /// factor × raw + offset; NaN where the frame is too short.
    [[nodiscard]] double decode(const hal::CanFrame& frame) const;
};

/// The signals of a DBC file.
///
/// Only BO_, SG_ and SIG_VALTYPE_ (floating point) are read, and these strictly; everything else is passed over, texts
/// of several lines included. InputError "FILE:LINE: …": what does not parse, a signal of no message, more than 64
/// bits. A file has at most 16 MiB.
class Dbc {
  public:
    static Dbc open(const std::string& file);
    static Dbc from_text(const std::string& text, const std::string& name);

    [[nodiscard]] const std::vector<DbcSignal>& signals() const { return signals_; }
    /// "Message.Signal", or "Signal" where only one message has it. InputError: not there (with the nearest name),
    /// there twice, multiplexed, beyond the end of its message, or of a message of more than 8 bytes. `asked_by` begins
    /// it.
    [[nodiscard]] const DbcSignal& find(const std::string& name, const std::string& asked_by) const;

  private:
    friend class DbcParser;
    std::string file_;
    std::vector<DbcSignal> signals_;
};

}  // namespace millforce::host
