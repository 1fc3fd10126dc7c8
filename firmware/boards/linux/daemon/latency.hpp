// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace millforce::host {

/// Latencies in steps of 10 µs; beyond 20 ms only the largest is kept. Plain data, no heap.
class LatencyHistogram {
  public:
    void add(std::uint64_t latency_us) {
        ++counts_[std::min<std::uint64_t>(latency_us / step_us, counts_.size() - 1)];
        ++total_;
        largest_us_ = std::max(largest_us_, latency_us);
    }
    /// Upper end of the step that holds the share, e.g. 0.99.
    [[nodiscard]] std::uint64_t quantile_us(double share) const {
        const auto wanted = static_cast<std::uint64_t>(share * static_cast<double>(total_));
        std::uint64_t sum = 0;
        for (std::size_t k = 0; k < counts_.size(); ++k) {
            sum += counts_[k];
            if (sum > wanted) {
                return std::min((k + 1) * step_us, largest_us_);
            }
        }
        return largest_us_;
    }
    [[nodiscard]] std::uint64_t largest_us() const { return largest_us_; }
    [[nodiscard]] std::uint64_t total() const { return total_; }

  private:
    static constexpr std::uint64_t step_us = 10;
    std::array<std::uint32_t, 2000> counts_{};
    std::uint64_t total_ = 0;
    std::uint64_t largest_us_ = 0;
};

}  // namespace millforce::host
