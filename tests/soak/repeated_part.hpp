// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "firmware/parameters.hpp"
#include "hal/drive_sample.hpp"

/// A part that is milled over and over: 30 s of rest, rapids, air and three cuts, recorded once, with the tooth's
/// ripple and noise on the currents. Only the counters go on from one part to the next, as a machine's do: the signals
/// are the same bits, so the answers may be compared.

namespace millforce::soak {

class RepeatedPart {
  public:
    static constexpr std::uint32_t sample_interval_us = 1000;

    RepeatedPart(const firmware::Parameters<float>& parameters, std::uint32_t seed);

    [[nodiscard]] std::size_t size() const { return samples_.size(); }
    /// Sample `index` of part number `part`, from 0 on.
    [[nodiscard]] hal::DriveSample sample(std::uint64_t part, std::size_t index) const;
    [[nodiscard]] const hal::ProgramStatus& program(std::size_t index) const { return programs_[index]; }
    [[nodiscard]] double duration_s() const { return static_cast<double>(size()) * 1e-6 * sample_interval_us; }

    /// How often each counter has begun again when so many parts are done.
    struct Wraps {
        std::uint64_t time = 0, encoder_count = 0, index_number = 0;
    };
    [[nodiscard]] Wraps wraps_after(std::uint64_t parts) const;

  private:
    [[nodiscard]] std::uint64_t turned_counts(std::uint64_t part, std::size_t index) const;

    std::uint64_t counts_per_rev_;
    std::vector<hal::DriveSample> samples_;
    std::vector<hal::ProgramStatus> programs_;
};

}  // namespace millforce::soak
