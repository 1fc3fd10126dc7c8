// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/can_frame.hpp"

namespace millforce::cia402 {

/// When to send SYNC (CiA 301). A period that was missed is skipped, not made up for. One thread.
class SyncProducer {
  public:
    SyncProducer(std::uint32_t id, std::uint32_t period_us) : id_(id), period_us_(period_us) {}

    /// True where a SYNC falls due.
    bool poll(std::uint64_t now_us);
    [[nodiscard]] bool take_frame(hal::CanFrame& frame);
    [[nodiscard]] std::uint64_t next_us() const { return next_us_; }
    [[nodiscard]] std::uint32_t skipped() const { return skipped_; }

  private:
    std::uint32_t id_;
    std::uint32_t period_us_;
    std::uint64_t next_us_ = 0;
    std::uint32_t skipped_ = 0;
    bool due_ = false;
};

}  // namespace millforce::cia402
