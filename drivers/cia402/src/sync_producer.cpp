// SPDX-License-Identifier: Apache-2.0
#include "cia402/sync_producer.hpp"

namespace millforce::cia402 {

bool SyncProducer::poll(std::uint64_t now_us) {
    const bool is_first_or_clock_was_set = next_us_ == 0 || next_us_ > now_us + 2ULL * period_us_;
    if (is_first_or_clock_was_set) {
        next_us_ = now_us;
    }
    if (now_us < next_us_) {
        return false;
    }
    const std::uint64_t late_periods = (now_us - next_us_) / period_us_;
    skipped_ += static_cast<std::uint32_t>(late_periods);
    next_us_ += (late_periods + 1) * period_us_;
    if (next_us_ < now_us + period_us_ / 2) {  // so close to this one it would be taken for a duplicate
        next_us_ += period_us_;
        ++skipped_;
    }
    due_ = true;
    return true;
}

bool SyncProducer::take_frame(hal::CanFrame& frame) {
    if (!due_) {
        return false;
    }
    due_ = false;
    frame = {};
    frame.id = id_;
    return true;
}

}  // namespace millforce::cia402
