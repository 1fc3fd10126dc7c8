// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "telemetry/telemetry.hpp"

namespace millforce::host {

/// What came of a job: from its first cut to 30 s after its last one, or to the end of the run.
struct JobReport {
    std::uint64_t begin_unix_us = 0;
    std::uint64_t end_unix_us = 0;
    double cutting_s = 0.0;
    double held_s = 0.0;          ///< the feed was held, after the first cut
    double override_sum_s = 0.0;  ///< override times time, while cutting
    float largest_load = 0.0F;    ///< peak of the total force over its limit
    float largest_depth_mm = 0.0F;
    std::set<std::uint32_t> tools{};
    struct FaultAt {
        std::uint64_t unix_us = 0;
        std::uint8_t fault = 0;
    };
    std::vector<FaultAt> faults{};  ///< the first hundred
    std::uint64_t lost = 0;         ///< ticks that are missing in these figures
};

/// One object; a figure that no tick gave is left out. `id` is unique for a machine.
[[nodiscard]] std::string job_json(const JobReport& report);
[[nodiscard]] std::string job_id(const JobReport& report);

/// Finds jobs in the telemetry.
class JobWatch {
  public:
    /// The job that ended before this tick.
    [[nodiscard]] std::optional<JobReport> follow(const Telemetry& telemetry);
    /// The job that ended because no cut has come for too long, ticks or not. `monotonic_us`: now.
    [[nodiscard]] std::optional<JobReport> look(std::uint64_t monotonic_us);
    /// The job in work: it ends with the run.
    [[nodiscard]] std::optional<JobReport> end();

  private:
    void add(JobReport& job, const Telemetry& telemetry) const;

    std::optional<JobReport> job_{};
    std::optional<Telemetry> last_{};
    std::uint64_t last_cut_us_ = 0;  ///< on CLOCK_MONOTONIC
    std::uint64_t lost_before_ = 0;
};

}  // namespace millforce::host
