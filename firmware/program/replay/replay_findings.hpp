// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "firmware/tick_record.hpp"
#include "hal/drive_sample.hpp"

namespace millforce::host {

/// Why a replay says nothing: watches samples and answers, and puts into words what no row of estimates shows.
class ReplayFindings {
  public:
    explicit ReplayFindings(std::uint32_t encoder_counts_per_rev) : counts_per_rev_(encoder_counts_per_rev) {}

    void follow(const hal::DriveSample& sample, const firmware::TickRecord& record);

    /// One sentence each; empty where forces came and no fault.
    [[nodiscard]] std::vector<std::string> notes() const;

  private:
    void follow_turning(const hal::DriveSample& sample);
    [[nodiscard]] std::string reason_for_no_force() const;

    std::uint32_t counts_per_rev_;
    std::size_t samples_ = 0;
    std::size_t without_current_ = 0;
    std::size_t at_rest_ = 0;
    std::size_t backwards_ = 0;
    std::size_t too_far_ = 0;  // between two samples
    std::size_t with_force_ = 0;
    std::size_t with_law_ = 0;
    std::size_t refuted_ = 0;
    std::size_t in_fault_ = 0;
    std::uint8_t first_fault_ = 0;
    std::uint64_t fault_us_ = 0;
    std::uint32_t last_time_us_ = 0;
    std::uint32_t last_count_ = 0;
    std::uint64_t time_us_ = 0;
};

}  // namespace millforce::host
