// SPDX-License-Identifier: Apache-2.0
#include "bus/loopback_bus.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace millforce::sim {

int LoopbackBus::attach(Receiver receiver) {
    receivers_.push_back(std::move(receiver));
    return static_cast<int>(receivers_.size()) - 1;
}

void LoopbackBus::send(int from, const hal::CanFrame& frame, std::uint64_t time_us) {
    const Fate fate = fault_ ? fault_(frame) : Fate{1, 0, frame};
    for (int copy = 0; copy < fate.copies && waiting_.size() < most_waiting; ++copy) {
        waiting_.push_back({from, time_us + fate.delay_us, fate.frame});
    }
}

/// Overhead of a frame without stuffing 47 bits (67 with a 29-bit id), a tenth of stuff bits.
std::uint64_t LoopbackBus::frame_time_us(const hal::CanFrame& frame) const {
    const double bits = 1.1 * ((frame.extended ? 67.0 : 47.0) + 8.0 * (frame.remote ? 0.0 : frame.length));
    return static_cast<std::uint64_t>(std::llround(bits / bit_rate_ * 1e6));
}

/// The frame that wins arbitration when the bus is free next.
std::vector<LoopbackBus::Waiting>::iterator LoopbackBus::next(std::uint64_t until_us) {
    const auto earliest = std::min_element(waiting_.begin(), waiting_.end(),
                                           [](const Waiting& a, const Waiting& b) { return a.ready_us < b.ready_us; });
    if (earliest == waiting_.end()) {
        return earliest;
    }
    const std::uint64_t start_us = std::max(free_us_, earliest->ready_us);
    auto best = waiting_.end();
    for (auto it = waiting_.begin(); it != waiting_.end(); ++it) {
        if (it->ready_us <= start_us && (best == waiting_.end() || it->frame.id < best->frame.id)) {
            best = it;
        }
    }
    return start_us + frame_time_us(best->frame) <= until_us ? best : waiting_.end();
}

void LoopbackBus::advance_to(std::uint64_t time_us) {
    for (auto it = next(time_us); it != waiting_.end(); it = next(time_us)) {
        const Waiting sent = *it;
        waiting_.erase(it);
        free_us_ = std::max(free_us_, sent.ready_us) + frame_time_us(sent.frame);
        for (std::size_t k = 0; k < receivers_.size(); ++k) {
            if (static_cast<int>(k) != sent.from) {
                receivers_[k](sent.frame, free_us_);
            }
        }
        ++delivered_;
    }
}

}  // namespace millforce::sim
