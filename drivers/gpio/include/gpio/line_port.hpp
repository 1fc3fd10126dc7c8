// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace millforce::gpio {

/// Output lines that are set together; bit n is the n-th line. One thread.
class LinePort {
  public:
    /// Takes the lines as outputs with these levels. False: not taken, see last_error().
    [[nodiscard]] virtual bool open(std::uint32_t levels) = 0;
    /// False: not set, and the lines are given up; open() again.
    [[nodiscard]] virtual bool set(std::uint32_t levels) = 0;
    [[nodiscard]] virtual int last_error() const = 0;

  protected:
    LinePort() = default;
    ~LinePort() = default;  // never deleted through this interface: that would need a heap
    LinePort(const LinePort&) = default;
    LinePort& operator=(const LinePort&) = default;
};

}  // namespace millforce::gpio
