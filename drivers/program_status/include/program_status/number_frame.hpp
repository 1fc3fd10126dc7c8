// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/can_frame.hpp"
#include "program_status/program_status_frame.hpp"

/// A number that the CNC reports in a frame of its own: 8 bytes, little endian, every 100 ms.
///
/// | bytes | what | |
/// |---|---|---|
/// | 0…3 | number, U32 | 0: none, or not known |
/// | 4…6 | 0 | |
/// | 7 | CRC-8 as in the override frame, over id low, id high, bytes 0…6 | |

namespace millforce::program_status {

/// `id` has 11 bits.
[[nodiscard]] hal::CanFrame encode_number(std::uint32_t number, std::uint32_t id);
/// Writes `number` if the frame is valid.
[[nodiscard]] FrameError decode_number(const hal::CanFrame& frame, std::uint32_t id, std::uint32_t& number);

/// The controller's side: the number of the newest valid frame. One thread.
class NumberReceiver {
  public:
    /// Without a frame for so long the number is not known any more.
    static constexpr std::uint64_t timeout_us = 1'000'000;

    /// `id` 0: there is no such frame on the bus.
    explicit NumberReceiver(std::uint32_t id) : id_(id) {}

    /// True if the frame is valid.
    bool on_frame(const hal::CanFrame& frame, std::uint64_t time_us);
    /// 0: none, or not known.
    [[nodiscard]] std::uint32_t number(std::uint64_t now_us) const {
        return now_us <= fresh_us_ + timeout_us ? number_ : 0;
    }

  private:
    std::uint32_t id_;
    std::uint32_t number_ = 0;
    std::uint64_t fresh_us_ = 0;
};

}  // namespace millforce::program_status
