// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check/finding.hpp"
#include "hal/drive_sample.hpp"

#include <cstdint>
#include <vector>

namespace millforce::host {

/// The count between two index pulses against the stated counts per revolution. Wrong is what differs by more than one
/// count and a thousandth of a revolution, in the median of at least three pulses.
class EncoderCounts {
  public:
    explicit EncoderCounts(std::uint32_t counts_per_rev) : counts_per_rev_(static_cast<double>(counts_per_rev)) {}

    void add(const hal::DriveSample& sample);

    /// What else the recording holds.
    struct Beside {
        bool has_index = false;    ///< a column of index pulses
        bool has_command = false;  ///< commanded speeds that can be judged (commanded_speed.hpp)
    };
    [[nodiscard]] Findings findings(const Beside& beside) const;
    /// Whether the index pulses prove the counts right.
    [[nodiscard]] bool is_proven(bool has_index) const;

  private:
    void follow_turning(const hal::DriveSample& sample);
    [[nodiscard]] double typical_rev() const;
    [[nodiscard]] bool is_enough() const;
    [[nodiscard]] double tolerance_rev() const;
    [[nodiscard]] Finding wrong_count() const;

    double counts_per_rev_;
    std::vector<double> between_pulses_rev_;
    std::uint32_t index_count_ = 0;
    std::uint8_t index_number_ = 0;
    std::uint32_t last_count_ = 0;
    bool has_last_ = false;
    int since_pulse_ = 0;  // samples
    std::size_t steps_ = 0;
    std::size_t backwards_ = 0;
    std::size_t too_far_ = 0;
};

}  // namespace millforce::host
