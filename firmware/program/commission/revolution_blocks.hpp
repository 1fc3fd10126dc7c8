// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "commission/samples.hpp"

namespace millforce::host {

/// Means over whole revolutions of the spindle, of 0.1 s or more: the teeth and the runout average out.
struct RevolutionBlock {
    double start_s = 0.0;
    double end_s = 0.0;
    double spindle_rad_s = 0.0;
    double spindle_current_A = 0.0;
    double current_noise_A = 0.0;  ///< of one sample, from the differences of neighbours
    std::array<double, 3> velocity_mm_s{};

    [[nodiscard]] double middle_s() const { return 0.5 * (start_s + end_s); }
};

/// Cuts the samples into blocks. A sample without the spindle's count and current ends the block.
class RevolutionBlocks {
  public:
    explicit RevolutionBlocks(std::uint32_t counts_per_rev) : counts_per_rev_(counts_per_rev) {}

    /// The block that ends with this sample, if one does.
    std::optional<RevolutionBlock> add(const TimedSample& timed);
    void reset() { samples_ = 0; }

  private:
    void begin(const TimedSample& timed);
    [[nodiscard]] RevolutionBlock block(const TimedSample& timed) const;

    double counts_per_rev_;
    long samples_ = 0;
    double start_s_ = 0.0;
    std::uint32_t last_count_ = 0;
    std::int64_t turned_ = 0;
    double last_current_A_ = 0.0;
    double current_ = 0.0;
    double squared_steps_ = 0.0;
    std::array<double, 3> velocity_{};
};

}  // namespace millforce::host
