// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "hal/can_frame.hpp"

/// Lines of the log that `candump -L` writes and `canplayer` reads:
///
///     (1436509052.249713) can0 181#1122334455667788        11-bit id: three digits, data
///     (1436509052.249713) can0 0000018A#1122 R             29-bit id: eight digits; may end in R or T
///     (1436509052.249713) can0 181#R8                      remote frame, with or without its length
///     (1436509052.249713) can0 123##5112233                CAN FD: a digit of flags, up to 64 bytes
///     (1436509052.249713) can0 20000004#0001000000000000   error frame: bit 29 of the id
///     (1436509052.249713) can0 181#1122334455667788_9      data length code above 8: nine, eight bytes

namespace millforce::candump {

enum class LineKind : std::uint8_t {
    frame,        ///< `frame` holds a data or remote frame
    fd_frame,     ///< valid, but not classical CAN: only its time and interface are given
    error_frame,  ///< the same
    blank,        ///< empty, or a comment: `#` at its begin
    malformed,    ///< nothing is given; `error` and `column` say what and where
};

enum class LineError : std::uint8_t { none, too_long, time, interface, id, data, length, rest };

struct LogLine {
    LineKind kind = LineKind::malformed;
    LineError error = LineError::none;
    std::uint32_t column = 0;       ///< place of the error, from 1 on
    std::uint64_t time_us = 0;      ///< time by whatever clock wrote it, usually since 1970
    std::string_view interface {};  ///< part of the line that was read
    hal::CanFrame frame{};
};

inline constexpr std::size_t longest_line = 256;

/// Any bytes may come in. No heap; one pass.
[[nodiscard]] LogLine read_line(std::string_view line);

/// What was expected there, for a message.
[[nodiscard]] std::string_view expectation(LineError error);

}  // namespace millforce::candump
